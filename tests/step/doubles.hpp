// Paths, profiles and edges that the tests of step own: simple enough to be known exactly by other means.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "cncplan/core/phase.hpp"
#include "cncplan/core/vector.hpp"
#include "cncplan/step/edge.hpp"

namespace cncplan::test {

/// x = amplitude sin(u), y = slope u + offset, for u in [0, end]; the length is counted as u.
template <std::floating_point S>
struct SineAxis {
  using Scalar = S;
  using Vector = VectorN<S, 2>;
  S amplitude{1};
  S slope{};
  S end{};
  S offset{};

  [[nodiscard]] S length() const { return end; }
  [[nodiscard]] S parameter_end() const { return end; }
  [[nodiscard]] S length_at(S u) const { return u; }
  [[nodiscard]] Vector position(S u) const { return {amplitude * std::sin(u), offset + slope * u}; }
  [[nodiscard]] Vector derivative(S u) const { return {amplitude * std::cos(u), slope}; }
  [[nodiscard]] Vector second_derivative(S u) const { return {-amplitude * std::sin(u), S(0)}; }
  [[nodiscard]] S next_reversal(int axis, S u) const {
    if (axis == 1) return end;
    const S pi = std::numbers::pi_v<S>;
    S n = std::floor(u / pi + S(0.5));
    while (n * pi + pi / 2 <= u) n += S(1);
    return std::min(n * pi + pi / 2, end);
  }
  [[nodiscard]] S crossing(int axis, S value, S low, S high) const {
    if (axis == 1) return std::clamp((value - offset) / slope, low, high);
    const S pi = std::numbers::pi_v<S>;
    const S n = std::round((low + high) / 2 / pi);
    const S angle = std::asin(std::clamp(value / amplitude, S(-1), S(1)));
    return std::clamp(n * pi + (std::fmod(n, S(2)) == S(0) ? angle : -angle), low, high);
  }
};

/// Straight along one axis, from and to exact values.
template <std::floating_point S>
struct Straight {
  using Scalar = S;
  using Vector = VectorN<S, 1>;
  S from{};
  S to{};

  [[nodiscard]] S length() const { return std::abs(to - from); }
  [[nodiscard]] S parameter_end() const { return length(); }
  [[nodiscard]] S length_at(S u) const { return u; }
  [[nodiscard]] Vector derivative(S) const { return Vector(to < from ? S(-1) : S(1)); }
  [[nodiscard]] Vector second_derivative(S) const { return Vector(S(0)); }
  [[nodiscard]] Vector position(S u) const {
    if (u >= length()) return Vector(to);
    return Vector(from + u * derivative(u)(0));
  }
  [[nodiscard]] S next_reversal(int, S) const { return length(); }
  [[nodiscard]] S crossing(int, S value, S low, S high) const {
    return std::clamp(std::abs(value - from), low, high);
  }
};

/// The same speed all the way.
template <std::floating_point S>
std::array<BasicPhase<S>, 1> steady(S length, S speed) {
  return {{{S(0), length / speed, S(0), speed, S(0), S(0)}}};
}

/// From rest to rest with constant jerk in four phases (each a quarter of the time): no cruise.
template <std::floating_point S>
std::array<BasicPhase<S>, 4> rest_to_rest(S length, S jerk) {
  const S t = std::cbrt(length / (S(2) * jerk));  // length = 2 j t^3
  const S d = jerk * t * t * t / S(6), a = jerk * t, v = jerk * t * t;
  return {{{S(0), t, S(0), S(0), S(0), jerk},
           {t, t, d, v / S(2), a, -jerk},
           {S(2) * t, t, S(6) * d, v, S(0), -jerk},
           {S(3) * t, t, S(11) * d, v / S(2), -a, jerk}}};
}

/// Edges written by hand.
struct Listed {
  using Scalar = double;
  std::vector<step::Edge> edges;
  std::size_t at = 0;
  std::optional<step::Edge> next() { return at < edges.size() ? std::optional(edges[at++]) : std::nullopt; }
};

}  // namespace cncplan::test
