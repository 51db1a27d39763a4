// From rest to rest, the most frequent move, without a search.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include "cncplan/core/axis_limits.hpp"
#include "cncplan/core/axis_state.hpp"
#include "cncplan/core/cube_root.hpp"
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

/// The fastest motion where `at_rest`. All is symmetric: the same ramp up and down, to a velocity v, over a
/// distance 2 p^3/J^2 with the peak p = sqrt(J v), or v (v/A + A/J) where A binds.
template <std::floating_point S>
[[nodiscard]] BasicMotion<S> rest_to_rest(const BasicAxisState<S>& from, const BasicAxisState<S>& to,
                                          const BasicAxisLimits<S>& limits) {
  const S way = to.position - from.position;
  const S length = std::abs(way);
  const S jerk = std::copysign(limits.jerk, way);
  const S per_jerk = S(1) / limits.jerk;
  const S top = way > S(0) ? limits.velocity_up : limits.velocity_down;
  const S most = limits.acceleration_up;
  S peak = cube_root(length / S(2)) * cube_root(limits.jerk * limits.jerk);
  S hold{}, cruise{};
  if (peak > most || peak * peak * per_jerk > top) {
    const S rise = most * per_jerk;
    S velocity = top;
    peak = std::sqrt(limits.jerk * top);
    if (peak > most) {
      peak = most;
      velocity = std::min(S(2) * length / (rise + std::sqrt(rise * rise + S(4) * length / most)), top);
      hold = std::max(velocity / most - rise, S(0));
    }
    cruise = std::max(length / velocity - hold - S(2) * peak * per_jerk, S(0));
  }
  const S steep = std::copysign(peak, way);
  const S time = peak * per_jerk;
  BasicMotion<S> m(from, to);
  m.append({time, S(0), jerk});
  m.append({hold, steep, S(0)});
  m.append({time, steep, -jerk});
  m.append({cruise, S(0), S(0)});
  m.append({time, S(0), -jerk});
  m.append({hold, -steep, S(0)});
  m.append({time, -steep, jerk});
  return m;
}

}  // namespace cncplan::state
