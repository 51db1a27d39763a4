// Definitions of diagnostic_text.hpp (set-up).
#pragma once

#include "cncplan/gcode/diagnostic_text.hpp"

namespace cncplan::gcode {

namespace detail {

CNCPLAN_INLINE std::string character_text(double code) {
  const std::string_view printable = name(static_cast<char>(static_cast<unsigned char>(code)));
  std::string text(printable);
  if (printable == "byte") return text.append(1, ' ').append(number_text(code));
  return text.insert(0, 1, '\'').append(1, '\'');
}

CNCPLAN_INLINE std::string word_text(const Error& error) {
  if (error.field == "byte") return character_text(error.value);
  const bool code = (error.field == "G" || error.field == "M") && error.code != ErrorCode::missing_number;
  const bool tool = error.code == ErrorCode::no_such_tool || error.code == ErrorCode::no_tool_table;
  const bool limited = error.code == ErrorCode::above_limit || error.code == ErrorCode::below_limit;
  std::string text(error.field);
  if (limited && text.size() > 1)  // a word's number can be seen in the program
    return text + ": " + value_text(error.value, error.unit) +
           (error.unit == ErrorUnit::radians ? " degrees" : "");
  return text + (code || tool ? number_text(error.value) : "");
}

}  // namespace detail

CNCPLAN_INLINE std::string to_text(const Diagnostic& diagnostic) {
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
    text += ' ' + value_text(error.bound, error.unit);
  text += amount_text(error);
  if (error.code == ErrorCode::missing_number && error.value != 0.0)
    text += ": " + detail::character_text(error.value) + " follows";
  if (diagnostic.other.empty()) return text;
  if (error.code == ErrorCode::radius_mismatch)
    text.append("; they agree in ").append(diagnostic.other);
  else
    text += " (" + detail::word_text({error.code, diagnostic.other, error.bound, 0.0}) + ')';
  return text;
}

CNCPLAN_INLINE std::string to_text(std::string_view file, const Diagnostic& diagnostic,
                                   std::string_view weight) {
  std::string text(file);
  if (!text.empty()) text += ':';
  text += std::to_string(diagnostic.line) + ':' + std::to_string(diagnostic.column) + ": ";
  text += weight;
  return text + ": " + to_text(diagnostic);
}

}  // namespace cncplan::gcode
