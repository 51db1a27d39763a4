// Plans blocks into a trajectory (set-up).
#pragma once

#include <concepts>
#include <iterator>
#include <limits>
#include <memory_resource>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "cncplan/core/compiled.hpp"
#include "cncplan/detail/executor/run_brakes.hpp"
#include "cncplan/detail/plan/interruption.hpp"
#include "cncplan/detail/plan/look_ahead_plan.hpp"
#include "cncplan/smooth_stream.hpp"
#include "cncplan/step_edges.hpp"

namespace cncplan {

/// The block type of a range of blocks.
template <class R>
using BlockOf = std::remove_cvref_t<decltype(*std::data(std::declval<R&>()))>;

/// Blocks one behind the other in memory: a vector, an array, a span.
template <class R>
concept BlockRange = BlockModel<BlockOf<R>> && requires(R& blocks) {
  std::size(blocks);
  std::end(blocks);
};

namespace detail {

/// The blocks of a range in a vector of their own: moved there where the range is such a vector, of the same
/// memory, that is given away.
template <class R>
[[nodiscard]] std::pmr::vector<BlockOf<R>> own_blocks(R&& blocks, std::pmr::memory_resource* memory) {
  if constexpr (std::same_as<R, std::pmr::vector<BlockOf<R>>>)
    return {std::move(blocks), memory};
  else
    return {std::begin(blocks), std::end(blocks), memory};
}

/// What `plan_blocks` gives for blocks that it may change and keep. All memory is theirs.
template <MachineModel M, BlockModel B>
[[nodiscard]] Expected<Trajectory<M, B>, ProgramError> plan_own_blocks(std::pmr::vector<B>&& blocks,
                                                                       const M& machine,
                                                                       const PlanOptions& options) {
  using S = typename M::Scalar;
  if (const auto ok = validate(options); !ok) return tl::unexpected(ProgramError{{ok.error(), 0, 0, {}}});
  if constexpr (!without_smoothing<M, B>())
    if (has_curves<M>(options)) {
      constexpr std::size_t all = std::numeric_limits<std::size_t>::max();
      SmoothStream<M, B> stream(machine, options, all, blocks.get_allocator().resource());
      for (const B& block : blocks)
        if (const auto ok = stream.push(block); !ok) return tl::unexpected(ok.error());
      if (const auto ok = stream.finish(); !ok) return tl::unexpected(ok.error());
      return stream.take();
    }
  Listening listening(options, reading_share(options));
  const M planned_for = with_reserve(machine, static_cast<S>(options.reserve));
  std::pmr::memory_resource* const memory = blocks.get_allocator().resource();
  auto planned = plan_by_look_ahead(std::move(blocks), planned_for, options, listening.progress());
  if (!planned || !(options.hold_factor > 0)) return planned;
  if constexpr (!without_smoothing<M, B>()) {
    RunBrakes<M, B> brakes(machine, static_cast<S>(options.hold_factor), memory);
    brakes.plan(*planned, false);
    planned->set_brakes(brakes.brakes(), brakes.longest());
    return planned;
  }
  return tl::unexpected(
      ProgramError{{{ErrorCode::not_supported, "hold factor", options.hold_factor}, 0, 0, {}}});
}

}  // namespace detail

/// The fastest motion along blocks, end to end, from rest to rest, such that the tool and each axis keep
/// their limits. Plan and trajectory lie in `memory`.
///
/// Within the tolerance of the options lines are merged and the path is smoothed, at the level that they ask
/// for: at `fast` by corrections of corners; at `good` and `best` runs of blocks are driven along the fastest
/// curve within their tolerances, at the fastest speed along it, as far as the level searches for it. A run
/// ends at a stop, a pause, a block that is to be exact, a turn by more than 175 degrees, and where the unit
/// of length changes. In a run that has rapids and feed moves the tool's velocity may be that of rapids.
/// Corners that are left exact are passed as fast as ones rounded within the junction deviation would be,
/// where the velocity jumps. Under a map the curve is one in the program's coordinates, the level `fast` is
/// `good`, and what has no curve, as rapids straight in the joints, rests at its corners.
///
/// Where a level cannot be had, a lower one takes its place, and `fallbacks` of the trajectory says where and
/// why: `FallbackReason` lists it. Errors: those of `validate` for the machine and the options; a block that
/// leaves the travel of an axis or that no limit bounds; too little of `memory`; `interrupted`, where the
/// options' `progress` says so.
template <BlockRange R, MachineModel M>
[[nodiscard]] Expected<Trajectory<M, BlockOf<R>>, ProgramError> plan_blocks(
    R&& blocks, const M& machine, const PlanOptions& options = {},
    std::pmr::memory_resource* memory = std::pmr::get_default_resource()) {
  return detail::guarded([&] {
    return detail::plan_own_blocks(detail::own_blocks(std::forward<R>(blocks), memory), machine, options);
  });
}

/// The same on the exact path, with a policy of one's own for junctions (`JunctionPolicy`) and a law for
/// changes of speed.
template <BlockRange R, MachineModel M, JunctionPolicy<typename M::Scalar> Policy,
          profile::RampLaw<typename M::Scalar> Law = profile::SevenPhase>
[[nodiscard]] Expected<Trajectory<M, BlockOf<R>>, ProgramError> plan_blocks(R&& blocks, const M& machine,
                                                                            const Policy& policy,
                                                                            const Law& law = {}) {
  using S = typename M::Scalar;
  if (const auto ok = validate(machine); !ok) return tl::unexpected(ProgramError{{ok.error(), 0, 0, {}}});
  const detail::BasicJunctionRules<S> rules{policy, S(-1), S(-1)};
  auto own = detail::own_blocks(std::forward<R>(blocks), std::pmr::get_default_resource());
  const std::span<const BlockOf<R>> given(own);
  const auto cells = detail::make_cells(given, machine, rules);
  if (!cells) return tl::unexpected(detail::error_in(given, cells.error()));
  return detail::trajectory(std::move(own), machine, *cells, law);
}

}  // namespace cncplan

#ifdef CNCPLAN_COMPILED
#include "cncplan/compiled/plan_blocks.hpp"
#endif
