// How far ahead a machine that runs has to look.
#pragma once

#include <algorithm>
#include <concepts>
#include <limits>

#include "cncplan/core/limits.hpp"
#include "cncplan/profile/seven_phase.hpp"

namespace cncplan::detail {

/// How far a plan has to look ahead: the way from rest to the highest speed and back, each in two ramps with
/// a junction between them, where that is longest. Beyond that hardly anything can slow what comes next, as
/// the motion can still come to rest before it. Each block is taken in as it is met.
///
/// Where junctions are at zero acceleration by force a ramp has to end at each of them, and takes longer: of
/// the way between two of them as much counts as one ramp alone needs for the change of speed that is made
/// there.
template <std::floating_point S>
class Horizon {
 public:
  /// `zero_acceleration`: a junction is where it begins, by force.
  void take(const BasicLimits<S>& limits, S length, bool zero_acceleration = false) {
    if (zero_acceleration) end_ramp();
    ramp_ += length;
    if (limits.velocity <= limits_.velocity && limits.acceleration >= limits_.acceleration &&
        limits.jerk >= limits_.jerk)
      return;
    limits_ = {std::max(limits_.velocity, limits.velocity),
               std::min(limits_.acceleration, limits.acceleration), std::min(limits_.jerk, limits.jerk)};
    enough_ = S(2) * two_ramps * profile::seven_phase_law(limits_).distance(S(0), limits_.velocity);
  }

  [[nodiscard]] bool reached() const { return travelled_ + ramp_ > enough_; }
  /// Whether it is as far as it takes to come to rest from the highest speed.
  [[nodiscard]] bool halfway() const { return travelled_ + ramp_ > enough_ / S(2); }

 private:
  // At full speed it begins anew: a way down is as long as one up.
  void end_ramp() {
    const auto law = profile::seven_phase_law(limits_);
    const S top = profile::seven_phase_solver(limits_).reachable_speed(speed_, ramp_);
    travelled_ += std::min(law.distance(S(0), top) - law.distance(S(0), speed_), ramp_);
    speed_ = top < limits_.velocity ? top : S(0);
    ramp_ = S(0);
  }

  // The highest value of (1 + x) sqrt(1 - x) + x sqrt(x): the way from a speed to the share x of it and from
  // there to rest, over that to rest at once, where the jerk limit alone binds.
  static constexpr S two_ramps = S(1.525);

  BasicLimits<S> limits_{S(0), std::numeric_limits<S>::infinity(), std::numeric_limits<S>::infinity()};
  S speed_{};      // behind the ramps so far
  S ramp_{};       // mm of the one that has begun
  S travelled_{};  // mm that count of those before it
  S enough_{};
};

}  // namespace cncplan::detail
