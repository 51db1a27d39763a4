// Machines that hold their tool by three pairs of rods: on slides, and on arms.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "cncplan/core/jet.hpp"
#include "cncplan/kinematics/detail/rotation.hpp"

namespace cncplan::kinematics {

/// The lower of the two points at one distance from three others (trilateration): they lie in a plane that is
/// not upright, nearly level as a rule. Where the rods do not reach each other it is no number.
template <class T, class S>
[[nodiscard]] std::array<T, 3> below(const std::array<std::array<T, 3>, 3>& ends, S rod) {
  using std::sqrt;
  const auto dot = [](const std::array<T, 3>& a, const std::array<T, 3>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  };
  const auto one = difference<T>(ends[1], ends[0]), two = difference<T>(ends[2], ends[0]);
  const std::array<T, 3> up{one[1] * two[2] - one[2] * two[1], one[2] * two[0] - one[0] * two[2],
                            one[0] * two[1] - one[1] * two[0]};
  // From the first end to the centre of the circle through the three, and down from there.
  const T aa = dot(one, one), bb = dot(two, two), ab = dot(one, two), area_sq = dot(up, up);
  const T u = bb * (aa - ab) / (T(2) * area_sq), v = aa * (bb - ab) / (T(2) * area_sq);
  std::array<T, 3> center;
  for (std::size_t k = 0; k < 3; ++k) center[k] = u * one[k] + v * two[k];
  const T fall = sqrt((T(rod * rod) - dot(center, center)) / area_sq);
  for (std::size_t k = 0; k < 3; ++k) center[k] = ends[0][k] + center[k] - fall * up[k];
  return center;
}

/// The three towers' directions, 90, 210 and 330 degrees from X: cosine and sine.
template <class S>
[[nodiscard]] std::array<std::array<S, 2>, 3> tower_directions() {
  const S half = S(1) / S(2), root = std::sqrt(S(3)) / S(2);
  return {{{S(0), S(1)}, {-root, -half}, {root, -half}}};
}

/// Linear delta: three upright slides, mm, at `radius` from the middle, in the directions 90, 210 and 330
/// degrees, with rods of one length down to the tool. Program: X Y Z, mm. Slide i stands at
/// z + sqrt(rod^2 - (x - x_i)^2 - (y - y_i)^2). Singular where a rod lies level (the edge of its reach: the
/// slide's speed grows without bound, motion slows, and beyond is an error). Source: LinuxCNC,
/// lineardeltakins.
template <std::floating_point S>
struct BasicLinearDelta {
  using Scalar = S;
  static constexpr int axis_count = 3;

  S radius = S(140);  ///< mm: from the middle to the slides, less that from the tool to the rods
  S rod = S(270);     ///< mm, > radius

  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> joints(const std::array<T, 3>& p) const {
    using std::sqrt;
    std::array<T, 3> result;
    const auto towers = tower_directions<S>();
    for (std::size_t i = 0; i < 3; ++i)
      result[i] = p[2] + sqrt(T(rod * rod) - square(p[0] - T(radius * towers[i][0])) -
                              square(p[1] - T(radius * towers[i][1])));
    return result;
  }
  /// The tool hangs below the slides.
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> point(const std::array<T, 3>& q) const {
    std::array<std::array<T, 3>, 3> ends;
    const auto towers = tower_directions<S>();
    for (std::size_t i = 0; i < 3; ++i) ends[i] = {T(radius * towers[i][0]), T(radius * towers[i][1]), q[i]};
    return below(ends, rod);
  }
};

using LinearDelta = BasicLinearDelta<double>;

/// Rotary delta: three arms, rad, whose hips lie at `base` from the middle in the directions 90, 210 and 330
/// degrees, and at Z 0; rods go from their ends down to a platform of the radius `platform`. Program: X Y Z,
/// mm, Z below 0. An angle is counted downwards from level: with a the outward and z the upward distance of
/// the rod's foot from the hip in the arm's plane, r = hypot(a, z), and t its distance beside that plane,
///
///     angle = atan2(-z, a) - acos((r^2 + t^2 + arm^2 - rod^2) / (2 arm r))
///
/// Singular where arm and rod lie in one line seen along the hip (the edge of its reach). Source: LinuxCNC,
/// rotarydeltakins.
template <std::floating_point S>
struct BasicRotaryDelta {
  using Scalar = S;
  static constexpr int axis_count = 3;

  S base = S(120);     ///< mm: from the middle to the hips
  S platform = S(40);  ///< mm: from the tool to the feet of the rods
  S arm = S(150);      ///< mm
  S rod = S(320);      ///< mm

  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> joints(const std::array<T, 3>& p) const {
    using std::atan2, std::sqrt;
    std::array<T, 3> result;
    const auto towers = tower_directions<S>();
    for (std::size_t i = 0; i < 3; ++i) {
      const T cosine(towers[i][0]), sine(towers[i][1]);
      const T out = p[0] * cosine + p[1] * sine + T(platform - base);
      const T beside = p[1] * cosine - p[0] * sine;
      const T far_sq = square(out) + square(p[2]);
      const T along = (far_sq + square(beside) + T(arm * arm - rod * rod)) / T(S(2) * arm);
      result[i] = atan2(-p[2], out) - atan2(sqrt(far_sq - square(along)), along);
    }
    return result;
  }
  /// The platform hangs below the arms.
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> point(const std::array<T, 3>& q) const {
    using std::cos, std::sin;
    std::array<std::array<T, 3>, 3> ends;
    const auto towers = tower_directions<S>();
    for (std::size_t i = 0; i < 3; ++i) {
      const T out = T(base - platform) + T(arm) * cos(q[i]);
      ends[i] = {out * T(towers[i][0]), out * T(towers[i][1]), -T(arm) * sin(q[i])};
    }
    return below(ends, rod);
  }
};

using RotaryDelta = BasicRotaryDelta<double>;

}  // namespace cncplan::kinematics
