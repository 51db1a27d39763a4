// Definitions of expression.hpp (set-up).
#pragma once

#include "cncplan/gcode/detail/expression.hpp"

namespace cncplan::gcode {

CNCPLAN_INLINE void Expression::skip_blanks() {
  for (;;) {
    if (peek() == '(' && comment_end(line_, at_) != std::string_view::npos)
      at_ = comment_end(line_, at_);
    else if (peek() == ' ' || peek() == '\t')
      ++at_;
    else
      return;
  }
}

CNCPLAN_INLINE double Expression::value() {
  skip_blanks();
  const int column = this->column();
  double result = 0.0;
  const bool sign = peek() == '+' || peek() == '-';
  if (sign && !number_follows()) {
    const bool minus = peek() == '-';
    ++at_;
    result = nested([this] { return value(); });
    if (minus) result = -result;
  } else if (peek() == '[') {
    result = bracket();
  } else if (peek() == '#') {
    result = parameter();
  } else if (peek() >= 'A' && peek() <= 'Z') {
    result = function();
  } else {
    result = number();
  }
  if (!problem_ && !std::isfinite(result)) fail(ErrorCode::not_finite, "value", column, result);
  return problem_ ? 0.0 : result;
}

CNCPLAN_INLINE double Expression::whole_value() {
  skip_blanks();
  const int column = this->column();
  const double value = this->value();
  if (std::abs(value) > max_number) {
    fail(ErrorCode::above_limit, "value", column, value, max_number);
    return 0.0;
  }
  const double whole = std::round(value);
  if (std::abs(value - whole) > whole_within) fail(ErrorCode::not_an_integer, "value", column, value);
  return whole;
}

CNCPLAN_INLINE ParameterName Expression::parameter_name() {
  ++at_;
  skip_blanks();
  if (peek() == '<') return name();
  if (is_name()) {
    fail(ErrorCode::not_supported, "name of a parameter without < >", column());
    return 0.0;
  }
  return nested([this] { return whole_value(); });
}

CNCPLAN_INLINE std::string Expression::name() {
  const int column = this->column();
  std::string name;
  for (++at_; at_ < line_.size(); ++at_) {
    const char c = line_[at_];
    if (c == '>') {
      ++at_;
      return name;
    }
    if (c != ' ' && c != '\t') name += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  }
  fail(ErrorCode::unclosed, "<", column);
  return name;
}

CNCPLAN_INLINE void Expression::expect(char character) {
  skip_blanks();
  if (peek() == character) {
    ++at_;
  } else {
    fail(ErrorCode::missing_word, gcode::name(character), column());
  }
}

CNCPLAN_INLINE bool Expression::take(std::string_view word) {
  for (std::size_t i = 0; i < word.size(); ++i)
    if (at_ + i >= line_.size() || upper(line_[at_ + i]) != word[i]) return false;
  at_ += word.size();
  return true;
}

CNCPLAN_INLINE bool Expression::is_name() const {
  if (peek() != '_' && (peek() < 'A' || peek() > 'Z')) return false;
  Expression ahead = *this;
  if (ahead.take("ATAN") || ahead.take("EXISTS")) return false;
  return std::none_of(detail::functions.begin(), detail::functions.end(),
                      [&ahead](const detail::Function& function) { return ahead.take(function.name); });
}

CNCPLAN_INLINE bool Expression::number_follows() const {
  if (at_ + 1 >= line_.size()) return true;
  const char next = line_[at_ + 1];
  return (next >= '0' && next <= '9') || next == '.';
}

CNCPLAN_INLINE double Expression::number() {
  Scanner scanner(line_, at_);
  const auto number = scanner.read_number('=', column());
  if (!number) {
    const Error& error = number.error().error;
    fail(error.code, "value", column(), error.value, error.bound);
    return 0.0;
  }
  at_ = static_cast<std::size_t>(scanner.column() - 1);
  return *number;
}

CNCPLAN_INLINE double Expression::bracket() {
  expect('[');
  const double result = nested([this] { return operation(1); });
  expect(']');
  return result;
}

CNCPLAN_INLINE double Expression::operation(int precedence) {
  const auto operand = [&] {
    return precedence == detail::highest_precedence ? value() : operation(precedence + 1);
  };
  double left = operand();
  while (!problem_) {
    skip_blanks();
    const std::size_t before = at_;
    const detail::Operation* const found = operator_here();
    if (found == nullptr || found->precedence != precedence) {
      at_ = before;
      return left;
    }
    const double right = operand();
    const int column = static_cast<int>(before) + 1;
    if (found->divides && right == 0.0) fail(ErrorCode::division_by_zero, found->name, column, left);
    left = found->apply(left, right);
    if (!std::isfinite(left)) fail(ErrorCode::not_finite, found->result, column, left);
  }
  return 0.0;
}

CNCPLAN_INLINE double Expression::parameter() {
  const int column = this->column();
  const ParameterName name = parameter_name();
  if (problem_) return 0.0;
  if (const auto* text = std::get_if<std::string>(&name)) {
    const auto value = parameters_.get(*text);
    if (!value) fail(ErrorCode::not_defined, "named parameter", column);
    return value.value_or(0.0);
  }
  const auto value = parameters_.get(std::get<double>(name));
  if (!value) fail(value.error().code, value.error().field, column, value.error().value, value.error().bound);
  return value.value_or(0.0);
}

CNCPLAN_INLINE double Expression::function() {
  const int column = this->column();
  if (take("ATAN")) {
    const double y = argument();
    expect('/');
    return std::atan2(y, argument()) / radians_per_degree;
  }
  if (take("EXISTS")) return exists();
  for (const detail::Function& function : detail::functions)
    if (take(function.name)) return function.apply(argument());
  fail(ErrorCode::not_supported, "function", column);
  return 0.0;
}

CNCPLAN_INLINE double Expression::exists() {
  skip_blanks();
  expect('[');
  skip_blanks();
  if (peek() != '#') {
    fail(ErrorCode::missing_word, "#", column());
    return 0.0;
  }
  const ParameterName name = parameter_name();
  expect(']');
  if (const auto* text = std::get_if<std::string>(&name)) return parameters_.get(*text) ? 1.0 : 0.0;
  return parameters_.get(std::get<double>(name)) ? 1.0 : 0.0;
}

}  // namespace cncplan::gcode
