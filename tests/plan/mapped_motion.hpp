// What motion under a map does to joints and tool, by differences of sampled joints, and where the tool goes,
// by a forward transformation of the test's own.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "cncplan/machine.hpp"
#include "plan/smoothed_motion.hpp"

namespace cncplan::test {

/// The most of each limit that third, second and first differences show, as a share, joints and tool; what
/// rounding of positions may add is taken off: a position is known to half a unit in its last place, times 8
/// in a third difference, and a transformation's sines and sums make of it a few units more; so do the last
/// places of the time at a speed.
template <class T, class M, class Forward>
Used used_under_map(const T& trajectory, const M& machine, const Forward& tip, double period = 2e-4) {
  constexpr int n = M::axis_count;
  using V = VectorN<double, n + 3>;
  constexpr double units = 8;
  Used most;
  std::array<V, 4> p;
  p.fill(V::Zero());
  int known = 0;
  for (const auto& point : trajectory.samples(period)) {
    if (!(point.time < trajectory.duration())) break;
    V all;
    all << point.position, tip(point.position);
    p = {all, p[0], p[1], p[2]};
    if (++known < 4) continue;
    const V v = (p[0] - p[1]) / period, a = (p[0] - 2 * p[1] + p[2]) / (period * period),
            j = (p[0] - 3 * p[1] + 3 * p[2] - p[3]) / (period * period * period);
    const V unit = (all.cwiseAbs() + v.cwiseAbs() * point.time) * std::numeric_limits<double>::epsilon();
    const auto include = [&](double& share, const V& value, double power, auto limit, double of_tool) {
      const V rounding = units * power * unit / std::pow(period, std::log2(power));
      for (int i = 0; i < n; ++i)
        share = std::max(
            share, (std::abs(value[i]) - rounding[i]) / limit(machine.axes[static_cast<std::size_t>(i)]));
      share =
          std::max(share, (value.template tail<3>().norm() - rounding.template tail<3>().norm()) / of_tool);
    };
    include(
        most.velocity, v, 2, [](const Axis& x) { return x.velocity; }, machine.limits.velocity);
    include(
        most.acceleration, a, 4, [](const Axis& x) { return x.acceleration; }, machine.limits.acceleration);
    include(
        most.jerk, j, 8, [](const Axis& x) { return x.jerk; }, machine.limits.jerk);
  }
  return most;
}

/// The tip at every so many seconds.
template <class T, class Forward>
Polyline tip_line(const T& trajectory, const Forward& tip, double period) {
  Polyline result;
  for (const auto& point : trajectory.samples(period)) result.push_back(tip(point.position));
  return result;
}

}  // namespace cncplan::test
