// Speed caps: what look-ahead needs to know of each block, from its shape, its feed and the joint before it.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include "cncplan/plan/block.hpp"

namespace cncplan::plan {

/// A block reduced to numbers.
template <std::floating_point S>
struct BasicBlockCaps {
  S length{};             ///< mm
  S entry{};              ///< mm/s, highest speed at its start
  BasicLimits<S> limits;  ///< within it
  S pause{};              ///< s at rest at its end

  friend bool operator==(const BasicBlockCaps&, const BasicBlockCaps&) = default;
};

using BlockCaps = BasicBlockCaps<double>;

/// The speed at which a curve of the given curvature (1/mm, >= 0) may be driven: v^2/R within the
/// acceleration limit and v^3/R^2, the jerk of a circle at constant speed, within the jerk limit.
template <std::floating_point S>
[[nodiscard]] S curve_speed(S curvature, const BasicLimits<S>& limits) {
  if (!(curvature > S(0))) return limits.velocity;
  const S by_acceleration = std::sqrt(limits.acceleration / curvature);
  const S by_jerk = std::cbrt(limits.jerk / (curvature * curvature));
  return std::min({limits.velocity, by_acceleration, by_jerk});
}

/// The caps of the first block of a program, or of one behind a stop.
template <std::floating_point S>
[[nodiscard]] BasicBlockCaps<S> caps_from_rest(const BasicBlock<S>& block) {
  BasicBlockCaps<S> result{block.segment.length(), S(0), block.limits, block.pause};
  result.limits.velocity = curve_speed(block.segment.max_curvature(), block.limits);
  return result;
}

/// The caps of a block that follows another: the joint by the policy, the inside by its curvature.
template <std::floating_point S, class Policy>
  requires JunctionPolicy<Policy, S>
[[nodiscard]] BasicBlockCaps<S> caps(const BasicBlock<S>& before, const BasicBlock<S>& block,
                                     const Policy& policy) {
  BasicBlockCaps<S> result = caps_from_rest(block);
  if (before.stop_at_end || before.pause > S(0)) return result;
  junction::BasicGeometry<S> joint{side(before, true), side(block, false), block.limits};
  joint.limits.velocity = std::min(before.limits.velocity, block.limits.velocity);
  joint.limits.acceleration = std::min(before.limits.acceleration, block.limits.acceleration);
  joint.limits.jerk = std::min(before.limits.jerk, block.limits.jerk);
  result.entry = std::sqrt(policy.speed_sq(joint));
  return result;
}

}  // namespace cncplan::plan
