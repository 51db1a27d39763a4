// The limits of a machine's axes and of its tool in one value.
#pragma once

#include <cstddef>

#include "cncplan/core/motion_limits.hpp"
#include "cncplan/machine.hpp"
#include "cncplan/tool.hpp"

namespace cncplan {

/// The limits of a machine's axes and of its tool, mm s rad, as `time_optimal` takes them. Without a map, a
/// limit of the tool that its axes cannot reach is lowered to what they can.
template <MachineModel M>
[[nodiscard]] BasicMotionLimits<typename M::Scalar, M::axis_count> motion_limits(const M& machine) {
  BasicMotionLimits<typename M::Scalar, M::axis_count> limits;
  limits.tool = machine.limits;
  limits.tool_axes = tool_axes(machine);
  for (std::size_t i = 0; i < limits.axes.size(); ++i)
    limits.axes[i] = {least_velocity(machine.axes[i]), least_acceleration(machine.axes[i]),
                      machine.axes[i].jerk};
  if constexpr (MappedModel<M>) return limits;
  return reachable(limits);
}

}  // namespace cncplan
