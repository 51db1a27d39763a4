// The same move in a longer time: for axes that arrive together, or a block rounded to whole periods.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

#include "cncplan/core/error.hpp"
#include "cncplan/profile/seven_phase.hpp"

namespace cncplan::profile {

/// A profile over the same length between the same speeds that takes `duration` seconds, at a lower speed in
/// the middle: a ramp to it, a cruise, a ramp from it. Limits hold. Errors: `below_limit` for a time shorter
/// than the fastest profile's, with that as bound; `above_limit` for one longer than the length allows at
/// these end speeds, with the longest found as bound; and those of `seven_phase`.
template <std::floating_point S>
[[nodiscard]] Expected<BasicProfile<S>> stretched(S length, const BasicBoundarySpeeds<S>& speeds, S duration,
                                                  const BasicLimits<S>& limits) {
  const auto fastest = seven_phase(length, speeds, limits);
  if (!fastest) return fastest;
  constexpr S rounding = S(16) * std::numeric_limits<S>::epsilon();
  if (!(duration >= fastest->duration() * (S(1) - rounding)))
    return detail::refusal(ErrorCode::below_limit, "duration", duration, fastest->duration());
  if (duration <= fastest->duration() * (S(1) + rounding)) return fastest;
  const BasicRampLaw<S> law = seven_phase_law(limits);
  const S start = speeds.start;  // clang++ 14 captures no structured bindings
  const S end = speeds.end;
  const auto at_middle_speed = [&](S speed) {
    const BasicRamp<S> first = law.ramp(std::sqrt(std::abs(speed - start)), speed - start);
    const BasicRamp<S> last = law.ramp(std::sqrt(std::abs(end - speed)), end - speed);
    const S covered = (start + speed) / S(2) * first.duration() + (speed + end) / S(2) * last.duration();
    return BasicProfile<S>({.length = length,
                            .start_velocity = start,
                            .start_acceleration = S(0),
                            .top_velocity = speed,
                            .end_velocity = end,
                            .cruise = (length - covered) / speed,  // negative: the ramps do not fit
                            .up = first,
                            .down = last});
  };
  // From the top downwards the time grows for as long as the ramps fit.
  S fast = fastest->top_velocity();
  S slow = S(0);
  for (int halving = 0; halving < 2 * std::numeric_limits<S>::digits; ++halving) {
    const S middle = slow + (fast - slow) / S(2);
    if (!(middle > slow && middle < fast)) break;
    const BasicProfile<S> tried = at_middle_speed(middle);
    (tried.parts().cruise >= S(0) && tried.duration() <= duration ? fast : slow) = middle;
  }
  const BasicProfile<S> result = at_middle_speed(fast);
  constexpr S tolerance = S(1e3) * std::numeric_limits<S>::epsilon();
  if (std::abs(result.duration() - duration) <= tolerance * duration) return result;
  return detail::refusal(ErrorCode::above_limit, "duration", duration, result.duration());
}

}  // namespace cncplan::profile
