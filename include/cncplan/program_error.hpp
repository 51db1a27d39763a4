// What is wrong with a program, and where (set-up).
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "cncplan/core/compiled.hpp"
#include "cncplan/core/error_text.hpp"
#include "cncplan/gcode/diagnostic_text.hpp"
#include "cncplan/run_error.hpp"

namespace cncplan {

/// An error at its place: of a text, the line and column; of blocks made by hand, the block.
struct ProgramError {
  gcode::Diagnostic about;
  std::string file{};                  ///< empty where there is none
  std::optional<std::size_t> block{};  ///< counted from 0

  [[nodiscard]] const Error& error() const { return about.error; }
};

inline RunError::operator ProgramError() const { return {about}; }

/// "part.ngc:12:5: error: axis X: 310 is above the limit 300", or as much of that as is known; or with
/// another word for its weight.
[[nodiscard]] std::string to_text(const ProgramError& error, std::string_view weight = "error");

}  // namespace cncplan

#ifndef CNCPLAN_COMPILED
#include "cncplan/program_error-inl.hpp"
#endif
