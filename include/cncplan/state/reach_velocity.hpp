// From states to velocities, which the axes keep: jogging, and stopping.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <optional>

#include "cncplan/core/axis_limits.hpp"
#include "cncplan/core/axis_state.hpp"
#include "cncplan/core/error.hpp"
#include "cncplan/state/detail/axis_motions.hpp"
#include "cncplan/state/detail/travel.hpp"
#include "cncplan/state/detail/velocity_change.hpp"
#include "cncplan/state/motion.hpp"
#include "cncplan/state/move_options.hpp"

namespace cncplan::state {

namespace detail {

/// A change of velocity, a cruise and a stop that ends at a position; none where there is no room for both
/// ramps.
template <std::floating_point S>
[[nodiscard]] std::optional<BasicMotion<S>> ending_at(const BasicMotion<S>& change, S position,
                                                      const BasicAxisLimits<S>& limits) {
  const BasicAxisState<S> reached = change.end();
  const BasicMotion<S> stop = BasicVelocityChange<S>(reached, S(0), limits).fastest();
  const S cruise = (position - stop.end().position) / reached.velocity;
  if (!(cruise >= S(0))) return {};
  BasicMotion<S> m(change.start(), {position, S(0), S(0)});
  for (const auto& phase : change.phases()) m.append(phase);
  m.append({cruise, S(0), S(0)});
  for (const auto& phase : stop.phases()) m.append(phase);
  return m;
}

/// Keeps a change of velocity in the axis' travel: it comes to rest at the end towards which it goes on, or,
/// beyond that, where it is. With
/// no room for all of the change, it is the fastest motion to that end at which the velocity is no limit to
/// be exceeded.
template <std::floating_point S>
[[nodiscard]] BasicMotion<S> in_travel(const BasicMotion<S>& change, S velocity,
                                       const BasicAxisLimits<S>& limits) {
  const BasicAxisLimits<S> travel = with_start(limits, change.start().position);
  const S end = velocity < S(0) ? travel.low : travel.high;
  if (velocity == S(0) || !std::isfinite(end)) return change;
  if (const auto motion = ending_at(change, end, limits)) return *motion;
  BasicAxisLimits<S> slower = limits;
  (velocity < S(0) ? slower.velocity_down : slower.velocity_up) = std::abs(velocity);
  return BasicAxisMotions<S>(change.start(), {end, S(0), S(0)}, slower).fastest();
}

}  // namespace detail

/// The motions of all axes to their velocities, which go on behind the motions' ends. All reach them at once,
/// or, without synchronisation, each as soon as it can; in phase is as in time. An axis with an end of its
/// travel ahead comes to rest there, where its motion ends. Errors: those of `axis_motions` (a velocity
/// beyond its limit) and `within_travel`, and a minimum duration that is negative or not finite.
template <std::floating_point S, int N>
[[nodiscard]] Expected<std::array<BasicMotion<S>, static_cast<std::size_t>(N)>> reach_velocities(
    const BasicAxisStates<S, N>& from, const std::array<S, static_cast<std::size_t>(N)>& velocities,
    const std::array<BasicAxisLimits<S>, static_cast<std::size_t>(N)>& limits,
    const BasicMoveOptions<S>& options = {}) {
  if (const auto ok = validate(options); !ok) return tl::unexpected(ok.error());
  std::array<BasicMotion<S>, static_cast<std::size_t>(N)> motions{};
  S duration = options.minimum_duration;
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const BasicAxisState<S> target{from.position[i], velocities[i], S(0)};
    if (const auto ok = validate(from.axis(i), target, limits[i]); !ok) return tl::unexpected(ok.error());
    motions[i] = BasicVelocityChange<S>(from.axis(i), velocities[i], limits[i]).fastest();
    if (options.synchronization != Synchronization::none)
      duration = std::max(duration, motions[i].duration());
  }
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const BasicVelocityChange<S> change(from.axis(i), velocities[i], limits[i]);
    if (motions[i].duration() < duration) motions[i] = change.lasting(duration);
    motions[i] = detail::in_travel(motions[i], velocities[i], limits[i]);
    if (const auto ok = within_travel(motions[i], limits[i]); !ok) return tl::unexpected(ok.error());
  }
  return motions;
}

}  // namespace cncplan::state
