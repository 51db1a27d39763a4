// Motion along a path as a list of phases of constant jerk, of any number (set-up).
#pragma once

#include <algorithm>
#include <concepts>
#include <span>
#include <utility>
#include <vector>

#include "cncplan/core/phase.hpp"
#include "cncplan/core/state.hpp"

namespace cncplan {

/// Phases one behind another, over a length in mm. Their times and positions count from the profile's start.
/// There is one phase at least.
template <std::floating_point S>
class BasicPhaseProfile {
 public:
  using Scalar = S;

  BasicPhaseProfile(std::vector<BasicPhase<S>> phases, S length)
      : phases_(std::move(phases)), length_(length) {}

  [[nodiscard]] S length() const { return length_; }
  [[nodiscard]] S duration() const { return phases_.back().time + phases_.back().duration; }
  [[nodiscard]] std::span<const BasicPhase<S>> phases() const& { return phases_; }
  void phases() const&& = delete;

  /// The state at a time, s; before the start that of the start, behind the end that of the end.
  [[nodiscard]] BasicState<S> at(S time) const {
    const BasicPhase<S>& phase = last_from(time, &BasicPhase<S>::time);
    return phase.at(std::clamp(time - phase.time, S(0), phase.duration));
  }

  /// The first time at which a position is reached, mm from the start of the path.
  [[nodiscard]] S time_at(S position) const {
    const BasicPhase<S>& phase = last_from(position, &BasicPhase<S>::position);
    return phase.time + phase.tau_at(position);
  }

 private:
  [[nodiscard]] const BasicPhase<S>& last_from(S value, S BasicPhase<S>::*of) const {
    const auto behind = std::upper_bound(phases_.begin() + 1, phases_.end(), value,
                                         [of](S x, const BasicPhase<S>& phase) { return x < phase.*of; });
    return *(behind - 1);
  }

  std::vector<BasicPhase<S>> phases_;
  S length_{};
};

using PhaseProfile = BasicPhaseProfile<double>;

}  // namespace cncplan
