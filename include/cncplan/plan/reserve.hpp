// Limits below those of a machine.
#pragma once

#include "cncplan/plan/machine.hpp"

namespace cncplan {

/// The machine with so much less acceleration and jerk, of its tool and of each axis: a share in [0, 1). What
/// is planned for it leaves the clock of an executor of the machine itself something to hold with.
template <MachineModel M>
[[nodiscard]] constexpr M with_reserve(M machine, typename M::Scalar share) {
  const auto lower = [&](auto& limits) {
    limits.acceleration *= 1 - share;
    limits.jerk *= 1 - share;
  };
  lower(machine.limits);
  for (auto& axis : machine.axes) {
    lower(axis);
    axis.acceleration_down *= 1 - share;
  }
  return machine;
}

}  // namespace cncplan
