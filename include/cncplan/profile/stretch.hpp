// The same move in a longer time: for axes that arrive together, or a block rounded to whole periods.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <type_traits>

#include "cncplan/core/error.hpp"
#include "cncplan/profile/seven_phase.hpp"

namespace cncplan::profile {

/// A profile over the same length between the same speeds that takes `duration` seconds, at a lower speed in
/// the middle: a ramp to it, a cruise, a ramp from it. Limits hold. Errors: `below_limit` for a time shorter
/// than the fastest profile's, with that as bound; `above_limit` for one that no middle speed gives, with the
/// longest below it that one gives as bound; and those of `seven_phase`.
///
/// Both ramps together take the same length at either end speed as middle speed. In between they take more,
/// up to a crest; below the lower end speed as well, but from a crest there on less again, down to zero
/// speed. So the ramps may fit near the end speeds and again near a standstill, where any time can be had.
/// Where they fit, the time falls as the middle speed grows: between a crest and a speed beside it that fits,
/// halving finds the time or the last speed that fits.
template <std::floating_point S = double>
[[nodiscard]] Expected<BasicProfile<S>> stretched(std::type_identity_t<S> length,
                                                  const BasicBoundarySpeeds<S>& speeds,
                                                  std::type_identity_t<S> duration,
                                                  const BasicLimits<S>& limits) {
  const auto fastest = seven_phase(length, speeds, limits);
  if (!fastest) return fastest;
  constexpr S rounding = S(16) * std::numeric_limits<S>::epsilon();
  if (!(duration >= fastest->duration() * (S(1) - rounding)))
    return refusal(ErrorCode::below_limit, "duration", duration, fastest->duration());
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
  // Where the ramps are longest between two speeds. Half of the digits would do, as it is flat there.
  const auto crest = [&](S low, S high) {
    const auto covered = [&](S speed) { return law.distance(start, speed) + law.distance(speed, end); };
    for (int third = 0; third < std::numeric_limits<S>::digits; ++third) {
      const S left = low + (high - low) / S(3);
      const S right = high - (high - low) / S(3);
      if (covered(left) < covered(right))
        low = left;
      else
        high = right;
    }
    return low;
  };
  const S lower = std::min(start, end);
  const std::array<S, 5> marks{S(0), crest(S(0), lower), lower, crest(lower, std::max(start, end)),
                               fastest->top_velocity()};
  S longest = fastest->duration();
  for (std::size_t piece = marks.size() - 1; piece-- > 0;) {
    S slow = marks[piece];
    S fast = marks[piece + 1];
    const bool crest_below = piece % 2 == 1;
    for (int halving = 0; halving < 2 * std::numeric_limits<S>::digits; ++halving) {
      const S middle = slow + (fast - slow) / S(2);
      if (!(middle > slow && middle < fast)) break;
      const BasicProfile<S> tried = at_middle_speed(middle);
      const bool too_slow = tried.parts().cruise >= S(0) ? tried.duration() > duration : crest_below;
      (too_slow ? slow : fast) = middle;
    }
    const BasicProfile<S> found = at_middle_speed(crest_below ? fast : slow);
    constexpr S tolerance = S(8) * std::numeric_limits<S>::epsilon();
    if (std::abs(found.duration() - duration) * found.top_velocity() <= tolerance * length) {
      auto parts = found.parts();  // what rounding leaves goes to the length: at low speeds it is much time
      parts.cruise = std::max(duration - parts.up.duration() - parts.down.duration(), S(0));
      return BasicProfile<S>(parts);
    }
    if (found.duration() < duration) longest = std::max(longest, found.duration());
  }
  return refusal(ErrorCode::above_limit, "duration", duration, longest);
}

}  // namespace cncplan::profile
