// Values in the text: numbers, parameters, expressions in brackets and functions (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "cncplan/gcode/diagnostic.hpp"
#include "cncplan/gcode/language/parameters.hpp"
#include "cncplan/gcode/scanner.hpp"

namespace cncplan::gcode {

/// Two numbers are EQ within this distance, as LinuxCNC 2.10 has it.
inline constexpr double equal_within = 1e-6;

/// What stands for a whole number may be so far from it.
inline constexpr double whole_within = 1e-4;

/// Brackets and signs that may stand within each other.
inline constexpr int max_nesting = 50;

/// A parameter by its number, or by its name in lower case without blanks.
using ParameterName = std::variant<double, std::string>;

namespace detail {

struct Operation {
  std::string_view name;
  int precedence{};  ///< a higher one is carried out first; those of one precedence from left to right
  double (*apply)(double, double){};
  std::string_view result{};  ///< what an error calls its result
  bool divides = false;
};

// A longer name stands before its beginning.
inline constexpr std::array operations{
    Operation{"**", 5, [](double a, double b) { return std::pow(a, b); }, "result of **"},
    Operation{"*", 4, [](double a, double b) { return a * b; }, "result of *"},
    Operation{"/", 4, [](double a, double b) { return a / b; }, "result of /", true},
    Operation{"MOD", 4,
              [](double a, double b) {
                const double rest = std::fmod(a, b);
                return rest < 0.0 ? rest + std::abs(b) : rest;
              },
              "result of MOD", true},
    Operation{"+", 3, [](double a, double b) { return a + b; }, "result of +"},
    Operation{"-", 3, [](double a, double b) { return a - b; }, "result of -"},
    Operation{"EQ", 2, [](double a, double b) { return std::abs(a - b) < equal_within ? 1.0 : 0.0; }},
    Operation{"NE", 2, [](double a, double b) { return std::abs(a - b) < equal_within ? 0.0 : 1.0; }},
    Operation{"GT", 2, [](double a, double b) { return a > b ? 1.0 : 0.0; }},
    Operation{"GE", 2, [](double a, double b) { return a >= b - equal_within ? 1.0 : 0.0; }},
    Operation{"LT", 2, [](double a, double b) { return a < b ? 1.0 : 0.0; }},
    Operation{"LE", 2, [](double a, double b) { return a <= b + equal_within ? 1.0 : 0.0; }},
    Operation{"AND", 1, [](double a, double b) { return a != 0.0 && b != 0.0 ? 1.0 : 0.0; }},
    Operation{"OR", 1, [](double a, double b) { return a != 0.0 || b != 0.0 ? 1.0 : 0.0; }},
    Operation{"XOR", 1, [](double a, double b) { return (a != 0.0) != (b != 0.0) ? 1.0 : 0.0; }},
};
inline constexpr int highest_precedence = 5;

struct Function {
  std::string_view name;
  double (*apply)(double){};
};

inline constexpr double degree = std::numbers::pi / 180.0;

// Angles are degrees. ATAN and EXISTS have a form of their own.
inline constexpr std::array functions{
    Function{"ABS", [](double x) { return std::abs(x); }},
    Function{"ACOS", [](double x) { return std::acos(x) / degree; }},
    Function{"ASIN", [](double x) { return std::asin(x) / degree; }},
    Function{"COS", [](double x) { return std::cos(x * degree); }},
    Function{"EXP", [](double x) { return std::exp(x); }},
    Function{"FIX", [](double x) { return std::floor(x); }},
    Function{"FUP", [](double x) { return std::ceil(x); }},
    Function{"LN", [](double x) { return std::log(x); }},
    Function{"ROUND", [](double x) { return std::round(x); }},
    Function{"SIN", [](double x) { return std::sin(x * degree); }},
    Function{"SQRT", [](double x) { return std::sqrt(x); }},
    Function{"TAN", [](double x) { return std::tan(x * degree); }},
};

}  // namespace detail

/// Reads values from a line, from a byte on. After an error all is 0, and `problem` says what it was.
class Expression {
 public:
  Expression(std::string_view line, std::size_t at, const Parameters& parameters)
      : line_(line), at_(at), parameters_(parameters) {}

  [[nodiscard]] const std::optional<Diagnostic>& problem() const { return problem_; }

  /// Index of the character to come, and the character in upper case; 0 at the end.
  [[nodiscard]] std::size_t at() const { return at_; }
  [[nodiscard]] char peek() const { return at_ < line_.size() ? upper(line_[at_]) : '\0'; }
  /// Passes blanks and closed comments.
  void skip_blanks() {
    for (;;) {
      if (peek() == '(' && comment_end(line_, at_) != std::string_view::npos)
        at_ = comment_end(line_, at_);
      else if (peek() == ' ' || peek() == '\t')
        ++at_;
      else
        return;
    }
  }

  /// A number, a parameter, an expression in brackets or a function, with or without signs.
  double value() {
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

  /// A value that stands for a whole number.
  double whole_value() {
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

  /// What stands behind a #.
  ParameterName parameter_name() {
    ++at_;
    skip_blanks();
    if (peek() == '<') return name();
    if (is_name()) {
      fail(ErrorCode::not_supported, "name of a parameter without < >", column());
      return 0.0;
    }
    return nested([this] { return whole_value(); });
  }

  /// A name in < >, in lower case and without blanks.
  std::string name() {
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

  /// Passes a character, which must be there.
  void expect(char character) {
    skip_blanks();
    if (peek() == character) {
      ++at_;
    } else {
      fail(ErrorCode::missing_word, gcode::name(character), column());
    }
  }

  /// Passes a word if it comes next.
  bool take(std::string_view word) {
    for (std::size_t i = 0; i < word.size(); ++i)
      if (at_ + i >= line_.size() || upper(line_[at_ + i]) != word[i]) return false;
    at_ += word.size();
    return true;
  }

  [[nodiscard]] int column() const { return static_cast<int>(at_) + 1; }

  /// Whether letters come next that begin no function.
  [[nodiscard]] bool is_name() const {
    if (peek() != '_' && (peek() < 'A' || peek() > 'Z')) return false;
    Expression ahead = *this;
    if (ahead.take("ATAN") || ahead.take("EXISTS")) return false;
    return std::none_of(detail::functions.begin(), detail::functions.end(),
                        [&ahead](const detail::Function& function) { return ahead.take(function.name); });
  }

  /// The first error stays.
  void fail(ErrorCode code, std::string_view field, int column, double value = 0.0, double bound = 0.0) {
    if (!problem_) problem_ = Diagnostic{{code, field, value, bound}, 0, column, {}};
  }

 private:
  static constexpr char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

  // Whether the sign to come is that of a number.
  [[nodiscard]] bool number_follows() const {
    if (at_ + 1 >= line_.size()) return true;
    const char next = line_[at_ + 1];
    return (next >= '0' && next <= '9') || next == '.';
  }

  template <class F>
  double nested(F&& inner) {
    if (depth_ == max_nesting) {
      fail(ErrorCode::above_limit, "nesting", column(), max_nesting + 1, max_nesting);
      return 0.0;
    }
    ++depth_;
    const double result = problem_ ? 0.0 : inner();
    --depth_;
    return result;
  }

  double number() {
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

  double bracket() {
    expect('[');
    const double result = nested([this] { return operation(1); });
    expect(']');
    return result;
  }

  // Operands of one precedence, joined from left to right.
  double operation(int precedence) {
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

  const detail::Operation* operator_here() {
    for (const detail::Operation& operation : detail::operations)
      if (take(operation.name)) return &operation;
    return nullptr;
  }

  double parameter() {
    const int column = this->column();
    const ParameterName name = parameter_name();
    if (problem_) return 0.0;
    if (const auto* text = std::get_if<std::string>(&name)) {
      const auto value = parameters_.get(*text);
      if (!value) fail(ErrorCode::not_defined, "named parameter", column);
      return value.value_or(0.0);
    }
    const auto value = parameters_.get(std::get<double>(name));
    if (!value)
      fail(value.error().code, value.error().field, column, value.error().value, value.error().bound);
    return value.value_or(0.0);
  }

  double function() {
    const int column = this->column();
    if (take("ATAN")) {
      const double y = argument();
      expect('/');
      return std::atan2(y, argument()) / detail::degree;
    }
    if (take("EXISTS")) return exists();
    for (const detail::Function& function : detail::functions)
      if (take(function.name)) return function.apply(argument());
    fail(ErrorCode::not_supported, "function", column);
    return 0.0;
  }

  double argument() {
    skip_blanks();
    return bracket();
  }

  double exists() {
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

  std::string_view line_;
  std::size_t at_;
  const Parameters& parameters_;
  std::optional<Diagnostic> problem_;
  int depth_ = 0;
};

}  // namespace cncplan::gcode
