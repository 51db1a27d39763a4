// What the machine asks of a program's motions.
#pragma once

#include "cncplan/cncplan.hpp"
#include "support/machine_file.hpp"

namespace simulate {

using support::Kinematics;
using support::Machine;
using support::MachineAxis;

/// A block's limits on a mill, lowered so that no axis breaks its own.
[[nodiscard]] cncplan::Limits limits_along(const Machine& machine, const cncplan::plan::Block& block);

}  // namespace simulate
