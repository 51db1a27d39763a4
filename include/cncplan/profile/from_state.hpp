// Profiles that begin in any state of motion: to rest as soon as possible, or to a speed over a length.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <optional>
#include <type_traits>

#include "cncplan/core/error.hpp"
#include "cncplan/core/limits.hpp"
#include "cncplan/core/state.hpp"
#include "cncplan/profile/profile.hpp"
#include "cncplan/profile/seven_phase.hpp"

namespace cncplan::profile {

/// Speed and acceleration along the path that motion begins with.
template <std::floating_point S>
struct BasicStartState {
  S velocity{};      ///< mm/s, >= 0
  S acceleration{};  ///< mm/s^2, within the limit

  friend bool operator==(const BasicStartState&, const BasicStartState&) = default;
};

using StartState = BasicStartState<double>;

/// The speed at which the acceleration has come to zero at full jerk: the slowest that is still ahead of
/// motion that brakes, the fastest that cannot be avoided by motion that speeds up.
template <std::floating_point S>
[[nodiscard]] S settled_speed(const BasicStartState<S>& start, const BasicLimits<S>& limits) {
  return start.velocity + start.acceleration * std::abs(start.acceleration) / (S(2) * limits.jerk);
}

/// The fastest ramp from a state to a speed with zero acceleration. With s the sign of the change still to be
/// made behind the settled speed, and all quantities times s, the speed gained up to a peak acceleration p
/// and down to zero is (2 p^2 - a0^2) / (2 J); p is cut at the acceleration limit, which is then held.
template <std::floating_point S>
[[nodiscard]] BasicRamp<S> ramp_from(const BasicStartState<S>& start, S target,
                                     const BasicLimits<S>& limits) {
  const S sign = target < settled_speed(start, limits) ? S(-1) : S(1);
  const S change = sign * (target - start.velocity);
  const S jerk = limits.jerk;
  if (!std::isfinite(jerk))
    return {S(0), change / limits.acceleration, S(0), sign * limits.acceleration, S(0)};
  const S from = sign * start.acceleration;
  S peak = std::sqrt(std::max(jerk * change + from * from / S(2), S(0)));
  S hold = S(0);
  if (peak > limits.acceleration) {
    peak = limits.acceleration;
    hold = std::max((change - (S(2) * peak * peak - from * from) / (S(2) * jerk)) / peak, S(0));
  }
  peak = std::max(peak, from);
  return {(peak - from) / jerk, hold, peak / jerk, sign * peak, sign * jerk};
}

/// Distance of a ramp that begins in a state.
template <std::floating_point S>
[[nodiscard]] constexpr S distance(const BasicStartState<S>& start, const BasicRamp<S>& ramp) {
  const BasicPhase<S> first{S(0), ramp.first, S(0), start.velocity, start.acceleration, ramp.jerk};
  const BasicState<S> rising = first.at(ramp.first);
  const BasicPhase<S> hold{S(0), ramp.hold, rising.position, rising.velocity, ramp.acceleration, S(0)};
  const BasicState<S> held = hold.at(ramp.hold);
  const BasicPhase<S> last{S(0), ramp.last, held.position, held.velocity, ramp.acceleration, -ramp.jerk};
  return last.at(ramp.last).position;
}

namespace detail {

// The highest speed that limits and a state tell of: what rounding is measured by. It comes from the speeds
// that a profile has on the way, so it stays as the speed vanishes.
template <std::floating_point S>
[[nodiscard]] S fastest_known(const BasicStartState<S>& start, const BasicLimits<S>& limits) {
  return std::max({limits.velocity, start.velocity, settled_speed(start, limits)});
}

// How far from the exact motion the speed of a state may be that was read off a profile.
template <std::floating_point S>
[[nodiscard]] S speed_rounding(const BasicStartState<S>& start, const BasicLimits<S>& limits) {
  return S(16) * std::numeric_limits<S>::epsilon() * fastest_known(start, limits);
}

// Likewise, as a share, its acceleration and the length left. These have the rounding of the profile's whole
// time and length, which are not known here: it is taken for 10^4 times the way to rest.
template <std::floating_point S>
inline constexpr S share_rounding = std::max(S(1e-11), S(64) * std::numeric_limits<S>::epsilon());

template <std::floating_point S>
[[nodiscard]] S length_rounding(S length, const BasicStartState<S>& start, const BasicLimits<S>& limits) {
  const S way_to_rest = seven_phase_law(limits).distance(fastest_known(start, limits), S(0));
  return share_rounding<S> * (length + way_to_rest);
}

// The state itself, or what is wrong with it: not finite, running backwards, accelerating beyond the limit,
// or bound to run backwards because it brakes too hard (bound: the speed at which its acceleration is gone).
// One that is so by no more than a profile's rounding is moved to the limit.
template <std::floating_point S>
[[nodiscard]] Expected<BasicStartState<S>> check(const BasicStartState<S>& start,
                                                 const BasicLimits<S>& limits) {
  if (auto valid = validate(limits); !valid) return tl::unexpected(valid.error());
  const auto [v, a] = start;
  if (!std::isfinite(v)) return refusal(ErrorCode::not_finite, "start speed", v, S(0));
  if (!std::isfinite(a)) return refusal(ErrorCode::not_finite, "start acceleration", a, S(0));
  const S settled = settled_speed(start, limits);
  constexpr S own_rounding = S(16) * std::numeric_limits<S>::epsilon();
  if (v >= S(0) && std::abs(a) <= limits.acceleration * (S(1) + own_rounding) && settled >= -own_rounding * v)
    return start;
  const S rounding = speed_rounding(start, limits);
  if (v < -rounding) return refusal(ErrorCode::negative, "start speed", v, S(0));
  if (std::abs(a) > limits.acceleration * (S(1) + share_rounding<S>))
    return refusal(ErrorCode::above_limit, "start acceleration", a, limits.acceleration);
  const S held = std::clamp(a, -limits.acceleration, limits.acceleration);
  const S lost = -settled_speed({S(0), held}, limits);
  if (v - lost < -rounding) return refusal(ErrorCode::below_limit, "start acceleration", a, settled);
  return BasicStartState<S>{std::max({v, lost, S(0)}), held};
}

}  // namespace detail

/// To rest as soon as the limits allow, wherever that is: what a feed hold does. The profile's length is the
/// distance that it takes. Any state of a profile is accepted, to rounding: see `from_state`. Errors: a state
/// that is not finite, goes backwards, or must come to do so.
template <std::floating_point S>
[[nodiscard]] Expected<BasicProfile<S>> stop(const BasicStartState<S>& start, const BasicLimits<S>& limits) {
  const auto state = detail::check(start, limits);
  if (!state) return tl::unexpected(state.error());
  const BasicRamp<S> ramp = ramp_from(*state, S(0), limits);
  return BasicProfile<S>({.length = distance(*state, ramp),
                          .start_velocity = state->velocity,
                          .start_acceleration = state->acceleration,
                          .top_velocity = S(0),
                          .end_velocity = S(0),
                          .cruise = S(0),
                          .up = ramp,
                          .down = {}});
}

/// The fastest motion from a state to an end speed (zero acceleration) over exactly `length` mm. A start
/// above the speed limit is brought down to it as fast as the other limits allow; one below it whose
/// acceleration cannot end in time (`settled_speed` above the limit) passes it first: `peak()` tells.
///
/// Any state of a profile (`s = p.at(t)`) of any solver within the same limits is accepted, with the length
/// left (`p.length() - s.position`) and the profile's end speed. Where it would be refused for rounding
///
/// - motion begins up to 16 eps of the highest speed beside the state, so that it ends in the limit case;
/// - its way may be longer than `length`, or `length` less than 0, by a share of 1e-11 (`float`: 64 eps) of
///   `length` and the way to rest from the speed limit: the position steps back by that at the end, to
///   `length`;
/// - the acceleration may exceed its limit by that share, and is cut.
///
/// This holds for profiles up to 10^4 times (`float`: 10 times) as long as that way in mm and as A / J in s.
/// For the length left of a longer one add 4 eps of the whole length. Any motion that reaches a speed v with
/// hardly any acceleration left may step likewise by up to 4 v sqrt(eps v / J): what it takes to make up for
/// the rounding of v.
///
/// Three families, by growing length: braking all the way, with the brake released for a while at first; from
/// the settled speed (or the end speed, if that is higher) up to a top speed and down again; and the same
/// with a cruise at the speed limit. Within each the distance grows with one parameter, which is found by
/// halving an interval eight times more often than there are digits, at most. Errors: as `stop`, as the other
/// solvers; `end_speed_unreachable`, where the length is too short, with the bound that they give. A slower
/// end speed than the bound, rest among them, may be reachable again: the shortest way does not always grow
/// as its end speed falls.
template <std::floating_point S = double>
[[nodiscard]] Expected<BasicProfile<S>> from_state(std::type_identity_t<S> length,
                                                   const BasicStartState<S>& start,
                                                   std::type_identity_t<S> end_velocity,
                                                   const BasicLimits<S>& limits);

namespace detail {

// What `from_state` puts together.
template <std::floating_point S>
class FromState {
 public:
  FromState(S length, const BasicStartState<S>& start, S end_velocity, const BasicLimits<S>& limits)
      : length_(length), start_(start), end_(end_velocity), limits_(limits), law_(seven_phase_law(limits)) {}

  [[nodiscard]] Expected<BasicProfile<S>> solve() const {
    if (const auto exact = fitting()) return *exact;
    const BasicStartState<S> near = nearer();
    if (const auto moved = FromState(length_, near, end_, limits_).fitting()) return *moved;
    if (const auto rounded = directly(near)) return *rounded;
    return refusal(ErrorCode::end_speed_unreachable, "end speed", end_, reachable());
  }

 private:
  // The three families.
  [[nodiscard]] std::optional<BasicProfile<S>> fitting() const {
    const S settled = std::max(settled_speed(start_, limits_), S(0));
    const S least_top = std::max(settled, end_);
    if (covered(least_top) <= length_ || least_top > limits_.velocity) {
      const S top = least_top > limits_.velocity ? std::max(limits_.velocity, end_)
                                                 : highest([&](S speed) { return covered(speed) <= length_; },
                                                           least_top, limits_.velocity);
      if (covered(top) <= length_) return through(top);
    }
    if (end_ < settled && start_.acceleration < S(0)) {
      const auto released = [&](S acceleration) { return release(acceleration).length() <= length_; };
      if (released(start_.acceleration)) {
        const S least = highest(released, start_.acceleration, S(0));
        return release(least, length_);
      }
    }
    return {};
  }

  // The settled speed is at the end speed, to rounding. There a ramp for what lacks would have to begin anew,
  // and its length grows with the root of that: it must not be driven.
  [[nodiscard]] bool settles_at_end() const {
    return std::abs(end_ - settled_speed(start_, limits_)) <= speed_rounding(start_, limits_);
  }

  // The state within rounding that is nearest to one that settles at the end speed: its way is shorter.
  [[nodiscard]] BasicStartState<S> nearer() const {
    const S rounding = speed_rounding(start_, limits_);
    const S gained = settled_speed({S(0), start_.acceleration}, limits_);
    const S speed = settles_at_end()
                        ? end_ - gained
                        : start_.velocity + std::copysign(rounding, end_ - settled_speed(start_, limits_));
    return {std::max(speed, S(0)), start_.acceleration};
  }

  // The shortest way from such a state, longer than the length by rounding.
  [[nodiscard]] std::optional<BasicProfile<S>> directly(const BasicStartState<S>& near) const {
    const S jerk = std::isfinite(limits_.jerk) ? limits_.jerk : S(0);
    const S release = std::abs(near.acceleration) / limits_.jerk;
    const BasicRamp<S> ramp =
        settles_at_end() ? BasicRamp<S>{release, S(0), S(0), S(0), -std::copysign(jerk, near.acceleration)}
                         : ramp_from(near, end_, limits_);
    const S left = length_ - distance(near, ramp);
    const S rounding = length_rounding(length_, start_, limits_);
    if (left < -rounding || (left > rounding && end_ == S(0))) return {};
    return BasicProfile<S>({.length = length_,
                            .start_velocity = near.velocity,
                            .start_acceleration = near.acceleration,
                            .top_velocity = end_,
                            .end_velocity = end_,
                            .cruise = left > rounding ? left / end_ : S(0),
                            .up = ramp,
                            .down = {}});
  }

  // The largest parameter in [low, high] for which a condition holds that holds at `low`.
  template <class Condition>
  [[nodiscard]] static S highest(const Condition& holds, S low, S high) {
    if (holds(high)) return high;
    for (int halving = 0; halving < std::numeric_limits<S>::digits + 8; ++halving) {
      const S middle = low + (high - low) / S(2);
      if (!(middle > low && middle < high)) break;
      (holds(middle) ? low : high) = middle;
    }
    return low;
  }

  [[nodiscard]] S covered(S top) const {
    return distance(start_, ramp_from(start_, top, limits_)) + law_.distance(top, end_);
  }

  // By way of a top speed; what is left of the length is a cruise.
  [[nodiscard]] BasicProfile<S> through(S top) const {
    const S left = length_ - covered(top);
    return BasicProfile<S>({.length = length_,
                            .start_velocity = start_.velocity,
                            .start_acceleration = start_.acceleration,
                            .top_velocity = top,
                            .end_velocity = end_,
                            .cruise = left > S(0) && top > S(0) ? left / top : S(0),
                            .up = ramp_from(start_, top, limits_),
                            .down = law_.ramp(std::sqrt(top - end_), end_ - top)});
  }

  // The brake released to a (negative) acceleration, then a ramp to the end speed. As long as it is, or as
  // told.
  [[nodiscard]] BasicProfile<S> release(S acceleration, S length = S(-1)) const {
    const BasicPhase<S> releasing{S(0),
                                  (acceleration - start_.acceleration) / limits_.jerk,
                                  S(0),
                                  start_.velocity,
                                  start_.acceleration,
                                  limits_.jerk};
    const BasicState<S> then = releasing.at(releasing.duration);
    const BasicStartState<S> state{then.velocity, acceleration};
    const BasicRamp<S> down = ramp_from(state, end_, limits_);
    const S whole = then.position + distance(state, down);
    return BasicProfile<S>({.length = length < S(0) ? whole : length,
                            .start_velocity = start_.velocity,
                            .start_acceleration = start_.acceleration,
                            .top_velocity = then.velocity,
                            .end_velocity = end_,
                            .cruise = S(0),
                            .up = {releasing.duration, S(0), S(0), acceleration, limits_.jerk},
                            .down = down});
  }

  // The end speed nearest to the wanted one, on the way to it, that the length allows.
  [[nodiscard]] S reachable() const {
    const S settled = std::max(settled_speed(start_, limits_), S(0));
    const auto fits = [&](S share) {
      const S speed = settled + (end_ - settled) * share;
      return distance(start_, ramp_from(start_, speed, limits_)) <= length_;
    };
    return settled + (end_ - settled) * (fits(S(0)) ? highest(fits, S(0), S(1)) : S(0));
  }

  S length_;
  BasicStartState<S> start_;
  S end_;
  BasicLimits<S> limits_;
  BasicRampLaw<S> law_;
};

}  // namespace detail

template <std::floating_point S>
Expected<BasicProfile<S>> from_state(std::type_identity_t<S> length, const BasicStartState<S>& start,
                                     std::type_identity_t<S> end_velocity, const BasicLimits<S>& limits) {
  const auto state = detail::check(start, limits);
  if (!state) return tl::unexpected(state.error());
  const auto check = [](S value, S bound, std::string_view field) -> Expected<void> {
    if (!std::isfinite(value)) return detail::refusal(ErrorCode::not_finite, field, value, S(0));
    if (value < S(0)) return detail::refusal(ErrorCode::negative, field, value, S(0));
    if (value > bound) return detail::refusal(ErrorCode::above_limit, field, value, bound);
    return {};
  };
  const bool behind = length < S(0) && length >= -detail::length_rounding(S(0), *state, limits);
  const S ahead = behind ? S(0) : length;
  if (auto ok = check(ahead, std::numeric_limits<S>::max(), "length"); !ok) return tl::unexpected(ok.error());
  if (auto ok = check(end_velocity, limits.velocity, "end speed"); !ok) return tl::unexpected(ok.error());
  return detail::FromState<S>(ahead, *state, end_velocity, limits).solve();
}

}  // namespace cncplan::profile
