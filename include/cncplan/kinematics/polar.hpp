// Cartesian programs on a rotary table: KK22's use of the tire-mold machine, its tilt axis at rest.
#pragma once

#include <array>
#include <cmath>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/jet.hpp"
#include "cncplan/kinematics/detail/azimuth.hpp"

namespace cncplan::kinematics {

/// Joints R (radial slide, mm), Z (mm) and C (rotary table, rad) of programmed points X, Y, Z under an
/// upright tool (KK22 section 4, where R is called Y), with C smooth round an azimuth: R and C are those of
/// the way from the table's axis at `center`. Singular there, where C turns without bound.
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
