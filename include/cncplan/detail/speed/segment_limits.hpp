// Segment limits: what look-ahead needs to know of a cell.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

#include "cncplan/core/limits.hpp"

namespace cncplan::detail {

/// A block reduced to numbers.
template <std::floating_point S>
struct BasicSegmentLimits {
  S length{};             ///< mm
  S entry{};              ///< mm/s, highest speed at its start
  BasicLimits<S> limits;  ///< along the path within it
  S pause{};              ///< s at rest at its end
  /// The limits hold where v + a^2 / (2 jerk) is at most the velocity: on ramps that end within it.
  bool ramps_inside{};

  friend bool operator==(const BasicSegmentLimits&, const BasicSegmentLimits&) = default;
};

using SegmentLimits = BasicSegmentLimits<double>;

/// The most acceleration, of either sign, with which a block may be entered at a speed.
template <std::floating_point S>
[[nodiscard]] S entry_acceleration(const BasicLimits<S>& limits, bool ramps_inside, S speed) {
  if (!ramps_inside) return limits.acceleration;
  constexpr S rounding = S(1) + std::max(S(1e-9), S(64) * std::numeric_limits<S>::epsilon());
  const S left = std::max(rounding * limits.velocity - speed, S(0));
  return std::min(limits.acceleration, std::sqrt(S(2) * limits.jerk * left));
}

}  // namespace cncplan::detail
