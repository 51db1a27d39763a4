// A number together with its first three derivatives along one parameter.
#pragma once

#include "cncplan/core/compiler.hpp"

#include <cmath>
#include <concepts>

#include "cncplan/core/interval.hpp"

namespace cncplan {

/// What a jet is made of: numbers, or intervals that bound them.
template <class T>
concept JetValue = std::floating_point<T> || std::same_as<T, BasicInterval<float>> ||
    std::same_as<T, BasicInterval<double>> || std::same_as<T, BasicInterval<long double>>;

/// f, f', f'' and f''' at one value of a parameter. A formula written for numbers and evaluated with jets
/// gives the exact derivatives of its result, up to the one that jerk needs; evaluated with jets of
/// intervals, it bounds them. A plain number is a constant. The functions known are + - * /, square, sqrt,
/// sin, cos, asin, acos, exp, log, hypot and atan2.
template <JetValue T>
struct BasicJet {
  using Scalar = T;

  T value{};
  T first{};
  T second{};
  T third{};

  constexpr BasicJet() = default;
  template <std::convertible_to<T> Number>
  constexpr BasicJet(const Number& constant)  // NOLINT(google-explicit-constructor)
      : value(static_cast<T>(constant)) {}
  constexpr BasicJet(T f, T df, T ddf, T dddf) : value(f), first(df), second(ddf), third(dddf) {}

  /// The derivative; it knows one order less, and its `third` is not to be used.
  [[nodiscard]] constexpr BasicJet rate() const { return {first, second, third, T(0)}; }

  /// The function with the given value here and the given derivative.
  [[nodiscard]] static constexpr BasicJet of_rate(T value, const BasicJet& rate) {
    return {value, rate.value, rate.first, rate.second};
  }

  /// f(*this) from f and its derivatives at `value` (Faa di Bruno).
  [[nodiscard]] constexpr BasicJet through(T f, T df, T ddf, T dddf) const {
    return {f, df * first, ddf * first * first + df * second,
            dddf * first * first * first + T(3) * ddf * first * second + df * third};
  }

  friend constexpr BasicJet operator+(const BasicJet& a, const BasicJet& b) {
    return {a.value + b.value, a.first + b.first, a.second + b.second, a.third + b.third};
  }
  friend constexpr BasicJet operator-(const BasicJet& a, const BasicJet& b) {
    return {a.value - b.value, a.first - b.first, a.second - b.second, a.third - b.third};
  }
  friend constexpr BasicJet operator-(const BasicJet& a) { return {-a.value, -a.first, -a.second, -a.third}; }
  friend constexpr BasicJet operator*(const BasicJet& a, const BasicJet& b) {
    return {a.value * b.value, a.first * b.value + a.value * b.first,
            a.second * b.value + T(2) * a.first * b.first + a.value * b.second,
            a.third * b.value + T(3) * (a.second * b.first + a.first * b.second) + a.value * b.third};
  }
  /// For b != 0.
  friend constexpr BasicJet operator/(const BasicJet& a, const BasicJet& b) {
    const T i = T(1) / b.value;
    return a * b.through(i, -i * i, T(2) * i * i * i, T(-6) * i * i * i * i);
  }
  friend bool operator==(const BasicJet&, const BasicJet&) = default;
};

using Jet = BasicJet<double>;

/// For a > 0; at 0 the derivatives are not finite.
template <JetValue T>
[[nodiscard]] BasicJet<T> sqrt(const BasicJet<T>& a) {
  using std::sqrt;
  const T root = sqrt(a.value);
  const T slope = T(1) / (T(2) * root);
  const T bend = -slope / (T(2) * a.value);
  return a.through(root, slope, bend, T(-3) * bend / (T(2) * a.value));
}
template <JetValue T>
[[nodiscard]] BasicJet<T> sin(const BasicJet<T>& a) {
  using std::cos, std::sin;
  const T s = sin(a.value);
  const T c = cos(a.value);
  return a.through(s, c, -s, -c);
}
template <JetValue T>
[[nodiscard]] BasicJet<T> cos(const BasicJet<T>& a) {
  using std::cos, std::sin;
  const T s = sin(a.value);
  const T c = cos(a.value);
  return a.through(c, -s, -c, s);
}
/// x^2, of numbers too.
template <std::floating_point S>
[[nodiscard]] constexpr S square(S x) {
  return x * x;
}
/// x^2.
template <JetValue T>
[[nodiscard]] BasicJet<T> square(const BasicJet<T>& a) {
  BasicJet<T> result = a * a;
  if constexpr (!std::floating_point<T>) result.value = square(a.value);
  return result;
}
/// For -1 < a < 1; at the ends the derivatives are not finite.
template <JetValue T>
[[nodiscard]] BasicJet<T> asin(const BasicJet<T>& a) {
  using std::asin, std::sqrt;
  const T below = T(1) - square(BasicJet<T>(a.value)).value;
  const T slope = T(1) / sqrt(below);
  const T bend = a.value * slope / below;
  return a.through(asin(a.value), slope, bend, (slope + T(3) * a.value * bend) / below);
}
/// For -1 < a < 1; at the ends the derivatives are not finite.
template <JetValue T>
[[nodiscard]] BasicJet<T> acos(const BasicJet<T>& a) {
  using std::acos;
  BasicJet<T> result = -asin(a);
  result.value = acos(a.value);
  return result;
}
template <JetValue T>
[[nodiscard]] BasicJet<T> exp(const BasicJet<T>& a) {
  using std::exp;
  const T e = exp(a.value);
  return a.through(e, e, e, e);
}
/// For a > 0.
template <JetValue T>
[[nodiscard]] BasicJet<T> log(const BasicJet<T>& a) {
  using std::log;
  const T i = T(1) / a.value;
  return a.through(log(a.value), i, -i * i, T(2) * i * i * i);
}
/// Away from (0, 0).
template <JetValue T>
[[nodiscard]] BasicJet<T> hypot(const BasicJet<T>& x, const BasicJet<T>& y) {
  using std::hypot;
  BasicJet<T> r = sqrt(square(x) + square(y));
  r.value = hypot(x.value, y.value);
  return r;
}
/// Away from (0, 0).
template <JetValue T>
[[nodiscard]] BasicJet<T> atan2(const BasicJet<T>& y, const BasicJet<T>& x) {
  using std::atan2;
  return BasicJet<T>::of_rate(atan2(y.value, x.value),
                              (x * y.rate() - y * x.rate()) / (square(x) + square(y)));
}

/// A number of scalar S, or one that carries derivatives, bounds or both.
template <class T, class S>
concept NumberOver = std::same_as<T, S> || std::same_as<T, BasicJet<S>> ||
    std::same_as<T, BasicInterval<S>> || std::same_as<T, BasicJet<BasicInterval<S>>>;

}  // namespace cncplan
