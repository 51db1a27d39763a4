// From a state to a velocity with zero acceleration, wherever that is.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include "cncplan/core/axis_limits.hpp"
#include "cncplan/core/axis_state.hpp"
#include "cncplan/core/detail/return_to_limits.hpp"
#include "cncplan/state/motion.hpp"

namespace cncplan::state {

/// The changes of velocity from a state, within limits: a return to them, then jerk to a peak of the
/// acceleration, a time at it, and jerk to zero. All of that goes one way from the velocity at which the
/// acceleration of the start has come to zero, so that no velocity is passed twice.
template <std::floating_point S>
class BasicVelocityChange {
 public:
  using Motion = BasicMotion<S>;

  BasicVelocityChange(const BasicAxisState<S>& from, S velocity, const BasicAxisLimits<S>& limits)
      : from_(from), velocity_(velocity), jerk_(limits.jerk), back_(return_to_limits(from, limits)) {
    sign_ = velocity < settled_velocity(back_.state, jerk_) ? S(-1) : S(1);
    most_ = sign_ > S(0) ? limits.acceleration_up : limits.acceleration_down;
    change_ = sign_ * (velocity - back_.state.velocity);
    push_ = sign_ * back_.state.acceleration;
  }

  /// As soon as possible. Up to a peak p and down to zero the velocity changes by (2 p^2 - a0^2) / (2 J).
  [[nodiscard]] Motion fastest() const {
    if (!jerk_limited()) return ramp(most_, change_ / most_);
    const S peak =
        std::max(std::min(std::sqrt(std::max(jerk_ * change_ + push_ * push_ / S(2), S(0))), most_), push_);
    const S hold =
        peak < most_ ? S(0) : (change_ - (S(2) * peak * peak - push_ * push_) / (S(2) * jerk_)) / peak;
    return ramp(peak, std::max(hold, S(0)));
  }

  /// In a time no shorter than the fastest one, with a lower peak. Where that is below the acceleration of
  /// the start, all of the jerk goes down.
  [[nodiscard]] Motion lasting(S duration) const {
    const S time = duration - back_.duration();
    if (!jerk_limited()) return ramp(change_ / time, time);
    const S release = push_ / jerk_;
    const S whole = time + release;
    const S least = change_ + push_ * release / S(2);  // p^2/J - p (T + a0/J) + this = 0
    const S root = std::sqrt(std::max(whole * whole - S(4) * least / jerk_, S(0)));
    const S rising = S(2) * least / (whole + root);
    if (rising >= push_) return ramp(rising, std::max(whole - S(2) * rising / jerk_, S(0)));
    const S hold = time - release;
    const S peak = hold > S(0) ? std::max((change_ - push_ * release / S(2)) / hold, S(0)) : push_;
    return ramp(std::min(peak, push_), std::max(hold, S(0)));
  }

 private:
  [[nodiscard]] bool jerk_limited() const { return jerk_ < BasicAxisLimits<S>::infinity; }

  // By way of a peak at which it stays.
  [[nodiscard]] Motion ramp(S peak, S hold) const {
    const S jerk = jerk_limited() ? sign_ * jerk_ : S(0);
    const S rise = peak - push_;
    const auto drive = [&](const BasicAxisState<S>& end) {
      Motion m(from_, end);
      for (const auto& phase : back_.phases) m.append(phase);
      m.append({std::abs(rise) / jerk_, back_.state.acceleration, rise < S(0) ? -jerk : jerk});
      m.append({hold, sign_ * peak, S(0)});
      m.append({peak / jerk_, sign_ * peak, -jerk});
      return m;
    };
    BasicAxisState<S> end = from_;
    const Motion open = drive({});
    for (const auto& phase : open.phases()) end = phase.after(end, phase.duration);
    return drive({end.position, velocity_, S(0)});
  }

  BasicAxisState<S> from_;
  S velocity_;
  S jerk_;
  BasicReturn<S> back_;
  S sign_{};
  S most_{};    // acceleration
  S change_{};  // of the velocity, in the direction of `sign_`
  S push_{};    // acceleration behind the return, in the same direction
};

}  // namespace cncplan::state
