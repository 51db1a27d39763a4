// The machines that the levels `good` and `best` of smoothing can plan for, and their limits.
#pragma once

#include <cmath>
#include <cstddef>
#include <optional>

#include "cncplan/plan/fallback.hpp"
#include "cncplan/plan/machine.hpp"
#include "cncplan/plan/tool.hpp"
#include "cncplan/smooth/motion_limits.hpp"
#include "cncplan/step/drive.hpp"

namespace cncplan::plan {

/// The limits of a machine as smoothing sees them; behind a map those of the tool are not those of its axes.
template <MachineModel M>
[[nodiscard]] smooth::BasicMotionLimits<typename M::Scalar, M::axis_count> motion_limits(const M& machine) {
  smooth::BasicMotionLimits<typename M::Scalar, M::axis_count> limits;
  limits.tool = machine.limits;
  limits.tool_axes = tool_axes(machine);
  for (std::size_t i = 0; i < limits.axes.size(); ++i)
    limits.axes[i] = {least_velocity(machine.axes[i]), least_acceleration(machine.axes[i]),
                      machine.axes[i].jerk};
  if constexpr (MappedModel<M>) return limits;
  return smooth::reachable(limits);
}

/// Why the levels `good` and `best` cannot plan for a machine, if they cannot: they need finite limits of the
/// tool or of all of its axes, X Y Z as the first axes, and motors whose backlash takes no time. Under a map
/// limits and axes are looked at run by run.
template <MachineModel M>
[[nodiscard]] std::optional<FallbackReason> without_curve_level(const M& machine) {
  using S = typename M::Scalar;
  for (const auto& axis : machine.axes)
    for (const auto& drive : axis.motors)
      if (step::backlash_time(drive) > S(0)) return FallbackReason::backlash;
  if constexpr (!MappedModel<M>) {
    const auto [velocity, acceleration, jerk] = motion_limits(machine).tool;
    if (!(std::isfinite(velocity) && std::isfinite(acceleration) && std::isfinite(jerk)))
      return FallbackReason::tool_limits;
    if (tool_axes(machine) != smooth::BasicMotionLimits<S, M::axis_count>::first_axes())
      return FallbackReason::axes;
  }
  return std::nullopt;
}

}  // namespace cncplan::plan
