// The tool's tip in motion.
#pragma once

#include "cncplan/core/concepts.hpp"

namespace cncplan::kinematics {

/// Velocity of the tip, mm/s, where the joints stand at `joints` and move at `velocity` (mm/s, rad/s).
template <Kinematics K>
[[nodiscard]] BasicVector3<typename K::Scalar> tip_velocity(const K& machine,
                                                            const typename K::Joints& joints,
                                                            const typename K::Joints& velocity) {
  return machine.jacobian(joints).template topRows<3>() * velocity;
}

}  // namespace cncplan::kinematics
