// A motion along the path ahead, part by part: as far as jerk and block stay the same.
#pragma once

#include <algorithm>
#include <concepts>
#include <utility>

#include "cncplan/detail/executor/motion_set_point.hpp"
#include "cncplan/detail/executor/path_ahead.hpp"
#include "cncplan/detail/executor/running_profile.hpp"

namespace cncplan::detail {

/// Where a profile is that has travelled to `position`. `start` is where it began, seen from the block that
/// the machine was in, and goes along with the block: it then lies before it.
template <std::floating_point S>
[[nodiscard]] BasicPlace<S> locate(const BasicPathAhead<S>& path, BasicPlace<S>& start,
                                   const BasicRunningProfile<S>& running, S position) {
  const BasicPlace<S> at = path.advance(start, position, running.length() - position);
  if (at.block != start.block) start = {at.block, at.along - position};
  return at;
}

/// What a motion executor says of a state at a place, which is in a block: in that block's own direction.
template <std::floating_point S>
[[nodiscard]] BasicMotionSetPoint<S> set_point_at(const BasicPathAhead<S>& path, const BasicPlace<S>& at,
                                                  const BasicState<S>& now, bool at_rest) {
  const S whole = path.ring.length(at.block);
  const S travelled = std::min(at.along, whole);
  const S sign = static_cast<S>(path.direction);
  return {at.block,
          sign > S(0) ? travelled : whole - travelled,
          sign * now.velocity,
          sign * now.acceleration,
          sign * now.jerk,
          at_rest};
}

/// Tells the parts of the next seconds of a profile, which begin `passed` seconds into the tick. What drives
/// the profile does not go on by parts: the motion is the same whether anybody asks for them.
template <std::floating_point S, class Visit>
void tell_parts(const BasicPathAhead<S>& path, BasicPlace<S> start, BasicRunningProfile<S> running, S seconds,
                S passed, Visit& visit) {
  const BlockRing<S>& ring = path.ring;
  // Rounding hides so short a rest of a block: no place along a long path lies in it, and the time to its end
  // is noise. With parts of their own for such blocks, a tick could have billions.
  constexpr S shortest = path_rounding<S> / S(16);
  const auto too_short = [&](const BasicPlace<S>& at) {
    return ring.holds(at.block) && ring.length(at.block) - at.along <= shortest;
  };
  while (seconds > S(0)) {
    const BasicState<S> now = running.state();
    BasicPlace<S> at = path.snapped(locate(path, start, running, now.position));
    while (ring.holds(at.block + path.direction) && too_short(at)) at = {at.block + path.direction, S(0)};
    const S edge = running.to_edge();
    BasicMotionPart<S> part{{passed, edge > S(0) ? std::min(seconds, edge) : seconds, S(0), now.velocity,
                             now.acceleration, now.jerk},
                            at.block,
                            at.along,
                            path.direction};
    if (ring.holds(at.block + path.direction) && ring.holds(at.block))
      if (const S until = part.phase.tau_at(ring.length(at.block) - at.along); until > S(0))
        part.phase.duration = std::min(part.phase.duration, until);
    if (ring.holds(at.block)) {
      if (path.direction < 0) part.along = ring.length(at.block) - at.along;
      visit(std::as_const(part));
    }
    running.advance(part.phase.duration);
    passed += part.phase.duration;
    seconds -= part.phase.duration;
  }
}

}  // namespace cncplan::detail
