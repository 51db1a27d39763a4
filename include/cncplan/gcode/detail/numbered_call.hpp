// Calls of numbered subprograms, M98 and M99, as controls other than LinuxCNC write them (set-up).
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string_view>

#include "cncplan/core/compiled.hpp"
#include "cncplan/gcode/detail/scanner.hpp"
#include "cncplan/gcode/word.hpp"

namespace cncplan::gcode {

/// M98 P L, alone on its line but for N.
struct NumberedCall {
  long long number{};           ///< P
  std::optional<double> count;  ///< L
  int column{};
};

namespace detail {

/// The word that stands alone on its line, but for N.
[[nodiscard]] std::optional<Word> only_word(std::string_view line, char letter);

}  // namespace detail

/// The number of a subprogram that begins here: O and a number alone.
[[nodiscard]] std::optional<long long> numbered_label(std::string_view line);

/// The column at which a line says IF, WHILE, GOTO, as the macros of Fanuc's controls do; 0 where it does
/// not.
[[nodiscard]] int macro_word_column(std::string_view line);

/// Whether the line is M99.
[[nodiscard]] inline bool returns(std::string_view line) {
  const auto word = detail::only_word(line, 'M');
  return word && word->number == 99.0;
}

/// The call that a line makes.
[[nodiscard]] std::optional<NumberedCall> numbered_call(std::string_view line);

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/detail/numbered_call-inl.hpp"
#endif
