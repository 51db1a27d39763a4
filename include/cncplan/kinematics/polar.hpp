// Cartesian programs on a rotary table: KK22's use of the tire-mold machine, its tilt axis at rest.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/jet.hpp"
#include "cncplan/kinematics/cartesian.hpp"
#include "cncplan/kinematics/detail/azimuth.hpp"

namespace cncplan::kinematics {

/// Joints R (radial slide, mm), Z (mm) and C (rotary table, rad), an upright tool (KK22 section 4, where R is
/// called Y): R = hypot(x, y), C = atan2(y, x). Singular on the table's axis, where C turns without bound.
template <std::floating_point S>
struct BasicPolar {
  using Scalar = S;
  using Joints = VectorN<S, 3>;

  BasicJointLimits<S, 3> limits{};
  S smallest_radius = S(1);  ///< mm, > 0; nothing nearer to the table's axis is reached

  [[nodiscard]] BasicPose<S> forward(const Joints& joints) const {
    const auto& [r, z, c] = parts(joints);
    return {{r * std::cos(c), r * std::sin(c), z}, BasicVector3<S>::UnitZ()};
  }

  /// C comes in (-pi, pi], or as few whole turns from there as its travel asks for. Errors: those of
  /// `upright`, `below_limit` for a radius below the smallest, and a joint beyond its travel.
  [[nodiscard]] Expected<Joints> inverse(const BasicPose<S>& pose) const {
    if (auto ok = upright(pose); !ok) return tl::unexpected(ok.error());
    const BasicVector3<S>& p = pose.position;
    const S radius = std::hypot(p.x(), p.y());
    if (!(radius >= smallest_radius))
      return tl::unexpected(Error{ErrorCode::below_limit, "radius", static_cast<double>(radius),
                                  static_cast<double>(smallest_radius)});
    const S c = std::atan2(p.y(), p.x());
    return within_travel(Joints(radius, p.z(), c + turns_into(c, c, limits.low[2], limits.high[2])), limits,
                         {"R", "Z", "C and whole turns from it"});
  }

  [[nodiscard]] Eigen::Matrix<S, 6, 3> jacobian(const Joints& joints) const {
    const auto& [r, z, c] = parts(joints);
    Eigen::Matrix<S, 6, 3> result = Eigen::Matrix<S, 6, 3>::Zero();
    result.template topRows<3>() << std::cos(c), S(0), -r * std::sin(c),  //
        std::sin(c), S(0), r * std::cos(c),                               //
        S(0), S(1), S(0);
    return result;
  }

  [[nodiscard]] BasicJointLimits<S, 3> joint_limits() const { return limits; }

 private:
  static std::array<S, 3> parts(const Joints& joints) { return {joints[0], joints[1], joints[2]}; }
};

using Polar = BasicPolar<double>;

/// Joints R, Z, C of programmed points X, Y, Z, with C smooth round an azimuth: R and C are those of the way
/// from the table's axis at `center`. Singular there.
template <std::floating_point S>
struct BasicPolarMap {
  using Scalar = S;
  static constexpr int axis_count = 3;

  BasicAzimuth<S> azimuth{};
  std::array<S, 2> center{};  ///< mm, X and Y

  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> joints(const std::array<T, 3>& point) const {
    using std::hypot;
    const T x = point[0] - T(center[0]), y = point[1] - T(center[1]);
    return {hypot(x, y), point[2], azimuth.of(x, y)};
  }
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> point(const std::array<T, 3>& q) const {
    using std::cos, std::sin;
    const auto& [r, z, c] = q;
    return {r * cos(c) + T(center[0]), r * sin(c) + T(center[1]), z};
  }
};

using PolarMap = BasicPolarMap<double>;

}  // namespace cncplan::kinematics
