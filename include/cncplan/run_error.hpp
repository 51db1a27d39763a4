// Why a run ended before its end, without the heap.
#pragma once

#include "cncplan/gcode/diagnostic.hpp"

namespace cncplan {

struct ProgramError;

/// An error of a program that runs, with line and column where there are any. It is a `ProgramError` wherever
/// one is asked for, as by `to_text`; program_error.hpp has that.
struct RunError {
  gcode::Diagnostic about;

  [[nodiscard]] const Error& error() const { return about.error; }
  operator ProgramError() const;  // NOLINT: the same error
};

}  // namespace cncplan
