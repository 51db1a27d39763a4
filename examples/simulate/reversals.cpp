// Slows a plan where an axis with backlash turns round: the steps that make up for it need their time.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "run.hpp"
#include "support/axis_motion.hpp"

namespace simulate {

using namespace cncplan;

namespace {

// The next place at which an axis of a path turns round, or the path's end.
template <class P>
double next_turning(const P& path, int axis, double u) {
  if constexpr (step::SteppablePath<P>)
    return path.next_turning(axis, u);
  else
    return step::TracedPath<P>(path, 2).next_turning(axis, u);
}

// Which way an axis goes between two parameters: +1, -1, or 0 where it stands still but for rounding.
template <class P>
int sense(const P& path, int axis, double from, double to) {
  constexpr double rounding = 1e-9;  // mm or rad
  const double travel = path.position(to)[axis] - path.position(from)[axis];
  return travel > rounding ? 1 : travel < -rounding ? -1 : 0;
}

template <class P>
void slow_reversals(const Route<P>& route, int axis, const plan::ReversalRule& rule,
                    std::vector<plan::BlockCaps>& caps) {
  int went = 0;
  for (std::size_t i = 0; i < route.size(); ++i) {
    const P& path = route[i].path;
    plan::BlockCaps& block = caps[i];
    if (!(path.length() > 0.0)) continue;
    const auto speed_at = [&](double s, bool inside) {
      const auto rates = support::axis_rates(path, s);
      return plan::reversal_speed(inside ? 0.0 : rates.first[axis], rates.second[axis],
                                  block.limits.acceleration, rule);
    };
    const double end = path.parameter_end();
    double from = 0.0, to = next_turning(path, axis, from);
    if (went * sense(path, axis, from, to) < 0) {
      block.entry = std::min(block.entry, speed_at(0.0, false));
      const double t = rule.time;
      const double from_rest =
          std::min(block.limits.acceleration * t * t / 2.0, block.limits.jerk * t * t * t / 6.0);
      if (i > 0 && block.entry == 0.0 && from_rest > rule.distance)
        caps[i - 1].pause = std::max(caps[i - 1].pause, rule.time);
    }
    for (; to < end && to > from; from = std::exchange(to, next_turning(path, axis, to)))
      block.limits.velocity = std::min(block.limits.velocity, speed_at(path.length_at(to), true));
    if (const int goes = sense(path, axis, from, end); goes != 0) went = goes;
  }
}

}  // namespace

template <class P>
void slow_reversals(const Route<P>& route, const Machine& machine, std::vector<plan::BlockCaps>& caps) {
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const MachineAxis& axis = machine.axes[i];
    const double time = step::backlash_time(axis.drive);
    const double distance = step::hysteresis(axis.drive) / axis.drive.steps_per_unit * axis.unit();
    if (time > 0.0) slow_reversals(route, static_cast<int>(i), {time, distance}, caps);
  }
}

template void slow_reversals(const Route<MillPath>&, const Machine&, std::vector<plan::BlockCaps>&);
template void slow_reversals(const Route<PolarPath>&, const Machine&, std::vector<plan::BlockCaps>&);
template void slow_reversals(const Route<RowPath>&, const Machine&, std::vector<plan::BlockCaps>&);

}  // namespace simulate
