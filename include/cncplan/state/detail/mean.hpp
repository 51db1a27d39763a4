// The weighted mean of two motions: what lies between two extremes keeps the limits that both keep.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>

#include "cncplan/core/axis_state.hpp"
#include "cncplan/core/detail/jerk_phase.hpp"
#include "cncplan/state/motion.hpp"

namespace cncplan::state {

/// Phases to be passed one after another.
template <std::floating_point S>
class BasicPhaseQueue {
 public:
  using Phase = BasicJerkPhase<S>;

  /// Of those that take time. Without a branch: which ones do is hard to foretell.
  explicit BasicPhaseQueue(const std::same_as<Phase> auto&... phases) {
    static_assert(sizeof...(phases) < std::tuple_size_v<decltype(phases_)>);
    Phase* end = phases_.data();
    ((*end = phases, end += phases.duration > S(0) ? 1 : 0), ...);
    end->duration = S(0);
    count_ = static_cast<std::size_t>(end - phases_.data());
  }

  [[nodiscard]] const Phase* begin() const { return phases_.data(); }
  [[nodiscard]] const Phase* end() const { return phases_.data() + count_; }

 private:
  std::array<Phase, 10> phases_;
  std::size_t count_{};
};

/// Appends `share` of the phases `a` and the rest of the phases `b`, both from one start and of one duration,
/// with one velocity and acceleration at their ends; share in [0, 1]. Positions, velocities and accelerations
/// are means at every instant. Without a branch: whose phase ends first is hard to foretell.
template <std::floating_point S>
void append_mean(const BasicPhaseQueue<S>& a, const BasicPhaseQueue<S>& b, S share, BasicMotion<S>& motion) {
  using Phase = BasicJerkPhase<S>;
  const S rest = S(1) - share;
  const Phase *one = a.begin(), *other = b.begin();
  S one_left = one->duration, other_left = other->duration;
  const auto pass = [](const Phase*& phase, S& left, S time) {
    constexpr S much = std::numeric_limits<S>::max();
    const S stays = left - time;  // exactly 0 where the phase ends
    left = std::max(stays, phase[1].duration - stays * much);
    phase += stays > S(0) ? 0 : 1;
  };
  motion.append_while([&](Phase& phase) {
    if (one == a.end() || other == b.end()) return false;
    const S time = std::min(one_left, other_left);
    phase = {time,
             share * (one->acceleration + one->jerk * (one->duration - one_left)) +
                 rest * (other->acceleration + other->jerk * (other->duration - other_left)),
             share * one->jerk + rest * other->jerk};
    pass(one, one_left, time), pass(other, other_left, time);
    return true;
  });
}

}  // namespace cncplan::state
