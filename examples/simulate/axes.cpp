// What the exact path asks of the axes, inside blocks and at their junctions.
#include <algorithm>
#include <cmath>

#include "run.hpp"
#include "support/axis_motion.hpp"

namespace simulate {

using namespace cncplan;

template <class P>
void measure_axes(const Route<P>& route, const Plan& plan, const Machine& machine, Measures& measures) {
  const auto path = [&](std::size_t i) -> const P& { return route[i].path; };
  const auto peaks = support::axis_peaks<P>(plan, path);
  const auto axes = static_cast<Eigen::Index>(machine.axes.size());
  measures.axis_velocity.resize(axes);
  measures.axis_acceleration.resize(axes);
  measures.axis_jerk.resize(axes);
  for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) {
    const auto k = static_cast<Eigen::Index>(axis);
    measures.axis_velocity[k] = machine.shown(axis, peaks.velocity(axis));
    measures.axis_acceleration[k] = machine.shown(axis, peaks.acceleration(axis));
    measures.axis_jerk[k] = machine.shown(axis, peaks.jerk(axis));
  }
  for (std::size_t i = 1; i < route.size(); ++i) {
    const P& before = path(i - 1);
    const P& after = path(i);
    if (!(before.length() > 0.0 && after.length() > 0.0)) continue;
    const auto left = support::end_velocity(before, true, plan.timings[i - 1].exit.velocity);
    const auto entered = support::end_velocity(after, false, plan.timings[i].entry.velocity);
    for (std::size_t axis = 0; axis < machine.axes.size(); ++axis) {
      const auto k = static_cast<Eigen::Index>(axis);
      const double jump = std::abs(machine.shown(axis, entered[k] - left[k]));
      measures.corner_velocity_step = std::max(measures.corner_velocity_step, jump);
    }
  }
}

template void measure_axes(const Route<MillPath>&, const Plan&, const Machine&, Measures&);
template void measure_axes(const Route<PolarPath>&, const Plan&, const Machine&, Measures&);
template void measure_axes(const Route<RowPath>&, const Plan&, const Machine&, Measures&);

}  // namespace simulate
