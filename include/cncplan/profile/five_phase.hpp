// Five-phase profiles as KK22 has them: jerk +J, -J, 0, -J, +J, the acceleration limit by lowered jerk.
#pragma once

#include <type_traits>

#include "cncplan/core/limits.hpp"
#include "cncplan/profile/solver.hpp"

namespace cncplan::profile {

/// Solver of five-phase profiles under limits that are positive (see `validate`).
template <std::floating_point S>
[[nodiscard]] BasicSolver<S> five_phase_solver(const BasicLimits<S>& limits) {
  return {five_phase_law(limits), limits.velocity};
}

/// The five-phase profile over `length` mm between two speeds (KK22 section 3.1, Eq. 14; all four kinds of
/// Fig. 5). Where a ramp would peak above the acceleration limit its jerk is lowered, so that it keeps its
/// shape. Domain: lengths and speeds >= 0, speeds within the limit. Errors: see `BasicSolver`, and
/// `validate(limits)`.
template <std::floating_point S = double>
[[nodiscard]] Expected<BasicProfile<S>> five_phase(std::type_identity_t<S> length,
                                                   const BasicBoundarySpeeds<S>& speeds,
                                                   const BasicLimits<S>& limits) {
  if (auto valid = validate(limits); !valid) return tl::unexpected(valid.error());
  return five_phase_solver(limits)(length, speeds);
}

}  // namespace cncplan::profile
