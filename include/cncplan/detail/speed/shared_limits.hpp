// Which blocks can share one set of limits.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include "cncplan/core/limits.hpp"

namespace cncplan::detail {

/// A span keeps the lowest acceleration and jerk limits of its blocks. Where they differ by more than this, a
/// zero-acceleration junction divides them. A zero-acceleration junction in a ramp over short blocks costs
/// more than lower limits do; on a block with room for a whole ramp it costs nothing.
template <std::floating_point S>
inline constexpr S shared_limits_ratio = S(2.5);
template <std::floating_point S>
inline constexpr S shared_limits_ratio_of_long_blocks = S(1.3);

/// mm, at least what a ramp between rest and the velocity limit takes; 0 where there are no other limits.
template <std::floating_point S>
[[nodiscard]] S room_for_ramp(const BasicLimits<S>& limits) {
  const auto& [v, a, j] = limits;
  return v * std::max(std::sqrt(v / j), v / a);
}

/// Whether a length is above `room_for_ramp`: no root and no quotient, as it is asked of every block.
template <std::floating_point S>
[[nodiscard]] bool has_room_for_ramp(const BasicLimits<S>& limits, S length) {
  const auto& [v, a, j] = limits;
  return length * a > v * v && length * length * j > v * v * v;
}

/// The limits of acceleration and jerk of consecutive blocks, from lowest to highest.
template <std::floating_point S>
class BasicSharedLimits {
 public:
  BasicSharedLimits(const BasicLimits<S>& limits, S length, bool ramps_inside)
      : low_(limits), high_(limits), long_(has_room_for_ramp(limits, length)), alone_(ramps_inside) {}

  /// Takes in the limits of the next block; whether they still differ by no more than the ratio, and ramps
  /// may cross from one block to the other.
  bool take(const BasicLimits<S>& limits, S length, bool ramps_inside) {
    if (alone_ || ramps_inside) return false;
    low_ = {S(0), std::min(low_.acceleration, limits.acceleration), std::min(low_.jerk, limits.jerk)};
    high_ = {S(0), std::max(high_.acceleration, limits.acceleration), std::max(high_.jerk, limits.jerk)};
    long_ = long_ || has_room_for_ramp(limits, length);
    const S ratio = long_ ? shared_limits_ratio_of_long_blocks<S> : shared_limits_ratio<S>;
    return !(high_.acceleration > ratio * low_.acceleration || high_.jerk > ratio * low_.jerk);
  }

 private:
  BasicLimits<S> low_, high_;
  bool long_;   // one of them has room for a whole ramp
  bool alone_;  // ramps do not leave it
};

}  // namespace cncplan::detail
