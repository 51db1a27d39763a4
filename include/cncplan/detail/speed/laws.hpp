// The laws that a planner can plan by, for any limits.
#pragma once

#include <concepts>

#include "cncplan/profile/five_phase.hpp"
#include "cncplan/profile/seven_phase.hpp"

namespace cncplan::detail {

/// Makes the solver for given limits: the five- or the seven-phase law.
template <class F, class S>
concept RampLaw = requires(const F& law, const BasicLimits<S>& limits) {
  { law(limits) } -> std::same_as<profile::BasicSolver<S>>;
};

/// KK22's profiles.
struct FivePhase {
  template <std::floating_point S>
  [[nodiscard]] profile::BasicSolver<S> operator()(const BasicLimits<S>& limits) const {
    return profile::five_phase_solver(limits);
  }
};

/// The fastest.
struct SevenPhase {
  template <std::floating_point S>
  [[nodiscard]] profile::BasicSolver<S> operator()(const BasicLimits<S>& limits) const {
    return profile::seven_phase_solver(limits);
  }
};

}  // namespace cncplan::detail
