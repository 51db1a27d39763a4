// Numbers known to lie between two others: a formula evaluated with them bounds its result.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <numbers>
#include <type_traits>

#include "cncplan/core/compiler.hpp"

namespace cncplan {

/// All numbers from `low` to `high`, ends included. Each operation gives an interval that holds all results
/// for all numbers of its operands; it is good to rounding, which is not directed. What has no bound, such as
/// a quotient by an interval that holds zero, is the whole line.
template <std::floating_point S>
struct BasicInterval {
  using Scalar = S;

  S low{};
  S high{};

  constexpr BasicInterval() = default;
  /// A number of any type, as formulas have them: T(3), T(0.5).
  template <class Number>
    requires std::is_arithmetic_v<Number>
  constexpr BasicInterval(Number number)  // NOLINT(google-explicit-constructor)
      : low(static_cast<S>(number)), high(static_cast<S>(number)) {}
  constexpr BasicInterval(S a, S b) : low(a), high(b) {}

  [[nodiscard]] static constexpr BasicInterval whole() {
    return {-std::numeric_limits<S>::infinity(), std::numeric_limits<S>::infinity()};
  }
  /// The smallest interval that holds these numbers; the whole line where one of them is not a number.
  template <std::same_as<S>... Numbers>
  [[nodiscard]] static constexpr BasicInterval hull(S first, Numbers... others) {
    if (first != first || ((others != others) || ...)) return whole();
    return {std::min({first, others...}), std::max({first, others...})};
  }

  [[nodiscard]] constexpr bool contains(S x) const { return low <= x && x <= high; }
  /// The largest magnitude in it, and the smallest.
  [[nodiscard]] constexpr S largest() const { return std::max(-low, high); }
  [[nodiscard]] constexpr S smallest() const { return std::max({low, -high, S(0)}); }

  friend constexpr BasicInterval operator+(const BasicInterval& a, const BasicInterval& b) {
    return {a.low + b.low, a.high + b.high};
  }
  friend constexpr BasicInterval operator-(const BasicInterval& a, const BasicInterval& b) {
    return {a.low - b.high, a.high - b.low};
  }
  friend constexpr BasicInterval operator-(const BasicInterval& a) { return {-a.high, -a.low}; }
  friend constexpr BasicInterval operator*(const BasicInterval& a, const BasicInterval& b) {
    return hull(a.low * b.low, a.low * b.high, a.high * b.low, a.high * b.high);
  }
  friend constexpr BasicInterval operator/(const BasicInterval& a, const BasicInterval& b) {
    if (b.contains(S(0))) return whole();
    return hull(a.low / b.low, a.low / b.high, a.high / b.low, a.high / b.high);
  }
  friend constexpr bool operator==(const BasicInterval&, const BasicInterval&) = default;
};

using Interval = BasicInterval<double>;

/// Of the numbers in it that are not negative.
template <std::floating_point S>
[[nodiscard]] BasicInterval<S> sqrt(const BasicInterval<S>& a) {
  return {std::sqrt(std::max(a.low, S(0))), std::sqrt(std::max(a.high, S(0)))};
}
/// x^2: unlike x * x it knows that both factors are the same number.
template <std::floating_point S>
[[nodiscard]] constexpr BasicInterval<S> square(const BasicInterval<S>& a) {
  return {a.smallest() * a.smallest(), a.largest() * a.largest()};
}
template <std::floating_point S>
[[nodiscard]] BasicInterval<S> abs(const BasicInterval<S>& a) {
  return {a.smallest(), a.largest()};
}
template <std::floating_point S>
[[nodiscard]] BasicInterval<S> cos(const BasicInterval<S>& a) {
  constexpr S pi = std::numbers::pi_v<S>;
  if (!(a.high - a.low < S(2) * pi)) return {S(-1), S(1)};
  BasicInterval<S> result = BasicInterval<S>::hull(std::cos(a.low), std::cos(a.high));
  const S first = std::ceil(a.low / pi);  // the first multiple of pi, where the cosine has an extremum
  for (S n = first; n * pi <= a.high && n < first + S(2); n += S(1))
    (std::fmod(n, S(2)) == S(0) ? result.high : result.low) = std::fmod(n, S(2)) == S(0) ? S(1) : S(-1);
  return result;
}
template <std::floating_point S>
[[nodiscard]] BasicInterval<S> sin(const BasicInterval<S>& a) {
  const S quarter = std::numbers::pi_v<S> / S(2);
  return cos(a - BasicInterval<S>(quarter));
}
template <std::floating_point S>
[[nodiscard]] BasicInterval<S> exp(const BasicInterval<S>& a) {
  return {std::exp(a.low), std::exp(a.high)};
}
/// Of the numbers in it that are positive.
template <std::floating_point S>
[[nodiscard]] BasicInterval<S> log(const BasicInterval<S>& a) {
  return {std::log(std::max(a.low, S(0))), std::log(std::max(a.high, S(0)))};
}
template <std::floating_point S>
[[nodiscard]] BasicInterval<S> hypot(const BasicInterval<S>& x, const BasicInterval<S>& y) {
  return {std::hypot(x.smallest(), y.smallest()), std::hypot(x.largest(), y.largest())};
}
/// Of the numbers in it from -1 to 1.
template <std::floating_point S>
[[nodiscard]] BasicInterval<S> asin(const BasicInterval<S>& a) {
  return {std::asin(std::clamp(a.low, S(-1), S(1))), std::asin(std::clamp(a.high, S(-1), S(1)))};
}
/// Of the numbers in it from -1 to 1.
template <std::floating_point S>
[[nodiscard]] BasicInterval<S> acos(const BasicInterval<S>& a) {
  return {std::acos(std::clamp(a.high, S(-1), S(1))), std::acos(std::clamp(a.low, S(-1), S(1)))};
}
/// The angles of a rectangle of points; all angles where it holds the origin or crosses the ray on which the
/// angle jumps.
template <std::floating_point S>
[[nodiscard]] BasicInterval<S> atan2(const BasicInterval<S>& y, const BasicInterval<S>& x) {
  constexpr S pi = std::numbers::pi_v<S>;
  if (x.low <= S(0) && y.contains(S(0))) return {-pi, pi};
  return BasicInterval<S>::hull(std::atan2(y.low, x.low), std::atan2(y.low, x.high),
                                std::atan2(y.high, x.low), std::atan2(y.high, x.high));
}

}  // namespace cncplan
