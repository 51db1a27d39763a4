// The plain mill: its joints are the coordinates.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/jet.hpp"

namespace cncplan::kinematics {

/// Nothing, or `unreachable` for a tool that is not upright, to rounding; the value is its angle from there,
/// rad.
template <std::floating_point S>
[[nodiscard]] Expected<void> upright(const BasicPose<S>& pose) {
  const S sine = pose.direction.template head<2>().norm();
  const S cosine = pose.direction.z();
  constexpr S rounding = S(16) * std::numeric_limits<S>::epsilon();
  if (sine <= rounding && cosine > S(0)) return {};
  return tl::unexpected(Error{ErrorCode::unreachable, "tool direction",
                              static_cast<double>(std::atan2(sine, cosine)), static_cast<double>(rounding)});
}

/// Three linear axes X, Y, Z and an upright tool.
template <std::floating_point S>
struct BasicCartesian {
  using Scalar = S;
  using Joints = VectorN<S, 3>;

  BasicJointLimits<S, 3> limits{};

  [[nodiscard]] BasicPose<S> forward(const Joints& joints) const {
    return {joints, BasicVector3<S>::UnitZ()};
  }

  /// Errors: those of `upright`, and a joint beyond its travel.
  [[nodiscard]] Expected<Joints> inverse(const BasicPose<S>& pose) const {
    if (auto ok = upright(pose); !ok) return tl::unexpected(ok.error());
    return within_travel(pose.position, limits, {"X", "Y", "Z"});
  }

  [[nodiscard]] Eigen::Matrix<S, 6, 3> jacobian(const Joints&) const {
    return Eigen::Matrix<S, 6, 3>::Identity();
  }

  [[nodiscard]] BasicJointLimits<S, 3> joint_limits() const { return limits; }
};

using Cartesian = BasicCartesian<double>;

/// Joints that are the programmed coordinates, for motion that is limited axis by axis.
template <std::floating_point S>
struct BasicCartesianMap {
  using Scalar = S;
  static constexpr int axis_count = 3;

  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> joints(const std::array<T, 3>& point) const {
    return point;
  }
};

using CartesianMap = BasicCartesianMap<double>;

}  // namespace cncplan::kinematics
