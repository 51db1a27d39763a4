// From any state of motion to rest, over the blocks that lie ahead.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "cncplan/detail/executor/brake.hpp"
#include "cncplan/detail/executor/path_ahead.hpp"
#include "cncplan/detail/executor/running_profile.hpp"
#include "cncplan/profile/from_state.hpp"

namespace cncplan::detail {

/// mm/s: rest but for rounding. A brake that ends faster goes on under the limits behind.
template <std::floating_point S>
inline constexpr S negligible_speed = std::max(S(2e-11), S(1e3) * std::numeric_limits<S>::epsilon());

/// By how much rounding may exceed the cap of a junction.
template <std::floating_point S>
inline constexpr S junction_tolerance = S(1) + path_rounding<S>;

/// The highest speed that braking at once leaves ahead of a state at a place.
template <std::floating_point S>
[[nodiscard]] S fastest_ahead(const BasicPathAhead<S>& path, const BasicPlace<S>& at,
                              const BasicState<S>& now) {
  const profile::BasicStartState<S> state{now.velocity, now.acceleration};
  return std::max(now.velocity, profile::settled_speed(state, path.braking_limits(at.block)));
}

/// The motion towards rest from a place, under the limits of each block, up to where they change. Nothing
/// where no brake from this state keeps them. `zones` is room to work in.
template <std::floating_point S>
[[nodiscard]] std::optional<BasicRunningProfile<S>> brake_profile(const BasicPathAhead<S>& path,
                                                                  const BasicPlace<S>& at,
                                                                  const BasicState<S>& now,
                                                                  std::span<BasicSegmentLimits<S>> zones,
                                                                  bool going_on) {
  const profile::BasicStartState<S> state{now.velocity, now.acceleration};
  zones = zones.first(path.zones(at, fastest_ahead(path, at, now), zones));
  const auto ramp = profile::stop(state, zones[0].limits);
  // it may rest at the end of the zone
  if (ramp && (zones.size() == 1 || ramp->length() < zones[0].length + path_rounding<S>))
    return BasicRunningProfile<S>(*ramp);
  const BasicBrake<S> brake(zones);
  if (!going_on && !brake.safe(now)) return {};
  return brake.profile(now);
}

/// The next profile of a brake that has begun: there always is one.
template <std::floating_point S>
[[nodiscard]] BasicRunningProfile<S> braking_on(const BasicPathAhead<S>& path, const BasicPlace<S>& at,
                                                const BasicState<S>& now,
                                                std::span<BasicSegmentLimits<S>> zones) {
  return *brake_profile(path, at, now, zones, true);
}

/// Whether a profile passes no junction too fast; that at its end is left out.
template <std::floating_point S>
[[nodiscard]] bool keeps_junctions(const BasicPathAhead<S>& path, const BasicRunningProfile<S>& profile,
                                   const BasicPlace<S>& from, const BasicState<S>& start) {
  const S rising = start.acceleration > S(0) ? start.acceleration : S(0);
  const S fastest = start.velocity + rising * rising / (S(2) * path.braking_limits(from.block).jerk);
  S position = path.ring.length(from.block) - from.along;
  for (std::int64_t block = from.block; position < profile.length() - path_rounding<S>;) {
    if (!path.ring.holds(block + path.direction)) return true;
    block += path.direction;
    const S cap = path.junction_cap(block);
    if (cap < fastest && profile.velocity_at(position) > cap * junction_tolerance<S>) return false;
    position += path.ring.length(block);
  }
  return true;
}

/// The first profile of coming to rest from a place; `braking_on` gives the next ones. Nothing where no brake
/// from here keeps limits and junctions all the way.
template <std::floating_point S>
[[nodiscard]] std::optional<BasicRunningProfile<S>> brake_ahead(const BasicPathAhead<S>& path,
                                                                const BasicPlace<S>& at,
                                                                const BasicState<S>& now,
                                                                std::span<BasicSegmentLimits<S>> zones) {
  const auto first = brake_profile(path, at, now, zones, false);
  if (!first || !keeps_junctions(path, *first, at, now)) return {};
  BasicRunningProfile<S> profile = *first;
  BasicPlace<S> place = at;
  for (std::int64_t profiles = 0; profiles < path.ring.capacity(); ++profiles) {
    const S length = profile.length();
    profile.advance(profile.left());
    const BasicState<S> end = profile.state();
    place = path.advance(place, length);
    if (path.beyond_end(place)) return {};
    place = path.snapped(place);
    if (!(end.velocity > negligible_speed<S>)) return first;
    if (!path.ring.holds(place.block)) return {};
    if (place.along == S(0) && end.velocity > path.junction_cap(place.block) * junction_tolerance<S>)
      return {};
    profile = braking_on(path, place, end, zones);
    if (!keeps_junctions(path, profile, place, end)) return {};
  }
  return {};
}

}  // namespace cncplan::detail
