// Plans blocks at the levels `good` and `best` of smoothing, within the tolerance (set-up).
#pragma once

#include <limits>
#include <memory_resource>
#include <new>
#include <ranges>

#include "cncplan/plan/smooth_stream.hpp"

namespace cncplan {

/// The motion along blocks as `plan_blocks` has it, at a higher level of smoothing: runs of blocks that are
/// smoothed are driven along the fastest curve within their tolerances, at the fastest speed along it, as far
/// as the level searches for it. A run ends at a stop, a pause, a block that is to be exact, a turn by more
/// than 175 degrees, and where the unit of length changes. What belongs to no run is planned as `plan_blocks`
/// does, from rest to rest.
///
/// So is all of the program under a map, where the tool has a limit that is infinite, and one of its axes
/// too, where X Y Z are not the first axes, where backlash takes time, and where the tolerance of the options
/// is 0; blocks that do not move the tool; and a run for which no curve was found, one that leaves the travel
/// of an axis, or one that takes more time. `fallbacks` of the trajectory says so, but for a tolerance of 0.
///
/// Blocks of the trajectory are pieces of those that were given, merged as by `plan_blocks`; `source` says of
/// which. In a run that has rapids and feed moves the tool's velocity may be that of rapids. Errors as for
/// `plan_blocks`; too little of the memory, in which plan and trajectory lie.
template <std::ranges::contiguous_range R, MachineModel M>
  requires BlockModel<BlockOf<R>>
[[nodiscard]] Expected<Trajectory<M, plan::SmoothBlockOf<BlockOf<R>>>, ProgramError> plan_smooth(
    const R& blocks, const M& machine, const PlanOptions& options = {}, SmoothLevel level = SmoothLevel::best,
    std::pmr::memory_resource* memory = std::pmr::get_default_resource()) {
  constexpr std::size_t all = std::numeric_limits<std::size_t>::max();
  SmoothStream<M, BlockOf<R>> stream(machine, options, level, all, memory);
  for (const auto& block : blocks)
    if (const auto ok = stream.push(block); !ok) return tl::unexpected(ok.error());
  if (const auto ok = stream.finish(); !ok) return tl::unexpected(ok.error());
  try {
    return stream.take();
  } catch (const std::bad_alloc&) {
    return tl::unexpected(plan::no_memory());
  }
}

}  // namespace cncplan
