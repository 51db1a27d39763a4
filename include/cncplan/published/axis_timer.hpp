// YO04's scheme: every axis steps from a timer of its own, of one period for the whole move.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>

#include "cncplan/core/error.hpp"
#include "cncplan/step/edge.hpp"

namespace cncplan::published {

/// Steps per turn behind a gear: YO04 Eq. 2 with the ratio as it is, not rounded. 48 steps behind 78/18 *
/// 54/14 are 802.2857 (printed: 802.08, from 16.71).
template <std::floating_point S>
[[nodiscard]] constexpr S geared_steps(S steps_per_turn, S ratio) {
  return steps_per_turn * ratio;
}

/// Steps per mm of a drum that moves its circumference (mm, > 0) with each turn.
template <std::floating_point S>
[[nodiscard]] constexpr S drum_steps_per_unit(S steps_per_turn, S circumference) {
  return steps_per_turn / circumference;
}

/// The angle of a chord of length `chord` (YO04: the sensitivity) in a circle, rad; chord and radius in mm,
/// 0 < chord <= 2 radius.
template <std::floating_point S>
[[nodiscard]] S chord_angle(S chord, S radius) {
  return S(2) * std::asin(chord / (S(2) * radius));
}

/// Chords of that length in a full circle (YO04: N = 360 / angle); not a whole number in general.
template <std::floating_point S>
[[nodiscard]] S chords_per_circle(S chord, S radius) {
  return S(2) * std::numbers::pi_v<S> / chord_angle(chord, radius);
}

/// The steps of one axis in one move, evenly in time (YO04: T_k = t / steps_k). The timer interrupts twice a
/// pulse, at every half period: the signal rises half a period after the start and falls with the period's
/// end. On a straight move of whole steps at one speed these are the exact crossings. An `EdgeSource`.
template <std::floating_point S>
class AxisTimer {
 public:
  using Scalar = S;

  /// From `start` (s), `distance` (signed, mm or rad) at `steps_per_unit`, within `duration` (s). Errors: a
  /// number of steps that is not finite or beyond `step::most_steps`, a duration that is not positive though
  /// there are steps to take.
  [[nodiscard]] static Expected<AxisTimer> make(int axis, S distance, S steps_per_unit, S duration,
                                                S start = S(0)) {
    const S exact = distance * steps_per_unit;
    constexpr S most = static_cast<S>(step::most_steps);
    if (!(std::abs(exact) <= most))
      return refusal(std::isfinite(exact) ? ErrorCode::above_limit : ErrorCode::not_finite, "steps", exact,
                     most);
    const std::int64_t steps = step::count_at(exact);
    if (steps != 0 && !(duration > S(0))) return refusal(ErrorCode::not_positive, "duration", duration);
    return AxisTimer(axis, steps, duration, start);
  }

  /// Steps of the move, signed.
  [[nodiscard]] std::int64_t steps() const { return steps_; }
  /// s between steps; infinite where there are none.
  [[nodiscard]] S period() const {
    return steps_ == 0 ? std::numeric_limits<S>::infinity() : duration_ / static_cast<S>(std::abs(steps_));
  }

  [[nodiscard]] std::optional<step::BasicEdge<S>> next() {
    if (taken_ == std::abs(steps_)) return std::nullopt;
    const S time = start_ + (static_cast<S>(taken_) + S(0.5)) * period();
    ++taken_;
    return step::BasicEdge<S>{time, axis_, steps_ < 0 ? -1 : 1};
  }

 private:
  AxisTimer(int axis, std::int64_t steps, S duration, S start)
      : axis_(axis), steps_(steps), duration_(duration), start_(start) {}

  int axis_;
  std::int64_t steps_;
  std::int64_t taken_ = 0;
  S duration_;
  S start_;
};

/// Time of a move (s): its length (mm) at a feed (mm/s).
template <std::floating_point S>
[[nodiscard]] constexpr S move_time(S length, S feed) {
  return length / feed;
}

}  // namespace cncplan::published
