// From any state of motion to a speed, over the blocks that lie ahead.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <optional>

#include "cncplan/detail/executor/path_ahead.hpp"
#include "cncplan/profile/from_state.hpp"

namespace cncplan::detail {

// The profile of a ramp alone.
template <std::floating_point S>
[[nodiscard]] profile::BasicProfile<S> ramp_profile(const profile::BasicStartState<S>& start, S target,
                                                    const BasicLimits<S>& limits) {
  const profile::BasicRamp<S> ramp = profile::ramp_from(start, target, limits);
  return profile::BasicProfile<S>({.length = profile::distance(start, ramp),
                                   .start_velocity = start.velocity,
                                   .start_acceleration = start.acceleration,
                                   .top_velocity = target,
                                   .end_velocity = target,
                                   .cruise = S(0),
                                   .up = ramp,
                                   .down = {}});
}

/// The ramp from the state at a place to a speed with zero acceleration, under the lowest limits of all
/// blocks that it touches. Nothing where a cap ahead forbids it, or the state is beyond these limits.
template <std::floating_point S>
[[nodiscard]] std::optional<profile::BasicProfile<S>> ramp_ahead(const BasicPathAhead<S>& path,
                                                                 const BasicPlace<S>& from,
                                                                 const BasicState<S>& now, S target) {
  const profile::BasicStartState<S> start{now.velocity, now.acceleration};
  BasicLimits<S> limits = path.limits(from.block);
  constexpr int rounds = 4;
  for (int round = 0; round < rounds; ++round) {
    const S most = std::min(limits.acceleration, path.entry_acceleration(from.block, now.velocity));
    if (std::abs(now.acceleration) > most * (S(1) + path_rounding<S>)) return {};
    const S settled = profile::settled_speed(start, limits);
    if (settled < -path_rounding<S>) return {};
    const profile::BasicProfile<S> ramp = ramp_profile(start, target, limits);
    const S whole = ramp.length();
    const bool crests = now.acceleration > S(0) && target < settled;  // goes above both speeds
    const BasicState<S> crest = crests ? ramp.at(now.acceleration / limits.jerk) : BasicState<S>{S(-1)};
    const S fastest = std::max({now.velocity, target, crest.velocity});
    constexpr S tolerance = S(1) + std::max(S(1e-12), S(64) * std::numeric_limits<S>::epsilon());
    BasicLimits<S> touched = limits;
    BasicPlace<S> at = from;
    S position = S(0);
    for (S until = path.ring.length(at.block) - at.along;; until += path.ring.length(at.block)) {
      const BasicLimits<S>& there = path.limits(at.block);
      touched.acceleration = std::min(touched.acceleration, there.acceleration);
      touched.jerk = std::min(touched.jerk, there.jerk);
      // at speed it must not end at a junction, which would go unseen
      const bool last = !(until < (target > S(0) ? whole + path_rounding<S> : whole));
      const S allowed = tolerance * std::max(there.velocity, at.block == from.block ? now.velocity : S(0));
      if (fastest > allowed) {
        const bool crest_here = crest.position >= position && crest.position <= until;
        const S highest = crest_here
                              ? crest.velocity
                              : std::max(ramp.velocity_at(position), last ? target : ramp.velocity_at(until));
        if (highest > allowed) return {};
      }
      if (last) break;
      // a rest ends a profile: where the speed is zero in mid-ramp, it would not be seen which block that is
      if (!path.ring.holds(at.block + path.direction) || path.stops_behind(at.block) ||
          path.rests_behind(at.block))
        return {};
      at.block += path.direction;
      const S cap = path.junction_cap(at.block) * tolerance;
      if (fastest > cap && ramp.velocity_at(until) > cap) return {};
      if (path.ring[at.block].segment_limits.ramps_inside) {
        const BasicState<S> entry = ramp.at(ramp.time_at(until));
        if (std::abs(entry.acceleration) > path.entry_acceleration(at.block, entry.velocity)) return {};
      }
      position = until;
    }
    if (touched == limits) return ramp;
    limits = touched;
  }
  return {};
}

}  // namespace cncplan::detail
