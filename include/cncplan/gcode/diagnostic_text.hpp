// Diagnostics as sentences, for programs that print them (set-up).
#pragma once

#include <string>
#include <string_view>

#include "cncplan/core/compiled.hpp"
#include "cncplan/core/error_text.hpp"
#include "cncplan/gcode/diagnostic.hpp"
#include "cncplan/gcode/word.hpp"

namespace cncplan::gcode {

namespace detail {

/// A character, or the number of a byte that has no picture.
std::string character_text(double code);

/// A code is known by its number (G41), a tool too (T5), any other word by its letter.
std::string word_text(const Error& error);

}  // namespace detail

/// The sentence alone: "G41 is not supported", "G3: words exclude each other (G2)".
[[nodiscard]] std::string to_text(const Diagnostic& diagnostic);

/// `FILE:LINE:COLUMN: error: SENTENCE`, or with another word for its weight; without a file, from the line
/// on.
[[nodiscard]] std::string to_text(std::string_view file, const Diagnostic& diagnostic,
                                  std::string_view weight = "error");

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/diagnostic_text-inl.hpp"
#endif
