// The value that every profile solver gives: travel along a path in at most seven phases of constant jerk.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>

#include "cncplan/core/phase.hpp"
#include "cncplan/core/state.hpp"

namespace cncplan::profile {

/// A change of speed: jerk for `first`, constant acceleration for `hold`, jerk against that acceleration for
/// `last`. Acceleration and jerk are signed: both negative when it brakes. Only where a ramp begins with more
/// acceleration than it holds have they different signs.
///
///      acceleration     ________
///                      /        \           .
///                _____/          \_____
///                first   hold    last
template <std::floating_point S>
struct BasicRamp {
  S first{};         ///< s
  S hold{};          ///< s
  S last{};          ///< s
  S acceleration{};  ///< mm/s^2, during `hold`
  S jerk{};          ///< mm/s^3, during `first`

  /// mm/s^3, during `last`.
  [[nodiscard]] constexpr S last_jerk() const {
    return jerk != S(0) && (jerk > S(0)) == (acceleration < S(0)) ? jerk : -jerk;
  }
  [[nodiscard]] constexpr S duration() const { return first + hold + last; }

  friend bool operator==(const BasicRamp&, const BasicRamp&) = default;
};

/// A ramp to the top speed, a cruise, a ramp to the end speed, where the acceleration is zero. The first half
/// is evaluated forward from the start and the second backward from the end, so that both ends are exact and
/// rounding meets in the middle. Trivially copyable; the default stands still for no time.
template <std::floating_point S>
class BasicProfile {
 public:
  using Scalar = S;
  using State = BasicState<S>;
  using Phase = BasicPhase<S>;
  using Ramp = BasicRamp<S>;

  static constexpr int phase_count = 7;

  /// All that defines it: mm, s; see the accessors.
  struct Parts {
    S length{};
    S start_velocity{};
    S start_acceleration{};
    S top_velocity{};
    S end_velocity{};
    S cruise{};  ///< s
    Ramp up{};
    Ramp down{};

    friend bool operator==(const Parts&, const Parts&) = default;
  };

  constexpr BasicProfile() = default;
  constexpr explicit BasicProfile(const Parts& parts) : parts_(parts) {}

  [[nodiscard]] constexpr const Parts& parts() const { return parts_; }
  [[nodiscard]] constexpr S length() const { return parts_.length; }
  [[nodiscard]] constexpr S start_velocity() const { return parts_.start_velocity; }
  [[nodiscard]] constexpr S start_acceleration() const { return parts_.start_acceleration; }
  [[nodiscard]] constexpr S end_velocity() const { return parts_.end_velocity; }
  /// Speed of the cruise; the speed between the two ramps where there is none.
  [[nodiscard]] constexpr S top_velocity() const { return parts_.top_velocity; }
  [[nodiscard]] constexpr S duration() const {
    return parts_.up.duration() + parts_.cruise + parts_.down.duration();
  }

  /// The phase table; phases left out have duration zero. Ends of one phase and starts of the next agree to
  /// rounding.
  [[nodiscard]] constexpr std::array<Phase, phase_count> phases() const {
    const auto& [length, start_velocity, start_acceleration, top_velocity, end_velocity, cruise, up, down] =
        parts_;
    const Phase up_first{S(0), up.first, S(0), start_velocity, start_acceleration, up.jerk};
    const Phase up_hold = after(up_first, up.hold, up.acceleration, S(0));
    const Phase up_last = after(up_hold, up.last, up.acceleration, up.last_jerk());
    Phase top = after(up_last, cruise, S(0), S(0));
    top.velocity = top_velocity;
    const Phase end{duration(), S(0), length, end_velocity, S(0), S(0)};
    const Phase down_last = before(end, down.last, down.acceleration, -down.jerk);
    const Phase down_hold = before(down_last, down.hold, down.acceleration, S(0));
    const Phase down_first =
        before(down_hold, down.first, down.acceleration - down.jerk * down.first, down.jerk);
    return {up_first, up_hold, up_last, top, down_first, down_hold, down_last};
  }

  /// State at t; before the start and after the end, the state there.
  [[nodiscard]] constexpr State at(S t) const {
    if (!(t < duration())) return {length(), end_velocity(), S(0), S(0)};
    return state_in(phases(), t);
  }

  /// The first time at which a position is reached; 0 and duration() for positions before and behind the
  /// profile.
  [[nodiscard]] S time_at(S position) const {
    if (!(position > S(0))) return S(0);
    if (!(position < length())) return duration();
    return time_in(phases(), position);
  }

  /// Speed where a position is reached for the first time.
  [[nodiscard]] S velocity_at(S position) const {
    if (!(position > S(0))) return at(S(0)).velocity;
    if (!(position < length())) return end_velocity();
    const auto table = phases();
    const S t = time_in(table, position);
    return t < duration() ? state_in(table, t).velocity : end_velocity();
  }

  /// Largest speed, and largest magnitudes of acceleration and jerk, of all phases.
  [[nodiscard]] constexpr State peak() const {
    State largest{length(), S(0), S(0), S(0)};
    const auto grow = [](S& value, S candidate) { value = std::max(value, std::abs(candidate)); };
    for (const Phase& phase : phases()) {
      if (phase.duration == S(0)) continue;
      const State last = phase.at(phase.duration);
      grow(largest.velocity, phase.velocity);
      grow(largest.velocity, last.velocity);
      if (phase.acceleration > S(0) && last.acceleration < S(0))  // the top lies inside the phase
        grow(largest.velocity, phase.at(-phase.acceleration / phase.jerk).velocity);
      grow(largest.acceleration, phase.acceleration);
      grow(largest.acceleration, last.acceleration);
      grow(largest.jerk, phase.jerk);
    }
    return largest;
  }

  friend bool operator==(const BasicProfile&, const BasicProfile&) = default;

 private:
  // The phase that comes after another, in which acceleration and jerk are as given.
  static constexpr Phase after(const Phase& previous, S duration, S acceleration, S jerk) {
    const State start = previous.at(previous.duration);
    return {previous.time + previous.duration, duration, start.position, start.velocity, acceleration, jerk};
  }

  // The phase that comes before another, with acceleration and jerk as given.
  static constexpr Phase before(const Phase& next, S duration, S acceleration, S jerk) {
    const S velocity = next.velocity - duration * (acceleration + duration * jerk / S(2));
    const S distance =
        duration * (next.velocity - duration * (acceleration / S(2) + duration * (jerk / S(3))));
    return {next.time - duration, duration, next.position - distance, velocity, acceleration, jerk};
  }

  using Table = std::array<Phase, phase_count>;

  static constexpr State state_in(const Table& table, S t) {
    std::size_t index = phase_count - 1;
    while (index > 0 && (t < table[index].time || table[index].duration == S(0))) --index;
    return table[index].at(std::max(t - table[index].time, S(0)));
  }

  static S time_in(const Table& table, S position) {
    std::size_t index = phase_count - 1;
    while (index > 0 && (table[index].duration == S(0) || position < table[index].position)) --index;
    return table[index].time + table[index].tau_at(position);
  }

  Parts parts_{};
};

using Profile = BasicProfile<double>;

}  // namespace cncplan::profile
