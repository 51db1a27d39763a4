// Limits of a machine's motion: of each axis, and of the tool's vector.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>

#include "cncplan/core/limits.hpp"
#include "cncplan/core/vector.hpp"

namespace cncplan {

/// Largest magnitudes: of the vector of the axes X, Y and Z (`tool_axes`: which these are, -1 for one that is
/// not there), and of each axis. All of them hold at once. A limit that is not given is infinite.
template <std::floating_point S, int N>
struct BasicMotionLimits {
  BasicLimits<S> tool;
  std::array<int, 3> tool_axes = first_axes();
  std::array<BasicLimits<S>, static_cast<std::size_t>(N)> axes{};

  [[nodiscard]] static constexpr std::array<int, 3> first_axes() {
    return {0, N > 1 ? 1 : -1, N > 2 ? 2 : -1};
  }
};

template <int N>
using MotionLimits = BasicMotionLimits<double, N>;

/// The inner product of the tool's part of two vectors of axes.
struct ToolProduct {
  std::array<int, 3> axes;

  template <class V>
  [[nodiscard]] typename V::Scalar operator()(const V& a, const V& b) const {
    typename V::Scalar sum{};
    for (const int axis : axes)
      if (axis >= 0) sum += a[axis] * b[axis];
    return sum;
  }
};

/// The product of one axis' components.
struct AxisProduct {
  int axis;

  template <class V>
  [[nodiscard]] typename V::Scalar operator()(const V& a, const V& b) const {
    return a[axis] * b[axis];
  }
};

/// Calls `with(limits, product)` for the tool and for each axis that has a limit: the motion keeps a limit
/// where the product of the vector with itself is at most the limit's square.
template <std::floating_point S, int N, class F>
void for_each_limit(const BasicMotionLimits<S, N>& limits, F&& with) {
  with(limits.tool, ToolProduct{limits.tool_axes});
  for (int axis = 0; axis < N; ++axis) {
    const BasicLimits<S>& own = limits.axes[static_cast<std::size_t>(axis)];
    if (std::isfinite(own.velocity) || std::isfinite(own.acceleration) || std::isfinite(own.jerk))
      with(own, AxisProduct{axis});
  }
}

/// The same limits without what cannot be reached: the tool's vector is no longer than that of the limits of
/// its axes, where all of them have one. A limit beyond that would only be a wrong measure of what motion
/// does.
template <std::floating_point S, int N>
[[nodiscard]] BasicMotionLimits<S, N> reachable(BasicMotionLimits<S, N> limits) {
  const auto lower = [&](S BasicLimits<S>::*limit) {
    S square = S(0);
    for (const int axis : limits.tool_axes)
      if (axis >= 0) {
        const S own = limits.axes[static_cast<std::size_t>(axis)].*limit;
        square += own * own;
      }
    limits.tool.*limit = std::min(limits.tool.*limit, std::sqrt(square));
  };
  lower(&BasicLimits<S>::velocity);
  lower(&BasicLimits<S>::acceleration);
  lower(&BasicLimits<S>::jerk);
  return limits;
}

}  // namespace cncplan
