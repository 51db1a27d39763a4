// All motions of one axis from one state to another: those that are the first, and those of a given duration.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

#include "cncplan/core/axis_limits.hpp"
#include "cncplan/core/axis_state.hpp"
#include "cncplan/core/detail/extremals.hpp"
#include "cncplan/core/detail/jerk_phase.hpp"
#include "cncplan/core/detail/return_to_limits.hpp"

namespace cncplan {

/// A start, a target and limits, made ready to be solved: the return to the limits, and behind it the motions
/// that get farthest upwards and downwards. The target is within the limits, and so is the velocity from
/// which its acceleration comes. A limit of the velocity may be zero: then motion goes one way only.
template <std::floating_point S>
class BasicTransfer {
 public:
  using Scalar = S;
  using State = BasicAxisState<S>;
  using Extremal = BasicExtremal<S>;
  using Phase = BasicJerkPhase<S>;

  BasicTransfer(const State& from, const State& to, const BasicAxisLimits<S>& limits)
      : limits_(limits),
        jerk_limited_(limits.jerk < BasicAxisLimits<S>::infinity),
        root_jerk_(jerk_limited_ ? std::sqrt(limits.jerk) : S(1)),
        time_unit_(S(1) / root_jerk_),
        per_acceleration_up_(root_jerk_ / limits.acceleration_up),
        per_acceleration_down_(root_jerk_ / limits.acceleration_down),
        back_(return_to_limits(from, limits)),
        distance_((to.position - back_.state.position) * root_jerk_),
        up_(task(S(1), to)),
        down_(task(S(-1), to)) {
    const auto& t = up_.task();
    const S v = std::abs(t.start_velocity) + std::abs(t.end_velocity);
    const S a = std::abs(t.start_acceleration) + std::abs(t.end_acceleration);
    const S places = std::abs(to.position) + std::abs(back_.state.position);
    slack_ = S(4) * std::numeric_limits<S>::epsilon() * (places * root_jerk_ + a * (v + a * a));
  }

  /// A motion on one of the two curves. Times of `extremal` are in units of `time_unit`.
  struct Crossing {
    S duration{};  ///< s, with the return; infinite if there is none
    Extremal extremal{};
    S sign{};  ///< +1 upwards, -1 downwards
  };

  /// The first motion that ends at the target, and the first that takes `least` seconds at least. Only there,
  /// where a curve meets the target, durations begin and cease to be possible. Velocities that are rounded
  /// move the end of the shortest motion by the root of that.
  [[nodiscard]] Crossing first() const {
    if (up_.connected()) {
      const S miss = up_.start_miss(distance_);
      if (std::abs(miss) <= slack_) return crossing(up_, up_.start_motion(), S(1));
      const S v = std::abs(up_.task().start_velocity) + std::abs(up_.task().end_velocity);
      constexpr S rounding = S(8) * std::numeric_limits<S>::epsilon();
      if (std::abs(miss) > S(8) * slack_ + v * std::sqrt(rounding * v)) {  // else both curves are tried
        const S sign = miss < S(0) ? S(1) : S(-1);
        const BasicExtremals<S>& extremals = miss < S(0) ? up_ : down_;
        Extremal found;
        if (extremals.only_over(sign * distance_, slack_, found)) return crossing(extremals, found, sign);
      }
    }
    return first_from(S(0));
  }
  [[nodiscard]] Crossing first_from(S least) const {
    Crossing best{std::numeric_limits<S>::infinity(), {}, S(1)};
    const auto search = [&](const BasicExtremals<S>& extremals, S sign) {
      extremals.each_over(sign * distance_, slack_, [&](const Extremal& e) {
        const Crossing found = crossing(extremals, e, sign);
        if (found.duration < least) return false;
        if (found.duration < best.duration) best = found;
        return true;
      });
    };
    search(up_, S(1));
    search(down_, S(-1));
    return best;
  }

  /// The two motions of a duration that get farthest, and where the target lies between their ends.
  struct Range {
    Extremal up{};
    Extremal down{};
    S share{};  ///< 1 at the end of `up`, 0 at that of `down`
    bool possible{};
  };

  [[nodiscard]] Range lasting(S duration) const {
    const S time = (duration - back_.duration()) * root_jerk_;
    const auto [up, up_valid] = up_.lasting(time);
    const auto [down, down_valid] = down_.lasting(time);
    const S high = up_.distance(up);
    const S low = -down_.distance(down);
    const S slack = slack_ + S(16) * std::numeric_limits<S>::epsilon() * (std::abs(high) + std::abs(low));
    const bool within = distance_ >= low - slack && distance_ <= high + slack;
    const S share = high > low ? std::clamp((distance_ - low) / (high - low), S(0), S(1)) : S(1);
    return {up, down, share, up_valid && down_valid && within};
  }

  /// Calls `take` with a motion's nine phases, the return first; some take no time. In between, `first` to
  /// `last`, the acceleration may pass zero without a cruise.
  template <class Take>
  decltype(auto) with_phases(const Extremal& e, S sign, Take&& take) const {
    const auto& t = (sign > S(0) ? up_ : down_).task();
    const S jerk = jerk_limited_ ? sign * limits_.jerk : S(0);
    const S unit = sign * root_jerk_;
    const S first = jerk_limited_ ? e.first_peak * unit : sign * t.rise;
    const S last = jerk_limited_ ? -e.last_peak * unit : -sign * t.fall;
    const bool rests = e.first_peak >= S(0) && e.last_peak >= S(0);
    const S cruised = rests ? S(0) : first;
    return take(
        back_.phases[0], back_.phases[1],
        Phase{(e.first_peak - t.start_acceleration) * time_unit_, back_.state.acceleration, jerk},
        Phase{e.first_hold * time_unit_, first, S(0)},
        Phase{rests ? e.first_peak * time_unit_ : S(0), first, -jerk},
        Phase{e.cruise * time_unit_, cruised, S(0)},
        Phase{std::max(rests ? e.last_peak : e.first_peak + e.last_peak, S(0)) * time_unit_, cruised, -jerk},
        Phase{e.last_hold * time_unit_, last, S(0)},
        Phase{(e.last_peak + t.end_acceleration) * time_unit_, last, jerk});
  }

 private:
  [[nodiscard]] Crossing crossing(const BasicExtremals<S>& extremals, const Extremal& e, S sign) const {
    return {extremals.duration(e) * time_unit_ + back_.duration(), e, sign};
  }

  // The task in units of the extremals, for one direction.
  [[nodiscard]] BasicExtremalTask<S> task(S sign, const State& to) const {
    const bool up = sign > S(0);
    const S per_root = jerk_limited_ ? time_unit_ : S(0);
    const S v = sign * back_.state.velocity;
    const S a = sign * back_.state.acceleration * per_root;
    const S top = up ? limits_.velocity_up : limits_.velocity_down;
    return {v,
            a,
            sign * to.velocity,
            sign * to.acceleration * per_root,
            back_.settles == sign ? v - a * a / S(2) : top,  // the very number: its root is taken
            (up ? limits_.acceleration_up : limits_.acceleration_down) * time_unit_,
            (up ? limits_.acceleration_down : limits_.acceleration_up) * time_unit_,
            up ? per_acceleration_up_ : per_acceleration_down_,
            up ? per_acceleration_down_ : per_acceleration_up_,
            jerk_limited_};
  }

  BasicAxisLimits<S> limits_;
  bool jerk_limited_;
  S root_jerk_;
  S time_unit_;
  S per_acceleration_up_;
  S per_acceleration_down_;
  BasicReturn<S> back_;
  S distance_;  // from behind the return to the target, times root_jerk_
  BasicExtremals<S> up_;
  BasicExtremals<S> down_;
  S slack_{};
};

}  // namespace cncplan
