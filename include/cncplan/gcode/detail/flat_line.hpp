// A line with parameters and expressions as a flat one, in which numbers stand for them (set-up).
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "cncplan/core/compiled.hpp"
#include "cncplan/gcode/detail/expression.hpp"

namespace cncplan::gcode {

/// The flat text of one line, and which column of the source each of its characters comes from. Parameters
/// are set after all values of the line have been read, in the order of the text.
class FlatLine {
 public:
  /// Errors, at their column: those of `Expression`, and of parameters that cannot be set.
  Expected<void, Diagnostic> read(std::string_view line, Parameters& parameters);

  [[nodiscard]] std::string_view text() const { return text_; }

  /// Of the source, for one of the flat text; both from 1.
  [[nodiscard]] int column(int flat) const;

 private:
  struct Setting {
    ParameterName name;
    double value{};
    int column{};
  };

  static bool is_letter(char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '@' || c == '^' || c == '$';
  }

  void copy(std::string_view line, std::size_t from, std::size_t to) {
    text_.append(line.substr(from, to - from));
    for (; from < to; ++from) columns_.push_back(static_cast<int>(from) + 1);
  }

  // #3 = value. Returns the index behind it.
  Expected<std::size_t, Diagnostic> setting(std::string_view line, std::size_t at,
                                            const Parameters& parameters);

  // The number of a word: as it stands, or that of an expression. Returns the index behind it.
  Expected<std::size_t, Diagnostic> value(std::string_view line, std::size_t from, char letter,
                                          const Parameters& parameters);

  // A number as it stands is for the reader to judge.
  static bool computed(std::string_view line, std::size_t at);

  // What only a whole number (of tenths, for codes) can be is that one, if it is near.
  static double nearby(char letter, double value);

  void write(double value);

  std::string text_;
  std::vector<int> columns_;
  std::vector<Setting> settings_;
};

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/detail/flat_line-inl.hpp"
#endif
