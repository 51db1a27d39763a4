// A robot arm of two links that move level, with a slide.
#pragma once

#include <array>
#include <cmath>
#include <string_view>

#include "cncplan/core/jet.hpp"

namespace cncplan::kinematics {

/// The angles, rad, of an arm of two links in a plane whose end is at (x, y): of the first link from x, and
/// of the second one from the first. `left`: the elbow stands to the left of the way to the end. Beyond the
/// arm's reach, and nearer than the difference of the links, the angles are not numbers; at both bounds
/// (the arm stretched or folded) their derivatives are infinite.
template <class T, class S>
[[nodiscard]] std::array<T, 2> two_links(const T& x, const T& y, S upper, S fore, bool left) {
  using std::atan2, std::sqrt;
  const T far_sq = square(x) + square(y);
  const T cosine = (far_sq - T(upper * upper + fore * fore)) / T(S(2) * upper * fore);
  const T size = sqrt(T(1) - square(cosine));
  const T sine = left ? -size : size;
  return {atan2(y, x) - atan2(T(fore) * sine, T(upper) + T(fore) * cosine), atan2(sine, cosine)};
}

/// SCARA: shoulder and elbow, rad, and a slide, mm. Program: X Y Z, mm. The tip stands at
/// x = upper cos q1 + fore cos(q1 + q2), y = upper sin q1 + fore sin(q1 + q2). Singular where the arm is
/// stretched or folded (the edge of its reach: motion slows, and ends there in an error), and on the
/// shoulder's axis. Source: Siciliano et al., Robotics, 2009, section 2.12.1 (three-link planar arm).
template <std::floating_point S>
struct BasicScara {
  using Scalar = S;
  static constexpr int axis_count = 3;

  S upper = S(200);  ///< mm: shoulder to elbow
  S fore = S(150);   ///< mm: elbow to tool
  bool left{};       ///< the elbow stands to the left of the way from the shoulder to the tool

  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> joints(const std::array<T, 3>& p) const {
    const auto [shoulder, elbow] = two_links(p[0], p[1], upper, fore, left);
    return {shoulder, elbow, p[2]};
  }
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> point(const std::array<T, 3>& q) const {
    using std::cos, std::sin;
    const T both = q[0] + q[1];
    return {T(upper) * cos(q[0]) + T(fore) * cos(both), T(upper) * sin(q[0]) + T(fore) * sin(both), q[2]};
  }
};

using Scara = BasicScara<double>;

/// The same with a wrist: C of the program is the direction of the tool in space, rad, and the wrist, the
/// fourth joint, turns by c - q1 - q2. Source: LinuxCNC, scarakins.
template <std::floating_point S>
struct BasicScaraWrist {
  using Scalar = S;
  static constexpr int axis_count = 4;
  static constexpr std::string_view coordinates = "XYZC";

  BasicScara<S> arm{};

  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 4> joints(const std::array<T, 4>& p) const {
    const auto q = arm.joints(std::array<T, 3>{p[0], p[1], p[2]});
    return {q[0], q[1], q[2], p[3] - q[0] - q[1]};
  }
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 4> point(const std::array<T, 4>& q) const {
    const auto p = arm.point(std::array<T, 3>{q[0], q[1], q[2]});
    return {p[0], p[1], p[2], q[0] + q[1] + q[3]};
  }
};

using ScaraWrist = BasicScaraWrist<double>;

}  // namespace cncplan::kinematics
