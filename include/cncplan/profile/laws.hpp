// The laws that a planner can plan by, for any limits.
#pragma once

#include <concepts>

#include "cncplan/profile/five_phase.hpp"
#include "cncplan/profile/seven_phase.hpp"

namespace cncplan::profile {

/// Makes the solver for given limits: the five- or the seven-phase law.
template <class F, class S>
concept RampLaw = requires(const F& law, const BasicLimits<S>& limits) {
  { law(limits) } -> std::same_as<BasicSolver<S>>;
};

/// KK22's profiles.
struct FivePhase {
  template <std::floating_point S>
  [[nodiscard]] BasicSolver<S> operator()(const BasicLimits<S>& limits) const {
    return five_phase_solver(limits);
  }
};

/// The fastest.
struct SevenPhase {
  template <std::floating_point S>
  [[nodiscard]] BasicSolver<S> operator()(const BasicLimits<S>& limits) const {
    return seven_phase_solver(limits);
  }
};

}  // namespace cncplan::profile
