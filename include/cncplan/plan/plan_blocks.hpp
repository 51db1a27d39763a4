// Plans blocks into a trajectory (set-up).
#pragma once

#include <concepts>
#include <iterator>
#include <memory_resource>
#include <ranges>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "cncplan/junction/deviation.hpp"
#include "cncplan/plan/cells.hpp"
#include "cncplan/plan/laws.hpp"
#include "cncplan/plan/merge_lines.hpp"
#include "cncplan/plan/motion_table.hpp"
#include "cncplan/plan/plan_options.hpp"
#include "cncplan/plan/program_error.hpp"
#include "cncplan/plan/span_planner.hpp"
#include "cncplan/plan/step_edges.hpp"
#include "cncplan/plan/trajectory.hpp"

namespace cncplan {

/// The block type of a range of blocks.
template <class R>
using BlockOf = std::remove_cvref_t<std::ranges::range_value_t<R>>;

namespace plan {

/// The blocks of a range in a vector of their own: moved there where the range is such a vector, of the same
/// memory, that is given away.
template <class R>
[[nodiscard]] std::pmr::vector<BlockOf<R>> own_blocks(R&& blocks, std::pmr::memory_resource* memory) {
  if constexpr (std::same_as<R, std::pmr::vector<BlockOf<R>>>)
    return {std::move(blocks), memory};
  else
    return {std::ranges::begin(blocks), std::ranges::end(blocks), memory};
}

/// A place in a program of blocks, for an error in one of them.
template <BlockModel B>
[[nodiscard]] ProgramError error_in(std::span<const B> blocks, const BlockFault& fault) {
  const B& block = blocks[fault.block];
  return {{fault.error, block.line, block.column, {}}, {}, fault.block};
}

/// The rules for smoothing that a program's options say.
template <std::floating_point S>
[[nodiscard]] SmoothingRules<S> smoothing_rules(const PlanOptions& options) {
  return {static_cast<S>(options.tolerance), static_cast<S>(options.rotary_tolerance),
          options.exact_between_rapids_and_feeds};
}

/// The trajectory of blocks under rules for their joints and a law for changes of speed. All memory is that
/// of the blocks.
template <MachineModel M, BlockModel B, class Policy, RampLaw<typename M::Scalar> Law>
[[nodiscard]] Expected<Trajectory<M, B>, ProgramError> trajectory(
    std::pmr::vector<B> blocks, const M& machine, const JointRules<typename M::Scalar, Policy>& rules,
    const Law& law, BasicSmoothing<typename M::Scalar, M::axis_count> smoothing = {}) {
  using S = typename M::Scalar;
  std::pmr::memory_resource* const memory = blocks.get_allocator().resource();
  const auto cells = make_cells(std::span<const B>(blocks), machine, rules, smoothing, memory);
  if (!cells) return tl::unexpected(error_in(std::span<const B>(blocks), cells.error()));
  std::pmr::vector<BasicSpan<S>> spans(memory);
  std::pmr::vector<BasicWaypoint<S>> waypoints(cells->caps.size() + 1, memory);
  const auto planned = plan_spans(std::span<const BasicBlockCaps<S>>(cells->caps), law, std::span(waypoints),
                                  std::back_inserter(spans));
  if (!planned) return tl::unexpected(ProgramError{{planned.error(), 0, 0, {}}});
  auto phases = block_phases(std::span<const BasicSpan<S>>(spans), *cells);
  return Trajectory<M, B>(machine, std::move(blocks), std::move(phases), std::move(smoothing));
}

/// What `plan_blocks` gives for blocks that it may change and keep. All memory is theirs.
template <MachineModel M, BlockModel B>
[[nodiscard]] Expected<Trajectory<M, B>, ProgramError> plan_own_blocks(std::pmr::vector<B>&& blocks,
                                                                       const M& machine,
                                                                       const PlanOptions& options) {
  using S = typename M::Scalar;
  std::pmr::memory_resource* const memory = blocks.get_allocator().resource();
  if (const auto ok = validate(machine); !ok) return tl::unexpected(ProgramError{{ok.error(), 0, 0, {}}});
  const auto deviation = static_cast<S>(options.junction_deviation);
  const JointRules<S, junction::BasicDeviation<S>> rules{
      {deviation}, deviation, static_cast<S>(options.rotary_tolerance)};
  BasicSmoothing<S, M::axis_count> smoothing(memory);
  if constexpr (EnclosedPath<typename B::Path> && !MappedModel<M>)
    if (options.tolerance > 0) {
      const auto within = smoothing_rules<S>(options);
      merge_lines(std::span(blocks), machine, within);
      smoothing = plan::smoothing(std::span<const B>(blocks), machine, within, memory);
    }
  auto planned = trajectory(std::move(blocks), machine, rules, SevenPhase{}, std::move(smoothing));
  if constexpr (MappedModel<M>)
    if (planned && options.tolerance > 0 && !planned->program().empty())
      planned->set_fallbacks(
          {{{0, planned->program().size() - 1, FallbackLevel::exact, FallbackReason::map}}, memory});
  return planned;
}

}  // namespace plan

/// The fastest motion along blocks, end to end, from rest to rest, such that the tool and each axis keep
/// their limits. Within the tolerance of the options lines are merged and the path is smoothed. Joints that
/// are left exact are passed as fast as ones rounded within the junction deviation would be, where the
/// velocity jumps; under a map all joints are. Plan and trajectory lie in `memory`. Errors: those of
/// `validate` for the machine; a block that leaves the travel of an axis or that no limit bounds.
template <std::ranges::contiguous_range R, MachineModel M>
  requires BlockModel<BlockOf<R>>
[[nodiscard]] Expected<Trajectory<M, BlockOf<R>>, ProgramError> plan_blocks(
    R&& blocks, const M& machine, const PlanOptions& options = {},
    std::pmr::memory_resource* memory = std::pmr::get_default_resource()) {
  return plan::plan_own_blocks(plan::own_blocks(std::forward<R>(blocks), memory), machine, options);
}

/// The same on the exact path, with a policy of one's own for joints (`JunctionPolicy`) and a law for changes
/// of speed.
template <std::ranges::contiguous_range R, MachineModel M, JunctionPolicy<typename M::Scalar> Policy,
          plan::RampLaw<typename M::Scalar> Law = plan::SevenPhase>
  requires BlockModel<BlockOf<R>>
[[nodiscard]] Expected<Trajectory<M, BlockOf<R>>, ProgramError> plan_blocks(R&& blocks, const M& machine,
                                                                            const Policy& policy,
                                                                            const Law& law = {}) {
  using S = typename M::Scalar;
  if (const auto ok = validate(machine); !ok) return tl::unexpected(ProgramError{{ok.error(), 0, 0, {}}});
  const plan::JointRules<S, Policy> rules{policy, S(-1), S(-1)};
  return plan::trajectory(plan::own_blocks(std::forward<R>(blocks), std::pmr::get_default_resource()),
                          machine, rules, law);
}

}  // namespace cncplan
