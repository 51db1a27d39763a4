// A hold of an executor beside the least time that a search finds for it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "cncplan/core/path_point.hpp"
#include "cncplan/move_to.hpp"
#include "cncplan/trajectory.hpp"
#include "optimum/least_hold.hpp"

namespace cncplan::test {

/// The trajectory is to outlive it. Its time is one at which the trajectory moves.
template <class T>
class WayToRest {
 public:
  WayToRest(const T& trajectory, double time) : trajectory_(trajectory) {
    const auto phases = trajectory.phases();
    std::size_t i = trajectory.phase_at(time);
    State now = phases[i].phase.at(time - phases[i].phase.time);
    velocity_ = now.velocity;
    acceleration_ = now.acceleration;
    for (;;) {
      const State end = phases[i].phase.at(phases[i].phase.duration);
      if (parts_.empty() || parts_.back().piece != phases[i].piece)
        parts_.push_back({phases[i].piece, now.position, length_});
      length_ += end.position - now.position;
      const bool rests = i + 1 == phases.size() || !(phases[i + 1].phase.velocity > 1e-9);
      if (rests) break;
      now = phases[++i].phase.at(0);
    }
  }

  [[nodiscard]] double velocity() const { return velocity_; }
  [[nodiscard]] double acceleration() const { return acceleration_; }
  [[nodiscard]] double length() const { return length_; }
  [[nodiscard]] PathPoint<Vector3> point_at(double s) const {
    const auto behind = std::upper_bound(parts_.begin() + 1, parts_.end(), s,
                                         [](double at, const Part& part) { return at < part.start; });
    const Part& part = *(behind - 1);
    return trajectory_.path(part.piece).point_at(part.from + s - part.start);
  }

 private:
  struct Part {
    std::size_t piece;
    double from, start;  // mm of the piece, of the way
  };

  const T& trajectory_;
  std::vector<Part> parts_;
  double velocity_{}, acceleration_{}, length_ = 0;
};

/// A hold, and the least time that a search finds from the same state.
struct HoldBeside {
  double time{}, least{};  // s; 0: the search finds nothing within a thousandth of the limits
};

/// Holds an executor that drives a trajectory at the planned speed, by ticks of `period` s. The search begins
/// with the executor's own way to rest too, as it may end where it begins.
template <class E, class T>
[[nodiscard]] HoldBeside hold_beside(E& executor, const T& trajectory, const Limits& limits, double period,
                                     int steps) {
  const WayToRest way(trajectory, executor.clock().position);
  HoldBeside result;
  std::vector<double> accelerations{way.acceleration()};
  executor.feed_hold();
  while (!executor.rests() && result.time < 100) {
    accelerations.push_back(executor.tick(period).along.acceleration);
    result.time += period;
  }
  const Axis axis{.velocity = limits.velocity, .acceleration = limits.acceleration, .jerk = limits.jerk};
  const auto straight =
      reach_velocity(BasicAxisState<double>{0, way.velocity(), way.acceleration()}, 0.0, axis);
  if (!straight) return result;
  const LeastHold search(way, way.length(), way.velocity(), way.acceleration(), limits, steps);
  for (const auto& found :
       {search.search(result.time, accelerations), search.search(1.2 * straight->duration()),
        search.search(2 * straight->duration())})
    if (found.beyond < 1e-3 && (result.least == 0 || found.time < result.least)) result.least = found.time;
  return result;
}

}  // namespace cncplan::test
