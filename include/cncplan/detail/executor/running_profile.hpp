// The part of a plan that is being driven: where it is now, at the cost of one phase.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <span>

#include "cncplan/core/phase.hpp"
#include "cncplan/detail/executor/elapsed.hpp"
#include "cncplan/profile/profile.hpp"

namespace cncplan::detail {

/// Phases that follow each other, and a time within them that only grows. Phases of no duration are left out;
/// where there are no others, the last one is where the motion stands.
template <std::floating_point S>
class BasicRunningProfile {
 public:
  static constexpr std::size_t most_phases = profile::BasicProfile<S>::phase_count;

  BasicRunningProfile() = default;
  /// `braking`: seconds from the end speed to rest, which may be asked behind the end.
  explicit BasicRunningProfile(const profile::BasicProfile<S>& profile, S braking = S(0))
      : duration_(profile.duration()), length_(profile.length()) {
    const auto phases = profile.phases();
    // Still within the cruise, where it can be planned anew: a ramp that ends at speed can be 9 % longer than
    // one to rest, and more where it begins in a block of lower limits.
    constexpr S early = S(0.25);
    const S down = duration_ - phases[4].time;
    turn_ = std::max(phases[3].time, phases[4].time - early * std::max(down, braking));
    for (const BasicPhase<S>& phase : phases) append(phase);
    advance(S(0));  // over a phase that is gone by rounding
  }
  /// At most `most_phases`, each with the time at which it starts, and the length of them all.
  BasicRunningProfile(std::span<const BasicPhase<S>> phases, S length) : length_(length) {
    for (const BasicPhase<S>& phase : phases) append(phase);
    if (count_ > 0) duration_ = phases_[count_ - 1].time + phases_[count_ - 1].duration;
    advance(S(0));
  }

  [[nodiscard]] S length() const { return length_; }
  /// Seconds to its end.
  [[nodiscard]] S left() const { return time_.until(duration_); }
  /// Seconds until a profile has to be better, or it leaves its top speed; negative behind that.
  [[nodiscard]] S to_cruise_end() const { return time_.until(turn_); }
  /// Seconds to the end of the phase.
  [[nodiscard]] S to_edge() const {
    return phase_ + 1 < count_ ? time_.until(phases_[phase_ + 1].time) : left();
  }

  void advance(S seconds) {
    time_.add(seconds);
    while (phase_ + 1 < count_ && !(to_edge() > S(0))) ++phase_;
  }

  [[nodiscard]] BasicState<S> state() const {
    const BasicPhase<S>& phase = phases_[phase_];
    BasicState<S> now = phase.at(std::clamp(time_.since(phase.time), S(0), phase.duration));
    now.velocity = std::max(now.velocity, S(0));  // rounding, where it comes to rest
    return now;
  }

  /// Where it ends. Of an empty one, nothing but zeros.
  [[nodiscard]] BasicState<S> end() const {
    const BasicPhase<S>& last = phases_[count_ > 0 ? count_ - 1 : 0];
    return last.at(last.duration);
  }

  /// Speed where a length has been travelled.
  [[nodiscard]] S velocity_at(S position) const {
    std::size_t phase = 0;
    while (phase + 1 < count_ && position >= phases_[phase + 1].position) ++phase;
    return phases_[phase].at(phases_[phase].tau_at(position)).velocity;
  }

 private:
  void append(const BasicPhase<S>& phase) {
    phases_[count_] = phase;  // of no duration: until the next one
    if (phase.duration > S(0)) ++count_;
  }

  std::array<BasicPhase<S>, most_phases> phases_{};
  std::size_t count_ = 0;
  std::size_t phase_ = 0;
  BasicElapsed<S> time_;
  S duration_{};
  S turn_{};
  S length_{};
};

}  // namespace cncplan::detail
