// Motions held against an axis' travel.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <string_view>

#include "cncplan/core/axis_limits.hpp"
#include "cncplan/core/error.hpp"
#include "cncplan/state/detail/velocity_change.hpp"
#include "cncplan/state/motion.hpp"

namespace cncplan::state {

namespace detail {

/// The travel, and what lies between it and a start beyond one of its ends: the axis may come back.
template <std::floating_point S>
[[nodiscard]] BasicAxisLimits<S> with_start(BasicAxisLimits<S> limits, S start) {
  limits.low = std::min(limits.low, start);
  limits.high = std::max(limits.high, start);
  return limits;
}

template <std::floating_point S>
[[nodiscard]] Expected<void> within_ends(const BasicMotion<S>& motion, const BasicAxisLimits<S>& travel) {
  const BasicAxisLimits<S> limits = with_start(travel, motion.start().position);
  const auto check = [&](S lowest, S highest, std::string_view field) -> Expected<void> {
    const S rounding = S(64) * std::numeric_limits<S>::epsilon() *
                       std::max({std::abs(lowest), std::abs(highest), highest - lowest});
    if (lowest < limits.low - rounding) return refusal(ErrorCode::below_limit, field, lowest, limits.low);
    if (highest > limits.high + rounding) return refusal(ErrorCode::above_limit, field, highest, limits.high);
    return {};
  };
  const auto stopped = BasicVelocityChange<S>(motion.start(), S(0), limits).fastest().extrema();
  if (auto ok = check(stopped.lowest, stopped.highest, "stopping position"); !ok) return ok;
  const S target = motion.end().position;
  if (auto ok = check(target, target, "target position"); !ok) return ok;
  const auto [lowest, highest] = motion.extrema();
  return check(lowest, highest, "position on the way");
}

}  // namespace detail

/// Nothing if a motion stays in its axis' travel, to rounding; from a start beyond an end, if it goes no
/// further beyond. Else, in this order, what is beyond: the position to which the axis would get if it braked
/// at once; the target; the farthest of the motion.
template <std::floating_point S>
[[nodiscard]] Expected<void> within_travel(const BasicMotion<S>& motion, const BasicAxisLimits<S>& limits) {
  constexpr S infinity = BasicAxisLimits<S>::infinity;
  if (limits.low == -infinity && limits.high == infinity) return {};
  return detail::within_ends(motion, limits);
}

}  // namespace cncplan::state
