// Definitions of numbered_call.hpp (set-up).
#pragma once

#include "cncplan/gcode/detail/numbered_call.hpp"

namespace cncplan::gcode {

namespace detail {

CNCPLAN_INLINE std::optional<Word> only_word(std::string_view line, char letter) {
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

CNCPLAN_INLINE std::optional<long long> numbered_label(std::string_view line) {
  if (line.find_first_of("oO") == std::string_view::npos) return std::nullopt;
  const auto word = detail::only_word(line, 'O');
  return word ? std::optional(static_cast<long long>(word->number)) : std::nullopt;
}

CNCPLAN_INLINE int macro_word_column(std::string_view line) {
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

CNCPLAN_INLINE std::optional<NumberedCall> numbered_call(std::string_view line) {
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
