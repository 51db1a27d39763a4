// Executors that are driven by a clock (set-up).
#pragma once

#include <cstddef>
#include <memory_resource>

#include "cncplan/detail/executor/given_plan.hpp"
#include "cncplan/detail/executor/live_driver.hpp"
#include "cncplan/executor.hpp"

namespace cncplan::detail {

/// What an executor with a `SmoothLevel` in its options is made of.
template <MachineModel M, BlockModel B>
struct ExecutorLevels {
  using S = typename M::Scalar;
  using Options = BasicExecutorOptions<S, SmoothLevel>;
  using Fast = BasicExecutorOptions<S>;

  [[nodiscard]] static std::pmr::memory_resource* memory() { return std::pmr::get_default_resource(); }

  /// For the level `fast`; the exact path if that is asked for.
  [[nodiscard]] static Fast fast(const Options& options) {
    return {.tolerance = options.level == SmoothLevel::exact ? S(0) : options.tolerance,
            .rotary_tolerance = options.rotary_tolerance,
            .junction_deviation = options.junction_deviation,
            .exact_between_rapids_and_feeds = options.exact_between_rapids_and_feeds,
            .longest_wait = options.longest_wait,
            .quick_stop_share = options.quick_stop_share,
            .background = options.background,
            .reserve = options.reserve,
            .hold_factor = options.hold_factor,
            .most_override = options.most_override,
            .horizon = options.horizon};
  }

  /// Nothing where the level is `fast` at most.
  [[nodiscard]] static LevelDriver<M, B>* make(const M& machine, const Options& options,
                                               std::size_t most_blocks, std::pmr::memory_resource* memory);

  using GivenDriver = LiveDriver<M, B, GivenPlan<M, B>>;
  /// Of a trajectory that is there.
  [[nodiscard]] static GivenDriver* drive(const Trajectory<M, B>& trajectory, const M& machine,
                                          const BasicHoldBound<S>& bound, std::pmr::memory_resource* memory);
};

template <MachineModel M, BlockModel B>
LevelDriver<M, B>* ExecutorLevels<M, B>::make(const M& machine, const Options& options,
                                              std::size_t most_blocks, std::pmr::memory_resource* memory) {
  if (options.level <= SmoothLevel::fast || !(options.tolerance > S(0))) return nullptr;
  PlanOptions plan;
  plan.tolerance = static_cast<double>(options.tolerance);
  plan.level = options.level;
  plan.rotary_tolerance = static_cast<double>(options.rotary_tolerance);
  plan.junction_deviation = static_cast<double>(options.junction_deviation);
  plan.exact_between_rapids_and_feeds = options.exact_between_rapids_and_feeds;
  plan.reserve = static_cast<double>(options.reserve);
  plan.hold_factor = static_cast<double>(options.hold_factor);
  return LiveDriver<M, B>::make(machine, {options.longest_wait, options.background}, memory, plan,
                                most_blocks, options.horizon);
}

template <MachineModel M, BlockModel B>
auto ExecutorLevels<M, B>::drive(const Trajectory<M, B>& trajectory, const M& machine,
                                 const BasicHoldBound<S>& bound, std::pmr::memory_resource* memory)
    -> GivenDriver* {
  return GivenDriver::make(machine, {}, memory, trajectory, bound);
}

}  // namespace cncplan::detail

#ifdef CNCPLAN_COMPILED
#include "cncplan/compiled/executor_levels.hpp"
#endif
