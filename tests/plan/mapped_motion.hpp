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

/// The most of each limit that third, second and first differences of joints show, as a share, joints and
/// tool; what rounding of positions may add is taken off: a position is known to half a unit in its last
/// place, times 8 in a third difference, and a transformation's sines and sums make of it a few units more;
/// so do the last places of the time at a speed.
template <class M, class Forward>
class UsedUnderMap {
 public:
  static constexpr int n = M::axis_count;

  UsedUnderMap(const M& machine, const Forward& tip, double period)
      : machine_(machine), tip_(tip), period_(period) {
    p_.fill(V::Zero());
  }
  void add(const VectorN<double, n>& joints, double time) {
    V all;
    all << joints, tip_(joints);
    p_ = {all, p_[0], p_[1], p_[2]};
    if (++known_ < 4) return;
    const double t = period_;
    const V v = (p_[0] - p_[1]) / t, a = (p_[0] - 2 * p_[1] + p_[2]) / (t * t),
            j = (p_[0] - 3 * p_[1] + 3 * p_[2] - p_[3]) / (t * t * t);
    const V unit = (all.cwiseAbs() + v.cwiseAbs() * time) * std::numeric_limits<double>::epsilon();
    include(
        most_.velocity, v, 2, unit, [](const Axis& x) { return x.velocity; }, machine_.limits.velocity);
    include(
        most_.acceleration, a, 4, unit, [](const Axis& x) { return x.acceleration; },
        machine_.limits.acceleration);
    include(
        most_.jerk, j, 8, unit, [](const Axis& x) { return x.jerk; }, machine_.limits.jerk);
  }
  [[nodiscard]] const Used& most() const { return most_; }

 private:
  using V = VectorN<double, n + 3>;
  static constexpr double units = 8;

  template <class Limit>
  void include(double& share, const V& value, double power, const V& unit, Limit limit, double of_tool) {
    const V rounding = units * power * unit / std::pow(period_, std::log2(power));
    for (int i = 0; i < n; ++i)
      share = std::max(
          share, (std::abs(value[i]) - rounding[i]) / limit(machine_.axes[static_cast<std::size_t>(i)]));
    share = std::max(share, (value.template tail<3>().norm() - rounding.template tail<3>().norm()) / of_tool);
  }

  const M& machine_;
  const Forward& tip_;
  double period_;
  std::array<V, 4> p_;
  int known_ = 0;
  Used most_;
};

/// That of a trajectory.
template <class T, class M, class Forward>
Used used_under_map(const T& trajectory, const M& machine, const Forward& tip, double period = 2e-4) {
  UsedUnderMap<M, Forward> used(machine, tip, period);
  for (const auto& point : trajectory.samples(period)) {
    if (!(point.time < trajectory.duration())) break;
    used.add(point.position, point.time);
  }
  return used.most();
}

/// The tip at every so many seconds.
template <class T, class Forward>
Polyline tip_line(const T& trajectory, const Forward& tip, double period) {
  Polyline result;
  for (const auto& point : trajectory.samples(period)) result.push_back(tip(point.position));
  return result;
}

}  // namespace cncplan::test
