// What the levels `good` and `best` of smoothing take of a machine.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "cncplan/core/motion_limits.hpp"
#include "cncplan/fallback.hpp"
#include "cncplan/motion_limits.hpp"
#include "cncplan/step/drive.hpp"
#include "cncplan/tool.hpp"

namespace cncplan::detail {

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
    if (tool_axes(machine) != BasicMotionLimits<S, M::axis_count>::first_axes()) return FallbackReason::axes;
  }
  return std::nullopt;
}

/// What limits curves: the tool's velocity is that of rapids, where they are faster. A run without them keeps
/// that of its feeds.
template <MachineModel M>
[[nodiscard]] auto limits_of_curves(M machine) {
  machine.limits.velocity = std::max(machine.limits.velocity, rapid_speed(machine));
  return motion_limits(machine);
}

}  // namespace cncplan::detail
