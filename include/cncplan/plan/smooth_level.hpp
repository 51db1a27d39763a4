// The levels `good` and `best` of smoothing: the blocks that they make, the machines that they can plan for.
#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "cncplan/plan/fallback.hpp"
#include "cncplan/plan/machine_block.hpp"
#include "cncplan/plan/tool.hpp"
#include "cncplan/smooth/cubic.hpp"
#include "cncplan/smooth/motion_limits.hpp"
#include "cncplan/step/drive.hpp"

namespace cncplan {

/// A block, or a piece of one along a cubic that stays within its tolerance. The pieces of a block follow
/// each other; the last one has its stop and its pause, the first one its word.
template <std::floating_point S, int N, class... Curves>
struct BasicSmoothBlock : BasicBlock<S, N, Curves..., smooth::BasicCubic<S, N>> {
  std::size_t source{};  ///< the block that it is made of, counted from 0

  friend bool operator==(const BasicSmoothBlock&, const BasicSmoothBlock&) = default;
};

template <int N, class... Curves>
using SmoothBlock = BasicSmoothBlock<double, N, Curves...>;

/// How much work smoothing may be. Beside these there is what `plan_blocks` and `Executor` do, the level
/// `fast` in closed form.
enum class SmoothLevel : std::uint8_t {
  good,  ///< nearly the time of the best, for a small part of its work
  best
};

namespace plan {

/// The kind of block that smoothing makes of blocks of a kind.
template <class B>
struct SmoothBlockType;
template <std::floating_point S, int N, class... Curves>
struct SmoothBlockType<BasicBlock<S, N, Curves...>> {
  using Type = BasicSmoothBlock<S, N, Curves...>;
};
template <class B>
using SmoothBlockOf = typename SmoothBlockType<B>::Type;

/// The limits of a machine as smoothing sees them; none of one behind a map.
template <MachineModel M>
[[nodiscard]] smooth::BasicMotionLimits<typename M::Scalar, M::axis_count> motion_limits(const M& machine) {
  smooth::BasicMotionLimits<typename M::Scalar, M::axis_count> limits;
  if constexpr (MappedModel<M>) return limits;
  limits.tool = machine.limits;
  limits.tool_axes = tool_axes(machine);
  for (std::size_t i = 0; i < limits.axes.size(); ++i)
    limits.axes[i] = {least_velocity(machine.axes[i]), least_acceleration(machine.axes[i]),
                      machine.axes[i].jerk};
  return smooth::reachable(limits);
}

/// Why the levels `good` and `best` cannot plan for a machine, if they cannot: they need finite limits of the
/// tool or of all of its axes, X Y Z as the first axes, and motors whose backlash takes no time. A map has no
/// such plan.
template <MachineModel M>
[[nodiscard]] std::optional<FallbackReason> without_curve_level(const M& machine) {
  using S = typename M::Scalar;
  if constexpr (MappedModel<M>) {
    return FallbackReason::map;
  } else {
    for (const auto& axis : machine.axes)
      for (const auto& drive : axis.motors)
        if (step::backlash_time(drive) > S(0)) return FallbackReason::backlash;
    const auto [velocity, acceleration, jerk] = motion_limits(machine).tool;
    if (!(std::isfinite(velocity) && std::isfinite(acceleration) && std::isfinite(jerk)))
      return FallbackReason::tool_limits;
    if (tool_axes(machine) != smooth::BasicMotionLimits<S, M::axis_count>::first_axes())
      return FallbackReason::axes;
    return std::nullopt;
  }
}

}  // namespace plan

}  // namespace cncplan
