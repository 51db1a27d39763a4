// From rest to rest, the most frequent move, without a search.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include "cncplan/core/axis_limits.hpp"
#include "cncplan/core/axis_state.hpp"
#include "cncplan/core/detail/cube_root.hpp"
#include "cncplan/state/motion.hpp"

namespace cncplan::state {

/// Whether `rest_to_rest` has the motion: both ends at rest and apart, one acceleration limit for both
/// directions, and a limit of the jerk.
template <std::floating_point S>
[[nodiscard]] constexpr bool at_rest(const BasicAxisState<S>& from, const BasicAxisState<S>& to,
                                     const BasicAxisLimits<S>& limits) {
  return from.velocity == S(0) && from.acceleration == S(0) && to.velocity == S(0) &&
         to.acceleration == S(0) && from.position != to.position &&
         limits.acceleration_up == limits.acceleration_down && limits.jerk < BasicAxisLimits<S>::infinity;
}

/// Makes the fastest motion where `at_rest`. All is symmetric: the same ramp up and down. Over a distance L
/// its jerk takes cbrt(L/(2 J)) where nothing else binds; the velocity v to which it leads covers
/// v (v/A + A/J) where A binds. Where a limit does not bind, what it would add is negative.
template <std::floating_point S>
void make_rest_to_rest(const BasicAxisState<S>& from, const BasicAxisState<S>& to,
                       const BasicAxisLimits<S>& limits, BasicMotion<S>& motion) {
  using Phase = BasicJerkPhase<S>;
  const S way = to.position - from.position;
  const S length = std::abs(way);
  const S per_jerk = S(1) / limits.jerk;
  const S per_most = S(1) / limits.acceleration_up;
  const S up = limits.velocity_up, down = limits.velocity_down;
  const S top = way > S(0) ? up : down;
  const S rise = limits.acceleration_up * per_jerk;
  const S time = std::min(std::min(rise, std::sqrt(top * per_jerk)), cube_root(length * per_jerk / S(2)));
  const S held = S(2) * length / (rise + std::sqrt(rise * rise + S(4) * length * per_most));
  const S hold = std::min(held, top) * per_most - rise;
  const S cruise = length / top - std::max(hold, S(0)) - S(2) * time;
  const S jerk = std::copysign(limits.jerk, way);
  const S steep = time * jerk;
  motion.reset(from, to);
  motion.append(Phase{time, S(0), jerk}, Phase{hold, steep, S(0)}, Phase{time, steep, -jerk},
                Phase{cruise, S(0), S(0)}, Phase{time, S(0), -jerk}, Phase{hold, -steep, S(0)},
                Phase{time, -steep, jerk});
}

}  // namespace cncplan::state
