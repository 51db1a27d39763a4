// A robot arm of six joints whose last three axes meet in one point.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "cncplan/core/jet.hpp"
#include "cncplan/kinematics/detail/rotation.hpp"

namespace cncplan::kinematics {

/// 6R arm with a spherical wrist. Joints, rad: base about Z, shoulder and elbow (0: the upper arm stands
/// upright and the forearm points outwards; positive leans outwards and down), then roll, bend and roll of
/// the wrist. Program: X Y Z of the flange, mm, and its orientation A B C, rad: R = Rz(c) Ry(b) Rx(a); with
/// all joints at 0 the flange points outwards along X, its own Z. The wrist's centre is p - flange R ez;
/// base, shoulder and elbow are those of an arm of two links in the plane of the base's angle, the wrist's
/// angles those of what is left of R. Singular, and slow there: the wrist's centre above the base's axis
/// (shoulder), the arm stretched or folded (elbow), the bend at 0, where both rolls have one axis (wrist);
/// for the coordinates A B C themselves B at 90 degrees. Source: Siciliano et al., Robotics, 2009,
/// sections 2.12.2 to 2.12.5 (wrist), 2.4.2 (roll, pitch, yaw).
template <std::floating_point S>
struct BasicWristArm {
  using Scalar = S;
  static constexpr int axis_count = 6;
  static constexpr std::string_view coordinates = "XYZABC";

  S height = S(400);    ///< mm: of the shoulder above the base
  S outward = S(25);    ///< mm: of the shoulder from the base's axis
  S upper = S(560);     ///< mm: shoulder to elbow
  S rise = S(35);       ///< mm: of the forearm's line above the elbow
  S fore = S(515);      ///< mm: elbow to the wrist's centre, along the forearm
  S flange = S(80);     ///< mm: the wrist's centre to the flange
  bool elbow_down{};    ///< the elbow hangs below the way from the shoulder to the wrist
  bool wrist_turned{};  ///< the bend is negative, and both rolls are turned by half a turn

  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 6> joints(const std::array<T, 6>& p) const {
    using std::atan2, std::cos, std::hypot, std::sin, std::sqrt;
    const auto to = [&](const std::array<T, 3>& own) {
      return about_z(p[5], about_y(p[4], about_x(p[3], own)));
    };
    const std::array<T, 3> x = to({T(1), T(0), T(0)}), y = to({T(0), T(1), T(0)}), z = to({T(0), T(0), T(1)});
    const T wx = p[0] - T(flange) * z[0], wy = p[1] - T(flange) * z[1], wz = p[2] - T(flange) * z[2];
    const T base = atan2(wy, wx);
    const T out = hypot(wx, wy) - T(outward), up = wz - T(height);
    // Shoulder and elbow: the angle at the elbow by the law of cosines.
    const S forearm = std::hypot(fore, rise), bent = std::atan2(rise, fore);
    const T cosine =
        (square(out) + square(up) - T(upper * upper + forearm * forearm)) / T(S(2) * upper * forearm);
    const T size = sqrt(T(1) - square(cosine));
    const T sine = elbow_down ? size : -size;
    const T folded = atan2(sine, cosine);  // of the forearm's line from the upper arm's, upwards
    const T raised = atan2(up, out) - atan2(T(forearm) * sine, T(upper) + T(forearm) * cosine);
    const T quarter(std::numbers::pi_v<S> / S(2));
    const T shoulder = quarter - raised, elbow = T(bent) - folded - quarter;
    // The flange's axes, seen from the forearm: u along it, v to its left, w above it.
    const T lean = shoulder + elbow;
    const auto seen = [&](const std::array<T, 3>& d) { return about_y(-lean, about_z(-base, d)); };
    const auto u = seen(x), v = seen(y), w = seen(z);
    const T across = hypot(w[1], w[2]);
    const S side = wrist_turned ? S(-1) : S(1);
    return {base,
            shoulder,
            elbow,
            atan2(T(side) * w[1], -T(side) * w[2]),
            atan2(T(side) * across, w[0]),
            atan2(T(side) * v[0], -T(side) * u[0])};
  }
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 6> point(const std::array<T, 6>& q) const {
    using std::atan2, std::cos, std::hypot, std::sin;
    // From the flange's frame, through the wrist and the forearm, to the base.
    const auto to = [&](const std::array<T, 3>& own) {
      const std::array<T, 3> at_zero = about_z(q[5], own);                // about the flange's own Z
      const std::array<T, 3> ahead{at_zero[2], at_zero[1], -at_zero[0]};  // which points outwards
      return about_z(q[0], about_y(q[1] + q[2], about_x(q[3], about_y(q[4], ahead))));
    };
    const std::array<T, 3> x = to({T(1), T(0), T(0)}), y = to({T(0), T(1), T(0)}), z = to({T(0), T(0), T(1)});
    const T lean = q[1] + q[2];
    const T out = T(outward) + T(upper) * sin(q[1]) + T(fore) * cos(lean) + T(rise) * sin(lean);
    const T up = T(height) + T(upper) * cos(q[1]) - T(fore) * sin(lean) + T(rise) * cos(lean);
    return {out * cos(q[0]) + T(flange) * z[0],
            out * sin(q[0]) + T(flange) * z[1],
            up + T(flange) * z[2],
            atan2(y[2], z[2]),
            atan2(-x[2], hypot(x[0], x[1])),
            atan2(x[1], x[0])};
  }
};

using WristArm = BasicWristArm<double>;

}  // namespace cncplan::kinematics
