// Calls of numbered subprograms, M98 and M99, as controls other than LinuxCNC write them (set-up).
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string_view>

#include "cncplan/gcode/scanner.hpp"
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
[[nodiscard]] inline std::optional<Word> only_word(std::string_view line, char letter) {
  std::optional<Word> found;
  Scanner scanner(line);
  for (auto word = scanner.next();; word = scanner.next()) {
    if (!word) return std::nullopt;
    if (!*word) return found;
    if ((*word)->letter == 'N') continue;
    if (found || (*word)->letter != letter) return std::nullopt;
    found = **word;
  }
}

}  // namespace detail

/// The number of a subprogram that begins here: O and a number alone.
[[nodiscard]] inline std::optional<long long> numbered_label(std::string_view line) {
  if (line.find_first_of("oO") == std::string_view::npos) return std::nullopt;
  const auto word = detail::only_word(line, 'O');
  return word ? std::optional(static_cast<long long>(word->number)) : std::nullopt;
}

/// The column at which a line says IF, WHILE, GOTO, as the macros of Fanuc's controls do; 0 where it does
/// not.
[[nodiscard]] inline int macro_word_column(std::string_view line) {
  std::size_t at = line.find_first_not_of(" \t/");
  if (at != std::string_view::npos && (line[at] == 'N' || line[at] == 'n'))
    at = line.find_first_not_of("0123456789. \t", at + 1);
  if (at == std::string_view::npos) return 0;
  for (const std::string_view word : {"IF", "WHILE", "GOTO"}) {
    const std::string_view text = line.substr(at, word.size());
    if (std::equal(text.begin(), text.end(), word.begin(), word.end(),
                   [](char has, char wanted) { return has == wanted || has == wanted + ('a' - 'A'); }))
      return static_cast<int>(at) + 1;
  }
  return 0;
}

/// Whether the line is M99.
[[nodiscard]] inline bool returns(std::string_view line) {
  const auto word = detail::only_word(line, 'M');
  return word && word->number == 99.0;
}

/// The call that a line makes.
[[nodiscard]] inline std::optional<NumberedCall> numbered_call(std::string_view line) {
  NumberedCall call;
  bool has_number = false;
  Scanner scanner(line);
  for (auto word = scanner.next();; word = scanner.next()) {
    if (!word) return std::nullopt;
    if (!*word) break;
    const auto [letter, number, unused_line, column, unused_arguments] = **word;
    if (letter == 'M' && number == 98.0 && call.column == 0) {
      call.column = column;
    } else if (letter == 'P' && !has_number && number >= 0.0) {
      has_number = true;
      call.number = static_cast<long long>(number);
    } else if (letter == 'L' && !call.count && number >= 0.0) {
      call.count = number;
    } else if (letter != 'N') {
      return std::nullopt;
    }
  }
  return call.column != 0 && has_number ? std::optional(call) : std::nullopt;
}

}  // namespace cncplan::gcode
