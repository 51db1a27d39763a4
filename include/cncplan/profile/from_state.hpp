// Profiles that begin in any state of motion: to rest as soon as possible, or to a speed over a length.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <limits>
#include <optional>
#include <type_traits>

#include "cncplan/core/detail/bracketed_root.hpp"
#include "cncplan/core/detail/cube_root.hpp"
#include "cncplan/core/detail/transfer.hpp"
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
  S acceleration{};  ///< mm/s^2

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
/// and down to zero is (2 p^2 - a0^2) / (2 J); p is cut at the acceleration limit, which is then held. From
/// above that limit the acceleration comes down to it, which gains a0^2 / (2 J) with the way down to zero.
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
    const S gained = from > peak ? from * from : S(2) * peak * peak - from * from;
    hold = std::max((change - gained / (S(2) * jerk)) / peak, S(0));
  } else {
    peak = std::max(peak, from);
  }
  return {std::abs(peak - from) / jerk, hold, peak / jerk, sign * peak,
          peak < from ? -sign * jerk : sign * jerk};
}

/// Distance of a ramp that begins in a state.
template <std::floating_point S>
[[nodiscard]] constexpr S distance(const BasicStartState<S>& start, const BasicRamp<S>& ramp) {
  const BasicPhase<S> first{S(0), ramp.first, S(0), start.velocity, start.acceleration, ramp.jerk};
  const BasicState<S> rising = first.at(ramp.first);
  const BasicPhase<S> hold{S(0), ramp.hold, rising.position, rising.velocity, ramp.acceleration, S(0)};
  const BasicState<S> held = hold.at(ramp.hold);
  const BasicPhase<S> last{S(0),          ramp.last,         held.position,
                           held.velocity, ramp.acceleration, ramp.last_jerk()};
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

// The state itself, or what is wrong with it: not finite, running backwards, accelerating beyond `most`,
// or bound to run backwards because it brakes too hard (bound: the speed at which its acceleration is gone).
// One that is so by no more than a profile's rounding is moved to the limit.
template <std::floating_point S>
[[nodiscard]] Expected<BasicStartState<S>> check(const BasicStartState<S>& start,
                                                 const BasicLimits<S>& limits, S most) {
  if (auto valid = validate(limits); !valid) return tl::unexpected(valid.error());
  const auto [v, a] = start;
  if (!std::isfinite(v)) return refusal(ErrorCode::not_finite, "start speed", v, S(0));
  if (!std::isfinite(a)) return refusal(ErrorCode::not_finite, "start acceleration", a, S(0));
  const S settled = settled_speed(start, limits);
  constexpr S own_rounding = S(16) * std::numeric_limits<S>::epsilon();
  if (v >= S(0) && std::abs(a) <= most * (S(1) + own_rounding) && settled >= -own_rounding * v) return start;
  const S rounding = speed_rounding(start, limits);
  if (v < -rounding) return refusal(ErrorCode::negative, "start speed", v, S(0));
  if (std::abs(a) > most * (S(1) + share_rounding<S>))
    return refusal(ErrorCode::above_limit, "start acceleration", a, most);
  const S held = std::clamp(a, -most, most);
  const S lost = -settled_speed({S(0), held}, limits);
  if (v - lost < -rounding) return refusal(ErrorCode::below_limit, "start acceleration", a, settled);
  return BasicStartState<S>{std::max({v, lost, S(0)}), held};
}

}  // namespace detail

/// To rest as soon as the limits allow, wherever that is: what a feed hold does. The profile's length is the
/// distance that it takes. Any state of a profile is accepted, to rounding: see `from_state`. Errors: a state
/// that is not finite, goes backwards, or must come to do so, or whose acceleration is beyond its limit.
template <std::floating_point S>
[[nodiscard]] Expected<BasicProfile<S>> stop(const BasicStartState<S>& start, const BasicLimits<S>& limits) {
  const auto state = detail::check(start, limits, limits.acceleration);
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

/// The fastest motion from a state to an end speed (zero acceleration) over exactly `length` mm, going
/// forward all the time. A start beyond the limits returns to them as fast as the other limits allow:
/// acceleration first, then a speed that is above V, or that passes V before its acceleration can end
/// (`settled_speed` above V): `peak()` tells. Only what no forward motion can do is refused.
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
/// hardly any acceleration left may also step, by up to 4 v sqrt(eps v / J): what it takes to make up for
/// the rounding of v.
///
/// Closed forms: see `BasicExtremals`. Errors: as `stop`, but for an acceleration beyond its limit; as the
/// other solvers; `end_speed_unreachable`, where the length is too short, with the bound that they give. A
/// slower end speed than the bound, rest among them, may be reachable again: the shortest way does not always
/// grow as its end speed falls.
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
      : length_(length), start_(start), end_(end_velocity), limits_(limits) {}

  [[nodiscard]] Expected<BasicProfile<S>> solve() const {
    if (const auto exact = fitting()) return *exact;
    const BasicStartState<S> near = nearer();
    if (const auto moved = FromState(length_, near, end_, limits_).fitting()) return *moved;
    if (const auto rounded = directly(near)) return *rounded;
    return refusal(ErrorCode::end_speed_unreachable, "end speed", end_, reachable());
  }

 private:
  // The fastest forward motion: a profile as long as told, if there is one.
  [[nodiscard]] std::optional<BasicProfile<S>> fitting() const {
    const BasicAxisLimits<S> forward{.velocity_up = limits_.velocity,
                                     .velocity_down = S(0),
                                     .acceleration_up = limits_.acceleration,
                                     .acceleration_down = limits_.acceleration,
                                     .jerk = limits_.jerk};
    const BasicTransfer<S> transfer({S(0), start_.velocity, start_.acceleration}, {length_, end_, S(0)},
                                    forward);
    const auto first = transfer.first();
    if (!std::isfinite(first.duration)) return {};
    return transfer.with_phases(first.extremal, first.sign,
                                [&](const auto&... phases) { return profile_of(phases...); });
  }

  // Nine phases as two ramps and a cruise. Where the return to the limits brakes for a while, or its jerk is
  // opposite to what follows, that is let go behind it; else both are one phase.
  using JerkPhase = BasicJerkPhase<S>;
  [[nodiscard]] BasicProfile<S> profile_of(const JerkPhase& forced, const JerkPhase& braked,
                                           const JerkPhase& rise, const JerkPhase& held,
                                           const JerkPhase& let_go, const JerkPhase& cruise,
                                           const JerkPhase& fall, const JerkPhase& held_last,
                                           const JerkPhase& let_go_last) const {
    const bool opposite = forced.duration > S(0) && forced.jerk * rise.jerk < S(0);
    BasicRamp<S> up{forced.duration, braked.duration, rise.duration, rise.acceleration, forced.jerk};
    if (!(rise.duration > S(0) && (braked.duration > S(0) || opposite)))
      up = {forced.duration + rise.duration, braked.duration + held.duration, let_go.duration,
            held.acceleration, forced.duration > S(0) ? forced.jerk : rise.jerk};
    BasicAxisState<S> top{S(0), start_.velocity, start_.acceleration};
    for (const auto* phase : {&forced, &braked, &rise, &held, &let_go})
      top = phase->after(top, phase->duration);
    return BasicProfile<S>({.length = length_,
                            .start_velocity = start_.velocity,
                            .start_acceleration = start_.acceleration,
                            .top_velocity = cruise.duration > S(0) ? limits_.velocity : top.velocity,
                            .end_velocity = end_,
                            .cruise = cruise.duration,
                            .up = up,
                            .down = {fall.duration, held_last.duration, let_go_last.duration,
                                     held_last.acceleration, fall.jerk}});
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

  // The end speed nearest to the wanted one, on the way to it, that the length allows. Where the acceleration
  // is held, the length is quadratic in the time of that. Where it is not, the start is moved back to where
  // the acceleration is zero: from there, with the time x to the peak, it is (2 v + J x^2) x.
  [[nodiscard]] S reachable() const {
    const S settled = std::max(settled_speed(start_, limits_), S(0));
    const S sign = end_ < settled ? S(-1) : S(1);
    const S most = sign * limits_.acceleration;
    if (!std::isfinite(limits_.jerk))
      return std::sqrt(std::max(start_.velocity * start_.velocity + S(2) * most * length_, S(0)));
    const S jerk = sign * limits_.jerk;
    const S moved = start_.acceleration / jerk;
    const S rise = limits_.acceleration / limits_.jerk;
    const BasicRamp<S> full{std::abs(rise - moved), S(0), rise, most, moved > rise ? -jerk : jerk};
    const S at_full = start_.velocity + ((start_.acceleration + most) * full.first + most * rise) / S(2);
    if (sign * (end_ - at_full) >= S(0))
      if (const S left = length_ - distance(start_, full); left >= S(0)) {
        const S slope = at_full + most * rise / S(2);
        const S root = std::sqrt(std::max(slope * slope + S(2) * most * left, S(0)));
        return std::max(at_full + most * (S(2) * left / (slope + root)), S(0));
      }
    const S speed = start_.velocity - jerk * moved * moved / S(2);
    const S length = length_ + moved * (speed + jerk * moved * moved / S(6));
    const auto excess = [&](S x) {
      return std::array<S, 3>{x * (S(2) * speed + jerk * x * x) - length, S(2) * speed + S(3) * jerk * x * x,
                              S(6) * jerk * x};
    };
    const S least = std::max(moved, S(0));
    const S longest = std::max(least, std::sqrt(std::max((end_ - speed) / jerk, S(0))));
    if (!(excess(least)[0] < S(0))) return settled;
    S guess = speed > S(0) ? length / (S(2) * speed) : longest;
    if (sign > S(0) && length > S(0)) guess = std::min(guess, rough_cube_root(length / jerk));
    const S x = bracketed_root(excess, least, longest, std::clamp(guess, least, longest));
    return std::max(speed + jerk * x * x, S(0));
  }

  S length_;
  BasicStartState<S> start_;
  S end_;
  BasicLimits<S> limits_;
};

}  // namespace detail

template <std::floating_point S>
Expected<BasicProfile<S>> from_state(std::type_identity_t<S> length, const BasicStartState<S>& start,
                                     std::type_identity_t<S> end_velocity, const BasicLimits<S>& limits) {
  const auto state = detail::check(start, limits, std::numeric_limits<S>::infinity());
  if (!state) return tl::unexpected(state.error());
  const auto check = [](S value, S bound, std::string_view field) -> Expected<void> {
    if (!std::isfinite(value)) return refusal(ErrorCode::not_finite, field, value, S(0));
    if (value < S(0)) return refusal(ErrorCode::negative, field, value, S(0));
    if (value > bound) return refusal(ErrorCode::above_limit, field, value, bound);
    return {};
  };
  const bool behind = length < S(0) && length >= -detail::length_rounding(S(0), *state, limits);
  const S ahead = behind ? S(0) : length;
  if (auto ok = check(ahead, std::numeric_limits<S>::max(), "length"); !ok) return tl::unexpected(ok.error());
  if (auto ok = check(end_velocity, limits.velocity, "end speed"); !ok) return tl::unexpected(ok.error());
  return detail::FromState<S>(ahead, *state, end_velocity, limits).solve();
}

}  // namespace cncplan::profile
