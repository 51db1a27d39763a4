// A number together with its first three derivatives along one parameter.
#pragma once

#include <cmath>
#include <concepts>

namespace cncplan {

/// f, f', f'' and f''' at one value of a parameter. A formula written for numbers and evaluated with jets
/// gives the exact derivatives of its result, up to the one that jerk needs. A plain number is a constant.
template <std::floating_point S>
struct BasicJet {
  using Scalar = S;

  S value{};
  S first{};
  S second{};
  S third{};

  constexpr BasicJet() = default;
  constexpr BasicJet(S constant) : value(constant) {}  // NOLINT(google-explicit-constructor)
  constexpr BasicJet(S f, S df, S ddf, S dddf) : value(f), first(df), second(ddf), third(dddf) {}

  /// The derivative; it knows one order less, and its `third` is not to be used.
  [[nodiscard]] constexpr BasicJet rate() const { return {first, second, third, S(0)}; }

  /// The function with the given value here and the given derivative.
  [[nodiscard]] static constexpr BasicJet of_rate(S value, const BasicJet& rate) {
    return {value, rate.value, rate.first, rate.second};
  }

  /// f(*this) from f and its derivatives at `value` (Faa di Bruno).
  [[nodiscard]] constexpr BasicJet through(S f, S df, S ddf, S dddf) const {
    return {f, df * first, ddf * first * first + df * second,
            dddf * first * first * first + S(3) * ddf * first * second + df * third};
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
            a.second * b.value + S(2) * a.first * b.first + a.value * b.second,
            a.third * b.value + S(3) * (a.second * b.first + a.first * b.second) + a.value * b.third};
  }
  /// For b != 0.
  friend constexpr BasicJet operator/(const BasicJet& a, const BasicJet& b) {
    const S i = S(1) / b.value;
    return a * b.through(i, -i * i, S(2) * i * i * i, S(-6) * i * i * i * i);
  }
  friend bool operator==(const BasicJet&, const BasicJet&) = default;
};

using Jet = BasicJet<double>;

/// For a > 0; at 0 the derivatives are not finite.
template <std::floating_point S>
[[nodiscard]] BasicJet<S> sqrt(const BasicJet<S>& a) {
  const S root = std::sqrt(a.value);
  const S slope = S(1) / (S(2) * root);
  const S bend = -slope / (S(2) * a.value);
  return a.through(root, slope, bend, S(-3) * bend / (S(2) * a.value));
}
template <std::floating_point S>
[[nodiscard]] BasicJet<S> sin(const BasicJet<S>& a) {
  const S s = std::sin(a.value);
  const S c = std::cos(a.value);
  return a.through(s, c, -s, -c);
}
template <std::floating_point S>
[[nodiscard]] BasicJet<S> cos(const BasicJet<S>& a) {
  const S s = std::sin(a.value);
  const S c = std::cos(a.value);
  return a.through(c, -s, -c, s);
}
/// Away from (0, 0).
template <std::floating_point S>
[[nodiscard]] BasicJet<S> hypot(const BasicJet<S>& x, const BasicJet<S>& y) {
  BasicJet<S> r = sqrt(x * x + y * y);
  r.value = std::hypot(x.value, y.value);
  return r;
}
/// Away from (0, 0).
template <std::floating_point S>
[[nodiscard]] BasicJet<S> atan2(const BasicJet<S>& y, const BasicJet<S>& x) {
  return BasicJet<S>::of_rate(std::atan2(y.value, x.value), (x * y.rate() - y * x.rate()) / (x * x + y * y));
}

/// A scalar, or a jet of one.
template <class T, class S>
concept NumberOver = std::same_as<T, S> || std::same_as<T, BasicJet<S>>;

}  // namespace cncplan
