// Which blocks can share one set of limits.
#pragma once

#include <algorithm>
#include <concepts>

#include "cncplan/core/limits.hpp"

namespace cncplan::plan {

/// A span keeps the lowest acceleration and jerk limits of its blocks. Where they differ by more than this, a
/// steady waypoint divides them.
inline constexpr double shared_limits_ratio = 1.3;

/// The limits of acceleration and jerk of consecutive blocks, from lowest to highest.
template <std::floating_point S>
class BasicSharedLimits {
 public:
  explicit BasicSharedLimits(const BasicLimits<S>& limits) : low_(limits), high_(limits) {}

  /// Takes in the limits of the next block; whether they still differ by no more than the ratio.
  bool take(const BasicLimits<S>& limits) {
    low_ = {S(0), std::min(low_.acceleration, limits.acceleration), std::min(low_.jerk, limits.jerk)};
    high_ = {S(0), std::max(high_.acceleration, limits.acceleration), std::max(high_.jerk, limits.jerk)};
    constexpr S ratio = static_cast<S>(shared_limits_ratio);
    return !(high_.acceleration > ratio * low_.acceleration || high_.jerk > ratio * low_.jerk);
  }

 private:
  BasicLimits<S> low_, high_;
};

}  // namespace cncplan::plan
