// A line with parameters and expressions as a flat one, in which numbers stand for them (set-up).
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "cncplan/gcode/language/expression.hpp"

namespace cncplan::gcode {

/// The flat text of one line, and which column of the source each of its characters comes from. Parameters
/// are set after all values of the line have been read, in the order of the text.
class FlatLine {
 public:
  /// Errors, at their column: those of `Expression`, and of parameters that cannot be set.
  Expected<void, Diagnostic> read(std::string_view line, Parameters& parameters) {
    text_.clear();
    columns_.clear();
    settings_.clear();
    bool behind_words = false;
    for (std::size_t at = 0; at < line.size();) {
      const char c = line[at];
      if (c == ';') {
        copy(line, at, line.size());
        at = line.size();
      } else if (c == '(') {
        const std::size_t behind = std::min(comment_end(line, at), line.size());
        copy(line, at, behind);
        at = behind;
      } else if (c == '#') {
        behind_words = true;
        if (auto next = setting(line, at, parameters))
          at = *next;
        else
          return tl::unexpected(next.error());
      } else if (is_letter(c)) {
        if (behind_words && (c == 'O' || c == 'o'))
          return tl::unexpected(
              Diagnostic{{ErrorCode::not_supported, "O-word", 0.0, 0.0}, 0, static_cast<int>(at) + 1, {}});
        behind_words = true;
        copy(line, at, at + 1);
        if (auto next = value(line, at + 1, c, parameters))
          at = *next;
        else
          return tl::unexpected(next.error());
      } else {
        copy(line, at, at + 1);
        ++at;
      }
    }
    for (const Setting& each : settings_) {
      const auto set =
          std::visit([&](const auto& name) { return parameters.set(name, each.value); }, each.name);
      if (!set) return tl::unexpected(Diagnostic{set.error(), 0, each.column, {}});
    }
    return {};
  }

  [[nodiscard]] std::string_view text() const { return text_; }

  /// Of the source, for one of the flat text; both from 1.
  [[nodiscard]] int column(int flat) const {
    const auto at = static_cast<std::size_t>(flat - 1);
    if (flat < 1 || columns_.empty()) return flat;
    return at < columns_.size() ? columns_[at] : columns_.back() + static_cast<int>(at - columns_.size()) + 1;
  }

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
                                            const Parameters& parameters) {
    Expression expression(line, at, parameters);
    ParameterName name = expression.parameter_name();
    expression.expect('=');
    const double value = expression.value();
    if (expression.problem()) return tl::unexpected(*expression.problem());
    const std::size_t next = line.find_first_not_of(" \t", expression.at());
    if (next != std::string_view::npos && std::string_view("+-*/").find(line[next]) != std::string_view::npos)
      return tl::unexpected(Diagnostic{
          {ErrorCode::not_supported, "expression without [ ]", 0.0, 0.0}, 0, static_cast<int>(next) + 1, {}});
    settings_.push_back({std::move(name), value, static_cast<int>(at) + 1});
    return expression.at();
  }

  // The number of a word: as it stands, or that of an expression. Returns the index behind it.
  Expected<std::size_t, Diagnostic> value(std::string_view line, std::size_t from, char letter,
                                          const Parameters& parameters) {
    const std::size_t at = line.find_first_not_of(" \t", from);
    if (at == std::string_view::npos || !computed(line, at)) return from;
    Expression expression(line, at, parameters);
    const double value = expression.value();
    if (expression.problem()) return tl::unexpected(*expression.problem());
    write(nearby(letter, value));
    columns_.resize(text_.size(), static_cast<int>(at) + 1);
    return expression.at();
  }

  // A number as it stands is for the reader to judge.
  static bool computed(std::string_view line, std::size_t at) {
    const std::size_t sign = line.find_first_not_of("+-", at);
    if (sign == std::string_view::npos) return false;
    return line[sign] == '#' || line[sign] == '[' || is_letter(line[sign]);
  }

  // What only a whole number (of tenths, for codes) can be is that one, if it is near.
  static double nearby(char letter, double value) {
    const char upper = static_cast<char>(letter & ~0x20);
    const double parts = upper == 'G' || upper == 'M' ? 10.0 : 1.0;
    if (std::string_view("GMHLNT").find(upper) == std::string_view::npos) return value;
    const double near = std::round(value * parts) / parts;
    return std::abs(near - value) * parts <= whole_within ? near : value;
  }

  void write(double value) {
    std::array<char, 400> digits;              // room for every double
    if (std::abs(value) < 1e-30) value = 0.0;  // beyond every machine, and hundreds of noughts
    const auto end =
        std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed);
    text_.append(digits.data(), end.ptr);
  }

  std::string text_;
  std::vector<int> columns_;
  std::vector<Setting> settings_;
};

}  // namespace cncplan::gcode
