// The mill that a program runs on: a machine with the axes X, Y and maybe Z.
#pragma once

#include <string>

#include "cncplan/cncplan.hpp"
#include "support/machine_file.hpp"

namespace simulate {

using support::Machine;
using support::MachineAxis;

struct Travel {
  char letter;
  double low;
  double high;
};

/// Of X, Y or Z; none where there is no such axis.
[[nodiscard]] Travel travel(const Machine& machine, int axis);

/// The block's limits, lowered so that no axis breaks its own.
[[nodiscard]] cncplan::Limits limits_along(const Machine& machine, const cncplan::plan::Block& block);

/// Reads the file of a mill. Throws `Failure`.
[[nodiscard]] Machine read_mill(const std::string& file);

}  // namespace simulate
