// How far ahead a machine that runs has to look.
#pragma once

#include <algorithm>
#include <concepts>
#include <limits>

#include "cncplan/core/limits.hpp"
#include "cncplan/profile/seven_phase.hpp"

namespace cncplan::plan {

/// How far a plan has to look ahead: the way from rest to the highest speed and back, each in two ramps with
/// a junction between them, where that is longest. Beyond that hardly anything can slow what comes next, as
/// the motion can still come to rest before it. Each block is taken in as it is met.
template <std::floating_point S>
class Horizon {
 public:
  void take(const BasicLimits<S>& limits, S length) {
    travelled_ += length;
    if (limits.velocity <= limits_.velocity && limits.acceleration >= limits_.acceleration &&
        limits.jerk >= limits_.jerk)
      return;
    limits_ = {std::max(limits_.velocity, limits.velocity),
               std::min(limits_.acceleration, limits.acceleration), std::min(limits_.jerk, limits.jerk)};
    enough_ = S(2) * two_ramps * profile::seven_phase_law(limits_).distance(S(0), limits_.velocity);
  }

  [[nodiscard]] bool reached() const { return travelled_ > enough_; }

 private:
  // The highest value of (1 + x) sqrt(1 - x) + x sqrt(x): the way from a speed to the share x of it and from
  // there to rest, over that to rest at once, where the jerk limit alone binds.
  static constexpr S two_ramps = S(1.525);

  BasicLimits<S> limits_{S(0), std::numeric_limits<S>::infinity(), std::numeric_limits<S>::infinity()};
  S travelled_{};
  S enough_{};
};

}  // namespace cncplan::plan
