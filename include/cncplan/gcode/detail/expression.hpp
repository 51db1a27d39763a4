// Values in the text: numbers, parameters, expressions in brackets and functions (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include "cncplan/core/compiled.hpp"
#include "cncplan/gcode/detail/parameters.hpp"
#include "cncplan/gcode/detail/scanner.hpp"
#include "cncplan/gcode/diagnostic.hpp"
#include "cncplan/gcode/work_coordinates.hpp"

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

// Angles are degrees. ATAN and EXISTS have a form of their own.
inline constexpr std::array functions{
    Function{"ABS", [](double x) { return std::abs(x); }},
    Function{"ACOS", [](double x) { return std::acos(x) / radians_per_degree; }},
    Function{"ASIN", [](double x) { return std::asin(x) / radians_per_degree; }},
    Function{"COS", [](double x) { return std::cos(x * radians_per_degree); }},
    Function{"EXP", [](double x) { return std::exp(x); }},
    Function{"FIX", [](double x) { return std::floor(x); }},
    Function{"FUP", [](double x) { return std::ceil(x); }},
    Function{"LN", [](double x) { return std::log(x); }},
    Function{"ROUND", [](double x) { return std::round(x); }},
    Function{"SIN", [](double x) { return std::sin(x * radians_per_degree); }},
    Function{"SQRT", [](double x) { return std::sqrt(x); }},
    Function{"TAN", [](double x) { return std::tan(x * radians_per_degree); }},
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
  void skip_blanks();

  /// A number, a parameter, an expression in brackets or a function, with or without signs.
  double value();

  /// A value that stands for a whole number.
  double whole_value();

  /// What stands behind a #.
  ParameterName parameter_name();

  /// A name in < >, in lower case and without blanks.
  std::string name();

  /// Passes a character, which must be there.
  void expect(char character);

  /// Passes a word if it comes next.
  bool take(std::string_view word);

  [[nodiscard]] int column() const { return static_cast<int>(at_) + 1; }

  /// Whether letters come next that begin no function.
  [[nodiscard]] bool is_name() const;

  /// The first error stays.
  void fail(ErrorCode code, std::string_view field, int column, double value = 0.0, double bound = 0.0) {
    if (!problem_) problem_ = Diagnostic{{code, field, value, bound}, 0, column, {}};
  }

 private:
  static constexpr char upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

  // Whether the sign to come is that of a number.
  [[nodiscard]] bool number_follows() const;

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

  double number();

  double bracket();

  // Operands of one precedence, joined from left to right.
  double operation(int precedence);

  const detail::Operation* operator_here() {
    for (const detail::Operation& operation : detail::operations)
      if (take(operation.name)) return &operation;
    return nullptr;
  }

  double parameter();

  double function();

  double argument() {
    skip_blanks();
    return bracket();
  }

  double exists();

  std::string_view line_;
  std::size_t at_;
  const Parameters& parameters_;
  std::optional<Diagnostic> problem_;
  int depth_ = 0;
};

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/detail/expression-inl.hpp"
#endif
