// The tool's tip in motion.
#pragma once

#include <concepts>

#include "cncplan/core/vector.hpp"
#include "cncplan/kinematics/tire_mold/tire_mold.hpp"

namespace cncplan::kinematics {

/// Velocity of the tip, mm/s, where the joints stand at `joints` and move at `velocity` (mm/s, rad/s).
template <std::floating_point S>
[[nodiscard]] BasicVector3<S> tip_velocity(const BasicTireMold<S>& machine, const VectorN<S, 4>& joints,
                                           const VectorN<S, 4>& velocity) {
  return machine.jacobian(joints).template topRows<3>() * velocity;
}

}  // namespace cncplan::kinematics
