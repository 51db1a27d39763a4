// Limits of cells that follow each other in one motion, made alike where that costs next to no time.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include "cncplan/core/limits.hpp"

namespace cncplan::detail {

/// What holds where both do.
template <std::floating_point S>
[[nodiscard]] BasicLimits<S> lowest(const BasicLimits<S>& a, const BasicLimits<S>& b) {
  return {std::min(a.velocity, b.velocity), std::min(a.acceleration, b.acceleration),
          std::min(a.jerk, b.jerk)};
}

/// Limits that differ a little from cell to cell cost more than they give: look-ahead has a junction wherever
/// limits change, and a ramp keeps the lowest limits that it crosses. So a cell takes over limits of the one
/// before that are lower than its own: acceleration and jerk as long as they differ by no more than
/// `most_apart`, velocity for as long as that loses less than `loss` of sqrt(v / j), half a ramp. Limits are
/// only lowered; what a cell has depends on cells before it, never on those behind.
template <std::floating_point S>
class BasicLimitSmoothing {
 public:
  static constexpr S most_apart = S(2);
  static constexpr S loss = S(0.01);

  /// The limits for the next cell, of such a length, in place of its own. A cell that `begins` a motion has
  /// nothing in common with those before.
  [[nodiscard]] BasicLimits<S> next(const BasicLimits<S>& own, S length, bool begins = false) {
    if (begins || far(level_.velocity, own.velocity) || far(level_.acceleration, own.acceleration) ||
        far(level_.jerk, own.jerk)) {
      level_ = own;
      lost_ = S(0);
      return own;
    }
    level_.acceleration = std::min(level_.acceleration, own.acceleration);
    level_.jerk = std::min(level_.jerk, own.jerk);
    lost_ += length / level_.velocity - length / own.velocity;
    if (level_.velocity <= own.velocity && lost_ <= loss * std::sqrt(own.velocity / own.jerk)) return level_;
    level_.velocity = own.velocity;
    lost_ = S(0);
    return level_;
  }

 private:
  static bool far(S a, S b) { return !(std::max(a, b) <= most_apart * std::min(a, b)); }

  BasicLimits<S> level_{};
  S lost_{};  // s, since the velocity is what it is
};

}  // namespace cncplan::detail
