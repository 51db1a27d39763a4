// Seven-phase profiles: time-optimal under speed, acceleration and jerk limits.
#pragma once

#include <type_traits>

#include "cncplan/core/limits.hpp"
#include "cncplan/profile/solver.hpp"

namespace cncplan::profile {

/// Solver of seven-phase profiles under limits that are positive (see `validate`).
template <std::floating_point S>
[[nodiscard]] BasicSolver<S> seven_phase_solver(const BasicLimits<S>& limits) {
  return {seven_phase_law(limits), limits.velocity};
}

/// The fastest profile over `length` mm between two speeds with zero acceleration at both ends: as the
/// five-phase one, but where a ramp would peak above the acceleration limit it holds that limit at full jerk.
/// Domain and errors as there.
template <std::floating_point S = double>
[[nodiscard]] Expected<BasicProfile<S>> seven_phase(std::type_identity_t<S> length,
                                                    const BasicBoundarySpeeds<S>& speeds,
                                                    const BasicLimits<S>& limits) {
  if (auto valid = validate(limits); !valid) return tl::unexpected(valid.error());
  return seven_phase_solver(limits)(length, speeds);
}

}  // namespace cncplan::profile
