// A motion along the path ahead, part by part: as far as jerk and block stay the same.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <utility>

#include "cncplan/plan/player/path_ahead.hpp"
#include "cncplan/plan/player/played.hpp"
#include "cncplan/plan/player/running_profile.hpp"

namespace cncplan::plan {

/// Where a profile is. `start` is where it began, seen from the block that the machine was in, and goes along
/// with the block: it then lies before it.
template <std::floating_point S>
[[nodiscard]] BasicPlace<S> locate(const BasicPathAhead<S>& path, BasicPlace<S>& start,
                                   const BasicRunningProfile<S>& running) {
  const S position = running.state().position;
  const BasicPlace<S> at = path.advance(start, position, running.length() - position);
  if (at.block != start.block) start = {at.block, at.along - position};
  return at;
}

/// Goes on in a profile for so many seconds, `passed` seconds into the tick, and tells the parts.
template <std::floating_point S, class Visit>
void drive(const BasicPathAhead<S>& path, BasicPlace<S>& start, BasicRunningProfile<S>& running, S seconds,
           S passed, Visit& visit) {
  const BlockRing<S>& ring = path.ring;
  while (seconds > S(0)) {
    const BasicState<S> now = running.state();
    const BasicPlace<S> at = path.snapped(locate(path, start, running));
    const S edge = running.to_edge();
    BasicPlayedPart<S> part{{passed, edge > S(0) ? std::min(seconds, edge) : seconds, S(0), now.velocity,
                             now.acceleration, now.jerk},
                            at.block,
                            at.along,
                            path.direction};
    if (ring.holds(at.block + path.direction) && ring.holds(at.block)) {
      const S until = part.phase.tau_at(ring.length(at.block) - at.along);
      if (until > S(0)) part.phase.duration = std::min(part.phase.duration, until);
    }
    if (ring.holds(at.block)) {
      if (path.direction < 0) part.along = ring.length(at.block) - at.along;
      visit(std::as_const(part));
    }
    running.advance(part.phase.duration);
    passed += part.phase.duration;
    seconds -= part.phase.duration;
  }
}

}  // namespace cncplan::plan
