// Caps: what look-ahead needs to know of each block, from its shape, its feed and the junction before it.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include "cncplan/plan/block.hpp"
#include "cncplan/plan/curve_limits.hpp"

namespace cncplan::plan {

/// A block reduced to numbers.
template <std::floating_point S>
struct BasicBlockCaps {
  S length{};             ///< mm
  S entry{};              ///< mm/s, highest speed at its start
  BasicLimits<S> limits;  ///< along the path within it
  S pause{};              ///< s at rest at its end

  friend bool operator==(const BasicBlockCaps&, const BasicBlockCaps&) = default;
};

using BlockCaps = BasicBlockCaps<double>;

/// The caps of the first block of a program, or of one behind a stop.
template <std::floating_point S, CurveRule<S> Rule>
[[nodiscard]] BasicBlockCaps<S> caps_from_rest(const BasicBlock<S>& block, const Rule& rule) {
  return {block.segment.length(), S(0), limits_on(block.segment, block.limits, rule), block.pause};
}

/// The caps of a block that follows another: the junction by the policy, the inside by its bend. A block of
/// no length is a rest.
template <std::floating_point S, JunctionPolicy<S> Policy, CurveRule<S> Rule>
[[nodiscard]] BasicBlockCaps<S> caps(const BasicBlock<S>& before, const BasicBlock<S>& block,
                                     const Policy& policy, const Rule& rule) {
  BasicBlockCaps<S> result = caps_from_rest(block, rule);
  if (before.stop_at_end || before.pause > S(0) || !(result.length > S(0))) return result;
  junction::BasicGeometry<S> junction{side(before, true), side(block, false), block.limits};
  junction.limits.velocity = std::min(before.limits.velocity, block.limits.velocity);
  junction.limits.acceleration = std::min(before.limits.acceleration, block.limits.acceleration);
  junction.limits.jerk = std::min(before.limits.jerk, block.limits.jerk);
  const S speed_sq = policy.speed_sq(junction);
  result.entry = speed_sq > S(0) ? std::sqrt(speed_sq) : S(0);
  return result;
}

}  // namespace cncplan::plan
