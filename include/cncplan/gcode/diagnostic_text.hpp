// Diagnostics as sentences, for programs that print them (set-up).
#pragma once

#include <string>
#include <string_view>

#include "cncplan/core/error_text.hpp"
#include "cncplan/gcode/diagnostic.hpp"
#include "cncplan/gcode/word.hpp"

namespace cncplan::gcode {

namespace detail {

/// A character, or the number of a byte that has no picture.
inline std::string character_text(double code) {
  const std::string_view printable = name(static_cast<char>(static_cast<unsigned char>(code)));
  std::string text(printable);
  if (printable == "byte") return text.append(1, ' ').append(number_text(code));
  return text.insert(0, 1, '\'').append(1, '\'');
}

/// A code is known by its number (G41), a tool too (T5), any other word by its letter.
inline std::string word_text(const Error& error) {
  if (error.field == "byte") return character_text(error.value);
  const bool code = (error.field == "G" || error.field == "M") && error.code != ErrorCode::missing_number;
  const bool tool = error.code == ErrorCode::no_such_tool || error.code == ErrorCode::no_tool_table;
  return std::string(error.field) + (code || tool ? number_text(error.value) : "");
}

}  // namespace detail

/// The sentence alone: "G41 is not supported", "G3: words exclude each other (G2)".
[[nodiscard]] inline std::string to_text(const Diagnostic& diagnostic) {
  const Error& error = diagnostic.error;
  const std::string_view sentence = message(error.code);
  const bool has_verb =
      sentence.starts_with("is ") || sentence.starts_with("must ") || sentence.starts_with("has ") ||
      sentence.starts_with("does ") || sentence.starts_with("says ") || sentence.starts_with("goes ") ||
      sentence.starts_with("finds ") || sentence.starts_with("belongs ") || sentence.starts_with("moves ") ||
      sentence.starts_with("names ") || sentence.starts_with("needs ") || sentence.starts_with("divides ");
  std::string text = detail::word_text(error);
  text += has_verb ? " " : ": ";
  text += sentence;
  if (error.code == ErrorCode::above_limit || error.code == ErrorCode::below_limit)
    text += ' ' + number_text(error.bound);
  text += amount_text(error);
  if (error.code == ErrorCode::missing_number && error.value != 0.0)
    text += ": " + detail::character_text(error.value) + " follows";
  if (!diagnostic.other.empty())
    text += " (" + detail::word_text({error.code, diagnostic.other, error.bound, 0.0}) + ')';
  return text;
}

/// `FILE:LINE:COLUMN: error: SENTENCE`, or with another word for its weight; without a file, from the line
/// on.
[[nodiscard]] inline std::string to_text(std::string_view file, const Diagnostic& diagnostic,
                                         std::string_view weight = "error") {
  std::string text(file);
  if (!text.empty()) text += ':';
  text += std::to_string(diagnostic.line) + ':' + std::to_string(diagnostic.column) + ": ";
  text += weight;
  return text + ": " + to_text(diagnostic);
}

}  // namespace cncplan::gcode
