// Two motors that move two axes together by one belt.
#pragma once

#include <array>

#include "cncplan/core/jet.hpp"

namespace cncplan::kinematics {

/// CoreXY (and H-bot): the motors show x + y and x - y, mm; Z is its own. No singularities. Source: LinuxCNC,
/// corexykins.
template <std::floating_point S>
struct BasicCoreXY {
  using Scalar = S;
  static constexpr int axis_count = 3;

  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> joints(const std::array<T, 3>& p) const {
    return {p[0] + p[1], p[0] - p[1], p[2]};
  }
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> point(const std::array<T, 3>& q) const {
    return {(q[0] + q[1]) / T(2), (q[0] - q[1]) / T(2), q[2]};
  }
};

using CoreXY = BasicCoreXY<double>;

}  // namespace cncplan::kinematics
