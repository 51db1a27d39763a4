// From any state of motion to rest, over the blocks that lie ahead.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "cncplan/plan/player/brake.hpp"
#include "cncplan/plan/player/leg.hpp"
#include "cncplan/plan/player/road.hpp"
#include "cncplan/profile/from_state.hpp"

namespace cncplan::plan {

/// mm/s: rest but for rounding.
template <std::floating_point S>
inline constexpr S negligible_speed = S(1e5) * std::numeric_limits<S>::epsilon();

/// By how much rounding may exceed the cap of a junction.
template <std::floating_point S>
inline constexpr S junction_tolerance = S(1) + road_rounding<S>;

/// The highest speed that braking at once leaves ahead of a state at a spot.
template <std::floating_point S>
[[nodiscard]] S fastest_ahead(const BasicRoad<S>& road, const BasicSpot<S>& at, const BasicState<S>& now) {
  const profile::BasicStartState<S> state{now.velocity, now.acceleration};
  return std::max(now.velocity, profile::settled_speed(state, road.limits(at.block)));
}

/// The motion towards rest from a spot, under the limits of each block, up to where they change. Nothing
/// where no brake from this state keeps them. `zones` is room to work in.
template <std::floating_point S>
[[nodiscard]] std::optional<BasicLeg<S>> brake_leg(const BasicRoad<S>& road, const BasicSpot<S>& at,
                                                   const BasicState<S>& now,
                                                   std::span<BasicBlockCaps<S>> zones, bool going_on) {
  const profile::BasicStartState<S> state{now.velocity, now.acceleration};
  zones = zones.first(road.zones(at, fastest_ahead(road, at, now), zones));
  const auto ramp = profile::stop(state, zones[0].limits);
  // it may rest at the end of the zone
  if (ramp && (zones.size() == 1 || ramp->length() < zones[0].length + road_rounding<S>))
    return BasicLeg<S>(*ramp);
  const BasicBrake<S> brake(zones);
  if (!going_on && !brake.safe(now)) return {};
  return brake.leg(now);
}

/// The next leg of a brake that has begun: there always is one.
template <std::floating_point S>
[[nodiscard]] BasicLeg<S> braking_on(const BasicRoad<S>& road, const BasicSpot<S>& at,
                                     const BasicState<S>& now, std::span<BasicBlockCaps<S>> zones) {
  return *brake_leg(road, at, now, zones, true);
}

/// Whether a leg passes no junction too fast; that at its end is left out.
template <std::floating_point S>
[[nodiscard]] bool keeps_junctions(const BasicRoad<S>& road, const BasicLeg<S>& leg, const BasicSpot<S>& from,
                                   const BasicState<S>& start) {
  const S rising = start.acceleration > S(0) ? start.acceleration : S(0);
  const S fastest = start.velocity + rising * rising / (S(2) * road.limits(from.block).jerk);
  S position = road.ring.length(from.block) - from.along;
  for (std::int64_t block = from.block; position < leg.length() - road_rounding<S>;) {
    if (!road.ring.holds(block + road.direction)) return true;
    block += road.direction;
    const S cap = road.junction_cap(block);
    if (cap < fastest && leg.velocity_at(position) > cap * junction_tolerance<S>) return false;
    position += road.ring.length(block);
  }
  return true;
}

/// The first leg of coming to rest from a spot; `braking_on` gives the next ones. Nothing where no brake from
/// here keeps limits and junctions all the way.
template <std::floating_point S>
[[nodiscard]] std::optional<BasicLeg<S>> brake_ahead(const BasicRoad<S>& road, const BasicSpot<S>& at,
                                                     const BasicState<S>& now,
                                                     std::span<BasicBlockCaps<S>> zones) {
  const auto first = brake_leg(road, at, now, zones, false);
  if (!first || !keeps_junctions(road, *first, at, now)) return {};
  BasicLeg<S> leg = *first;
  BasicSpot<S> spot = at;
  for (std::int64_t legs = 0; legs < road.ring.capacity(); ++legs) {
    const S length = leg.length();
    leg.advance(leg.left());
    const BasicState<S> end = leg.state();
    spot = road.snapped(road.advance(spot, length));
    if (!(end.velocity > negligible_speed<S>)) return first;
    if (!road.ring.holds(spot.block)) return {};
    if (spot.along == S(0) && end.velocity > road.junction_cap(spot.block) * junction_tolerance<S>) return {};
    leg = braking_on(road, spot, end, zones);
    if (!keeps_junctions(road, leg, spot, end)) return {};
  }
  return {};
}

}  // namespace cncplan::plan
