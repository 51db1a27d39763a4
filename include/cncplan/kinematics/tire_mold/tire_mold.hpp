// The 4-axis tire-mold machine: radial slide, vertical slide, tilting spindle, rotary table
// (docs/tire-mold.md).
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/jet.hpp"
#include "cncplan/core/joint_limits.hpp"
#include "cncplan/core/pose.hpp"
#include "cncplan/kinematics/detail/azimuth.hpp"

namespace cncplan::kinematics {

/// Joints R and Z (mm), A and C (rad); seen in the radial plane of the table angle C:
///
///        height                 holder (R, Z)
///          |                     /
///          |                    /  tool_length, tilted by A
///          |                   /
///          |                 tip
///          +------------------------------- radius
///
/// The tip lies at radius R + tool_length sin A and height Z - tool_length cos A, `side_offset` beside the
/// radial plane; the tool's axis is (-sin A, cos A) in that plane. These are the fourth and the second column
/// of K17 Eq. 3.6 with theta1 = C, theta4 = A, d2 = R, h2 = side_offset, h3 = tool_length and h1 - d3 = Z,
/// the height that the machine shows.
template <std::floating_point S>
struct BasicTireMold {
  using Scalar = S;
  using Joints = VectorN<S, 4>;

  S tool_length{};           ///< mm
  S side_offset{};           ///< mm
  S smallest_radius = S(1);  ///< mm, > 0; no tip nearer to the table's axis is reached
  BasicJointLimits<S, 4> limits{};

  /// The tip's place, of joints that are numbers or jets.
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> tip(const std::array<T, 4>& joints) const {
    using std::cos, std::sin;
    const auto& [r, z, a, c] = joints;
    const T radial = r + T(tool_length) * sin(a);
    const T sc = sin(c), cc = cos(c);
    return {radial * cc + T(side_offset) * sc, radial * sc - T(side_offset) * cc,
            z - T(tool_length) * cos(a)};
  }

  [[nodiscard]] BasicPose<S> forward(const Joints& joints) const {
    const S sa = std::sin(joints[2]), ca = std::cos(joints[2]);
    const auto [x, y, z] = tip(std::array{joints[0], joints[1], joints[2], joints[3]});
    return {{x, y, z}, {-sa * std::cos(joints[3]), -sa * std::sin(joints[3]), ca}};
  }

  /// C comes in (-pi, pi], or as few whole turns from there as its travel asks for; the tip is on the slide's
  /// side of the axis. Errors: `below_limit` for a tip nearer to the axis than the smallest radius,
  /// `unreachable` for a direction outside the radial plane (the value is how far), and a joint beyond its
  /// travel.
  [[nodiscard]] Expected<Joints> inverse(const BasicPose<S>& pose) const {
    const BasicVector3<S>& p = pose.position;
    const BasicVector3<S>& n = pose.direction;
    const S distance = std::hypot(p.x(), p.y());
    const S radial_sq = (distance - side_offset) * (distance + side_offset);
    const S radial = radial_sq > S(0) ? std::sqrt(radial_sq) : S(0);
    if (!(radial >= smallest_radius))
      return refusal(ErrorCode::below_limit, "radius", radial, smallest_radius);
    // (x, y) is (radial, -side_offset) turned by C
    const S c = std::atan2(p.y() * radial + p.x() * side_offset, p.x() * radial - p.y() * side_offset);
    const S sc = std::sin(c), cc = std::cos(c);
    const S across = n.y() * cc - n.x() * sc;
    const S rounding = std::sqrt(std::numeric_limits<S>::epsilon());
    if (!(std::abs(across) <= rounding)) return refusal(ErrorCode::unreachable, "tool direction", across);
    const S a = std::atan2(-(n.x() * cc + n.y() * sc), n.z());
    const Joints joints(radial - tool_length * std::sin(a), p.z() + tool_length * std::cos(a), a,
                        c + turns_into(c, c, limits.low[3], limits.high[3]));
    return within_travel(joints, limits, {"R", "Z", "A", "C and whole turns from it"});
  }

  [[nodiscard]] Eigen::Matrix<S, 6, 4> jacobian(const Joints& joints) const {
    const S sa = std::sin(joints[2]), ca = std::cos(joints[2]);
    const S sc = std::sin(joints[3]), cc = std::cos(joints[3]);
    const S radial = joints[0] + tool_length * sa;
    const S zero(0), one(1);
    Eigen::Matrix<S, 6, 4> result;
    result << cc, zero, tool_length * ca * cc, side_offset * cc - radial * sc,  //
        sc, zero, tool_length * ca * sc, side_offset * sc + radial * cc,        //
        zero, one, tool_length * sa, zero,                                      //
        zero, zero, -ca * cc, sa * sc,                                          //
        zero, zero, -ca * sc, -sa * cc,                                         //
        zero, zero, -sa, zero;
    return result;
  }
};

using TireMold = BasicTireMold<double>;

/// Joints R and Z (mm), A and C of degrees, as programs and K17 write them, as joints of the machine (rad).
template <std::floating_point S>
[[nodiscard]] VectorN<S, 4> tire_mold_joints(const VectorN<S, 4>& in_degrees) {
  constexpr S degree = std::numbers::pi_v<S> / S(180);
  return {in_degrees[0], in_degrees[1], in_degrees[2] * degree, in_degrees[3] * degree};
}
/// The other way: A and C of rad in degrees.
template <std::floating_point S>
[[nodiscard]] VectorN<S, 4> tire_mold_degrees(const VectorN<S, 4>& joints) {
  constexpr S degree = std::numbers::pi_v<S> / S(180);
  return {joints[0], joints[1], joints[2] / degree, joints[3] / degree};
}

/// K17 Table 3.1: R 0 to 900 mm, Z 0 to 600 mm, A -90 to 90 degrees, C 0 to 360 degrees; no rates.
template <std::floating_point S>
[[nodiscard]] BasicJointLimits<S, 4> thesis_travel() {
  BasicJointLimits<S, 4> limits;
  limits.low = tire_mold_joints<S>({0, 0, -90, 0});
  limits.high = tire_mold_joints<S>({900, 600, 90, 360});
  return limits;
}

}  // namespace cncplan::kinematics
