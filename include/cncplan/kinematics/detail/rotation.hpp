// Rotations of points that are numbers, or carry derivatives and bounds.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "cncplan/core/jet.hpp"

namespace cncplan::kinematics {

/// A point turned by `angle`, rad, about an axis of its frame: by the right hand, seen from the axis' tip
/// counter-clockwise.
template <class T>
[[nodiscard]] std::array<T, 3> about_x(const T& angle, const std::array<T, 3>& p) {
  using std::cos, std::sin;
  const T s = sin(angle), c = cos(angle);
  return {p[0], c * p[1] - s * p[2], s * p[1] + c * p[2]};
}
template <class T>
[[nodiscard]] std::array<T, 3> about_y(const T& angle, const std::array<T, 3>& p) {
  using std::cos, std::sin;
  const T s = sin(angle), c = cos(angle);
  return {c * p[0] + s * p[2], p[1], c * p[2] - s * p[0]};
}
template <class T>
[[nodiscard]] std::array<T, 3> about_z(const T& angle, const std::array<T, 3>& p) {
  using std::cos, std::sin;
  const T s = sin(angle), c = cos(angle);
  return {c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]};
}

/// Which axis tilts the tool or the part: A about X, or B about Y.
enum class Tilt { a, b };

template <Tilt tilt, class T>
[[nodiscard]] std::array<T, 3> about_tilt(const T& angle, const std::array<T, 3>& p) {
  if constexpr (tilt == Tilt::a)
    return about_x(angle, p);
  else
    return about_y(angle, p);
}

/// The two positions of a tilting axis and of C, rad, that give a direction of the tool. (x, y) is where that
/// leans to, as C counts; an upright one leans nowhere, and C is 0 then.
template <class S>
[[nodiscard]] std::array<std::array<S, 2>, 2> tilt_and_turn(const std::array<S, 3>& direction, S x, S y) {
  const S tilt = std::atan2(std::hypot(direction[0], direction[1]), direction[2]);
  const S turn = tilt > S(0) ? std::atan2(y, x) : S(0);
  return {{{tilt, turn}, {-tilt, turn + std::numbers::pi_v<S>}}};
}

/// Sums and differences of points, of which some may be plain numbers.
template <class T, class A, class B>
[[nodiscard]] std::array<T, 3> sum(const std::array<A, 3>& a, const std::array<B, 3>& b) {
  return {T(a[0]) + T(b[0]), T(a[1]) + T(b[1]), T(a[2]) + T(b[2])};
}
template <class T, class A, class B>
[[nodiscard]] std::array<T, 3> difference(const std::array<A, 3>& a, const std::array<B, 3>& b) {
  return {T(a[0]) - T(b[0]), T(a[1]) - T(b[1]), T(a[2]) - T(b[2])};
}

}  // namespace cncplan::kinematics
