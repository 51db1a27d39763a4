// How fast an axis may turn round, so that its drive has time for it.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

namespace cncplan::step {

/// What a drive asks for where its axis turns round: not to go farther than `distance` within `time` from
/// there.
template <std::floating_point S>
struct BasicReversalRule {
  S time{};      ///< s
  S distance{};  ///< mm or rad
};

using ReversalRule = BasicReversalRule<double>;

/// The highest speed along a path, mm/s, at a place where an axis turns round. `rate` and `bend` are the
/// axis' first and second derivative by length behind it (1 and 1/mm, times rad/mm for a rotary axis),
/// `acceleration` is the limit along the path. Within t the way is x = v t + A t^2 / 2 at most, and the axis
/// goes |rate| x + |bend| x^2 / 2, to second order of x. 0 where even a stop is too fast: that needs a pause.
template <std::floating_point S>
[[nodiscard]] S reversal_speed(S rate, S bend, S acceleration, const BasicReversalRule<S>& rule) {
  const S linear = std::abs(rate), square = S(2) * std::abs(bend);
  const S sum = linear + std::sqrt(linear * linear + square * rule.distance);
  if (!(sum > S(0))) return std::numeric_limits<S>::infinity();
  const S way = S(2) * rule.distance / sum;
  return std::max(way / rule.time - acceleration * rule.time / S(2), S(0));
}

}  // namespace cncplan::step
