// How fast an axis may turn round, so that its drive has time for it.
#pragma once

#include <cmath>
#include <concepts>
#include <limits>

namespace cncplan::plan {

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
/// `acceleration` is the limit along the path. Within t the axis goes |rate| (v t + A t^2 / 2) + |bend| v^2
/// t^2 / 2, to second order. 0 where even a stop is too fast: that needs a pause.
template <std::floating_point S>
[[nodiscard]] S reversal_speed(S rate, S bend, S acceleration, const BasicReversalRule<S>& rule) {
  const S t = rule.time;
  const S left = rule.distance - std::abs(rate) * acceleration * t * t / S(2);
  if (!(left > S(0))) return S(0);
  const S linear = std::abs(rate) * t;
  const S square = std::abs(bend) * t * t / S(2);
  const S most = linear + std::sqrt(linear * linear + S(4) * square * left);
  return most > S(0) ? S(2) * left / most : std::numeric_limits<S>::infinity();
}

}  // namespace cncplan::plan
