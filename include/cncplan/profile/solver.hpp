// The fastest profile over a length, between two speeds with zero acceleration, under a ramp law.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

#include "cncplan/core/error.hpp"
#include "cncplan/profile/boundary.hpp"
#include "cncplan/profile/detail/peak.hpp"
#include "cncplan/profile/profile.hpp"
#include "cncplan/profile/ramp_law.hpp"

namespace cncplan::profile {

/// Solves many profiles under the same limits: what depends on the limits alone is worked out once.
template <std::floating_point S>
class BasicSolver {
 public:
  using Scalar = S;

  constexpr BasicSolver(const BasicRampLaw<S>& law, S velocity_limit)
      : law_(law), velocity_limit_(velocity_limit) {}

  [[nodiscard]] constexpr const BasicRampLaw<S>& law() const { return law_; }

  /// The profile over `length` mm (>= 0, finite). Errors: a speed limit that is not positive; a length or
  /// speed that is not finite, negative, or above the speed limit, by name; `end_speed_unreachable` with the
  /// wanted end speed as its value and, as its bound, the one nearest to it that can be reached on the way
  /// from the start speed. (Below a wanted lower speed there may be others: a ramp close to a standstill can
  /// be shorter.)
  [[nodiscard]] Expected<BasicProfile<S>> operator()(S length, const BasicBoundarySpeeds<S>& speeds) const {
    const auto [start, end] = speeds;
    if (!(length >= S(0) && length <= std::numeric_limits<S>::max() && std::min(start, end) >= S(0) &&
          start <= velocity_limit_ && end <= velocity_limit_ && velocity_limit_ > S(0)))
      return refuse(length, speeds);

    const S high = std::max(start, end);
    const S low = std::min(start, end);
    const S root_d = std::sqrt(high - low);
    const S room_above = std::sqrt(velocity_limit_ - high);
    const S room_below = std::sqrt(velocity_limit_ - low);
    const S ramps = (high + velocity_limit_) * law_.half_duration(room_above) +
                    (low + velocity_limit_) * law_.half_duration(room_below);
    if (ramps <= length) return assemble(length, speeds, {room_above, room_below});

    const S direct = (high + low) * law_.half_duration(root_d);
    constexpr S rounding = S(4) * std::numeric_limits<S>::epsilon();
    if (!(direct <= length)) {
      if (direct > length + rounding * length) return unreachable(length, speeds);
      return assemble(length, speeds, {S(0), root_d});
    }
    if (length == S(0))
      return BasicProfile<S>(
          {.length = S(0), .start_velocity = start, .top_velocity = start, .end_velocity = end});
    return assemble(length, speeds,
                    peak_between(law_, high, low, root_d, detail::below<S> * length, room_above));
  }

  /// The highest speed to which the motion can change from `start` within `length` (both >= 0), or from which
  /// it can come down to `start`; no higher than the speed limit.
  [[nodiscard]] S reachable_speed(S start, S length) const {
    const S room = std::max(velocity_limit_ - start, S(0));
    if ((start + velocity_limit_) * law_.half_duration(std::sqrt(room)) <= length) return velocity_limit_;
    if (!(length > S(0))) return start;
    // half of a peak between equal speeds over twice the length
    const auto peak =
        peak_between(law_, start, start, S(0), detail::below<S> * S(2) * length, std::sqrt(room));
    const S top = start + peak.from_high * peak.from_high;
    return std::max(start, top - S(4) * std::numeric_limits<S>::epsilon() * top);
  }

 private:
  // The rest of the length is a cruise, reckoned with the ramps as they are rounded, so that all phases
  // together end where they should.
  [[nodiscard]] Expected<BasicProfile<S>> assemble(S length, const BasicBoundarySpeeds<S>& speeds,
                                                   const detail::Peak<S>& peak) const {
    const bool rising = speeds.start <= speeds.end;
    const S top = std::max(speeds.start, speeds.end) + peak.from_high * peak.from_high;
    const BasicRamp<S> up = law_.ramp(rising ? peak.from_low : peak.from_high, top - speeds.start);
    const BasicRamp<S> down = law_.ramp(rising ? peak.from_high : peak.from_low, speeds.end - top);
    const S covered = (speeds.start + top) * (up.first + up.hold / S(2)) +
                      (top + speeds.end) * (down.first + down.hold / S(2));
    return BasicProfile<S>({.length = length,
                            .start_velocity = speeds.start,
                            .start_acceleration = S(0),
                            .top_velocity = top,
                            .end_velocity = speeds.end,
                            .cruise = std::max((length - covered) / top, S(0)),
                            .up = up,
                            .down = down});
  }

  // Names the first of them that is out of its domain.
  [[nodiscard]] Expected<BasicProfile<S>> refuse(S length, const BasicBoundarySpeeds<S>& speeds) const {
    const auto within = [](S value, S bound) { return value >= S(0) && value <= bound; };
    const auto fault = [](S value, S bound, std::string_view field) {
      if (!std::isfinite(value)) return refusal(ErrorCode::not_finite, field, value, S(0));
      if (value < S(0)) return refusal(ErrorCode::negative, field, value, S(0));
      return refusal(ErrorCode::above_limit, field, value, bound);
    };
    if (!(velocity_limit_ > S(0))) {
      const ErrorCode code = std::isnan(velocity_limit_) ? ErrorCode::not_finite : ErrorCode::not_positive;
      return refusal(code, "velocity limit", velocity_limit_, S(0));
    }
    constexpr S longest = std::numeric_limits<S>::max();
    if (!within(length, longest)) return fault(length, longest, "length");
    if (!within(speeds.start, velocity_limit_)) return fault(speeds.start, velocity_limit_, "start speed");
    return fault(speeds.end, velocity_limit_, "end speed");
  }

  // The ramp from `start` to the wanted speed is too long. Over the speeds in between its length grows from
  // 0, and upwards for ever; downwards it may shrink again, but is concave, and at the wanted speed still too
  // long. So exactly one of them has the length, and all nearer to `start` fit. Halving the interval as often
  // as there are digits finds it.
  [[nodiscard]] Expected<BasicProfile<S>> unreachable(S length, const BasicBoundarySpeeds<S>& speeds) const {
    S within = speeds.start;
    S beyond = speeds.end;
    for (int halving = 0; halving < std::numeric_limits<S>::digits; ++halving) {
      const S middle = within + (beyond - within) / S(2);
      (law_.distance(speeds.start, middle) <= length ? within : beyond) = middle;
    }
    return refusal(ErrorCode::end_speed_unreachable, "end speed", speeds.end, within);
  }

  BasicRampLaw<S> law_;
  S velocity_limit_;
};

using Solver = BasicSolver<double>;

}  // namespace cncplan::profile
