// Definitions of error_text.hpp.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>

#include "cncplan/core/error_text.hpp"

namespace cncplan {

CNCPLAN_INLINE std::string number_text(double number) {
  std::array<char, 32> digits;
  const double size = number < 0.0 ? -number : number;
  const auto format =
      size == 0.0 || (size > 1e-4 && size < 1e9) ? std::chars_format::fixed : std::chars_format::general;
  char* const end = std::to_chars(digits.data(), digits.data() + digits.size(), number, format).ptr;
  return std::string(digits.data(), end);
}

CNCPLAN_INLINE std::string rounded_text(double number, int digits) {
  std::array<char, 32> text;
  char* const end =
      std::to_chars(text.data(), text.data() + text.size(), number, std::chars_format::general, digits).ptr;
  return std::string(text.data(), end);
}

CNCPLAN_INLINE std::string value_text(double number, ErrorUnit unit) {
  constexpr double degree = std::numbers::pi / 180.0;
  return unit == ErrorUnit::radians ? rounded_text(number / degree, 10) : number_text(number);
}

CNCPLAN_INLINE std::string amount_text(const Error& error) {
  const auto rounded = [](double number) { return rounded_text(number, 6); };
  if (error.code == ErrorCode::radius_mismatch)
    return " by " + rounded(error.value) + ", at most " + rounded(error.bound) + " is allowed";
  if (error.code == ErrorCode::chord_exceeds_diameter)
    return ": " + rounded(error.value) + ", at least " + rounded(error.bound) + " is needed";
  return "";
}

CNCPLAN_INLINE std::string to_text(const Error& error) {
  const std::string_view sentence = message(error.code);
  const bool has_verb = sentence.starts_with("is ") || sentence.starts_with("must ") ||
                        sentence.starts_with("has ") || sentence.starts_with("does ") ||
                        sentence.starts_with("cannot ");
  std::string text(error.field);
  if (!text.empty()) text += ": ";
  // What cannot be reached may have no place in the axes.
  const bool has_value = error.code != ErrorCode::unreadable &&
                         (error.code != ErrorCode::unreachable || std::isfinite(error.value));
  if (has_verb && has_value)
    text += value_text(error.value, error.unit) + (error.unit == ErrorUnit::radians ? " degrees " : " ");
  text += sentence;
  switch (error.code) {
    case ErrorCode::above_limit:
    case ErrorCode::below_limit:
      return text + ' ' + value_text(error.bound, error.unit);
    case ErrorCode::end_speed_unreachable:
      return text + " (" + number_text(error.bound) + ')';
    default:
      return text + amount_text(error);
  }
}

}  // namespace cncplan
