// Back within the limits: what every motion begins with whose start is beyond them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>

#include "cncplan/core/axis_limits.hpp"
#include "cncplan/core/axis_state.hpp"
#include "cncplan/core/detail/jerk_phase.hpp"

namespace cncplan {

/// The velocity at which the acceleration has come to zero at full jerk.
template <std::floating_point S>
[[nodiscard]] constexpr S settled_velocity(const BasicAxisState<S>& state, S jerk) {
  return state.velocity + state.acceleration * std::abs(state.acceleration) / (S(2) * jerk);
}

/// Whether velocity and settled velocity are within their limits: false for some that are beyond by rounding.
template <std::floating_point S>
[[nodiscard]] constexpr bool settles_within(S velocity, S acceleration, const BasicAxisLimits<S>& limits) {
  const S change = acceleration * std::abs(acceleration), jerk = S(2) * limits.jerk;
  const S above = limits.velocity_up - velocity, below = limits.velocity_down + velocity;
  return above >= S(0) && below >= S(0) && change <= jerk * above && -change <= jerk * below;
}

/// The part of a motion that the limits force upon it.
template <std::floating_point S>
struct BasicReturn {
  std::array<BasicJerkPhase<S>, 2> phases{};  ///< jerk, then constant acceleration; either may take no time
  BasicAxisState<S> state{};  ///< behind them, within the limits: the acceleration, and the velocity that is
                              ///< left when it is let go at full jerk
  S settles{};  ///< +1, -1 where that velocity is the limit upwards, downwards, by the return; else 0

  [[nodiscard]] constexpr S duration() const { return phases[0].duration + phases[1].duration; }
};

/// The beginning of the fastest way back. Acceleration first, at full jerk. Where the velocity would settle
/// beyond its limit, it is braked so that it settles at the limit, as soon as possible; what is given here
/// ends where the brake is let go: from there motions part.
template <std::floating_point S>
[[nodiscard]] BasicReturn<S> return_to_limits(const BasicAxisState<S>& start,
                                              const BasicAxisLimits<S>& limits) {
  const bool jerky = limits.jerk == BasicAxisLimits<S>::infinity;
  BasicReturn<S> back{{}, start, S(0)};
  if (jerky) back.state.acceleration = S(0);
  const auto drive = [&](std::size_t i, const BasicJerkPhase<S>& phase) {
    back.phases[i] = phase;
    back.state = phase.after(back.state, phase.duration);
  };
  const S v = start.velocity, a = back.state.acceleration, jerk = limits.jerk;
  if (settles_within(v, a, limits) && a <= limits.acceleration_up && a >= -limits.acceleration_down)
    return back;
  const S settled = settled_velocity(back.state, jerk);
  const S rounding = S(16) * std::numeric_limits<S>::epsilon() * std::max(std::abs(v), std::abs(settled));
  const bool above = settled > limits.velocity_up + rounding;
  if (!above && settled >= -limits.velocity_down - rounding) {
    const S held = std::clamp(a, -limits.acceleration_down, limits.acceleration_up);
    if (held != a) {
      drive(0, {std::abs(held - a) / jerk, a, std::copysign(jerk, held - a)});
      back.state.acceleration = held;
    }
    return back;
  }
  // with all signs turned so that the velocity is above its limit
  const S sign = above ? S(1) : S(-1);
  back.settles = sign;
  const S most = above ? limits.velocity_up : limits.velocity_down;
  const S brake = above ? limits.acceleration_down : limits.acceleration_up;
  const S excess = sign * v - most;
  const S push = sign * a;
  if (jerky) {
    drive(1, {excess / brake, -sign * brake, S(0)});
    back.state = {back.state.position, sign * most, S(0)};
    return back;
  }
  const S trough = std::min(std::sqrt(std::max(jerk * excess + push * push / S(2), S(0))), brake);
  drive(0, {std::abs(push + trough) / jerk, a, -std::copysign(jerk, sign * (push + trough))});
  back.state.acceleration = -sign * trough;
  const S left = sign * settled_velocity(back.state, jerk) - most;
  if (trough == brake && left > S(0)) drive(1, {left / brake, -sign * brake, S(0)});
  return back;
}

}  // namespace cncplan
