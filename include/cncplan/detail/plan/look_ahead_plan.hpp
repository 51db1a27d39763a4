// Plans blocks by look-ahead, at the levels `exact` and `fast` of smoothing (set-up).
#pragma once

#include <concepts>
#include <cstddef>
#include <iterator>
#include <memory_resource>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cncplan/core/progress.hpp"
#include "cncplan/detail/curve/merge_lines.hpp"
#include "cncplan/detail/plan/add_fallback.hpp"
#include "cncplan/detail/speed/cells.hpp"
#include "cncplan/detail/speed/motion_table.hpp"
#include "cncplan/detail/speed/span_planner.hpp"
#include "cncplan/junction/deviation.hpp"
#include "cncplan/junction/stop_at_corners.hpp"
#include "cncplan/plan_options.hpp"
#include "cncplan/profile/laws.hpp"
#include "cncplan/program_error.hpp"
#include "cncplan/trajectory.hpp"

namespace cncplan::detail {

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

/// Why a program of blocks cannot be smoothed at any level, if it cannot.
template <MachineModel M, BlockModel B>
[[nodiscard]] constexpr std::optional<FallbackReason> without_smoothing() {
  if (!EnclosedPath<typename B::Path>) return FallbackReason::path;
  return std::nullopt;
}

/// The trajectory of blocks that were cut into cells, under a law for changes of speed. All memory is that of
/// the blocks.
template <MachineModel M, BlockModel B, profile::RampLaw<typename M::Scalar> Law>
[[nodiscard]] Expected<Trajectory<M, B>, ProgramError> trajectory(
    std::pmr::vector<B> blocks, const M& machine, const BasicCells<typename M::Scalar>& cells, const Law& law,
    BasicSmoothing<typename M::Scalar, M::axis_count> smoothing = {}) {
  using S = typename M::Scalar;
  std::pmr::memory_resource* const memory = blocks.get_allocator().resource();
  std::pmr::vector<BasicSpan<S>> spans(memory);
  std::pmr::vector<BasicConstrainedJunction<S>> junctions(cells.segment_limits.size() + 1, memory);
  const auto planned = plan_spans(std::span<const BasicSegmentLimits<S>>(cells.segment_limits), law,
                                  std::span(junctions), std::back_inserter(spans));
  if (!planned) return tl::unexpected(ProgramError{{planned.error(), 0, 0, {}}});
  auto phases = block_phases(std::span<const BasicSpan<S>>(spans), cells);
  return Trajectory<M, B>(machine, std::move(blocks), std::move(phases), std::move(smoothing));
}

/// The blocks on both sides of rests for the sake of the travel, which are driven as programmed there.
template <BlockModel B, std::floating_point S, int N>
[[nodiscard]] std::pmr::vector<Fallback> rests_for_travel(std::span<const B> blocks,
                                                          const BasicSmoothing<S, N>& smoothing,
                                                          std::pmr::memory_resource* memory) {
  std::pmr::vector<Fallback> beside(memory);
  std::size_t last = 0;  // that moves
  for (std::size_t i = 0; i < smoothing.blocks.size(); ++i) {
    if (!(blocks[i].path.length() > S(0))) continue;
    if (smoothing.blocks[i].rests_for_travel)
      for (std::size_t block = last; block <= i; ++block)
        add_fallback(beside, block, SmoothLevel::exact, FallbackReason::travel);
    last = i;
  }
  return beside;
}

/// Whether the options ask for curves of their own in place of corrections: at the levels `good` and `best`,
/// and under a map at the level `fast` too, which has no corrections there.
template <MachineModel M>
[[nodiscard]] bool has_curves(const PlanOptions& options) {
  return level_of(options) > (MappedModel<M> ? SmoothLevel::exact : SmoothLevel::fast);
}

/// Blocks that it may change and keep, at the level `exact` or `fast`. All memory is theirs. Under a map the
/// level `fast` is the exact path too, at rest where the tool or a joint turns.
template <MachineModel M, BlockModel B>
[[nodiscard]] Expected<Trajectory<M, B>, ProgramError> plan_by_look_ahead(std::pmr::vector<B>&& blocks,
                                                                          const M& machine,
                                                                          const PlanOptions& options,
                                                                          const Progress& progress = {}) {
  using S = typename M::Scalar;
  std::pmr::memory_resource* const memory = blocks.get_allocator().resource();
  if (const auto ok = validate(machine); !ok) return tl::unexpected(ProgramError{{ok.error(), 0, 0, {}}});
  const auto deviation = static_cast<S>(options.junction_deviation);
  const junction::BasicDeviation<S> rounded{deviation};
  const BasicJunctionRules<S> rules{rounded, deviation, static_cast<S>(options.rotary_tolerance)};
  const SmoothLevel asked = level_of(options);
  const std::span<const B> given(blocks);
  std::pmr::vector<Fallback> fallbacks(memory);
  BasicSmoothing<S, M::axis_count> smoothing(memory);
  constexpr double smoothed = 0.5, cut_up = 0.9;  // of the work that is done then, about
  const auto cut = [&] {
    const double from = asked == SmoothLevel::exact ? 0.0 : smoothed;
    return make_cells(given, machine, rules, smoothing, memory, progress.part(from, cut_up));
  };
  Expected<BasicCells<S>, BlockFault> cells = tl::unexpected(BlockFault{});
  const auto other = without_smoothing<M, B>();
  if constexpr (MappedModel<M>) {
    // mm and rad: derivatives that differ by rounding cost nothing, and at a corner no axis jumps by more
    // than some 1e-8 of a unit a second.
    constexpr S rounding = S(1e-18);
    const junction::BasicStopAtCorners<S> stop;
    const BasicJunctionRules<S> at_rest{stop, rounding, rounding};
    if (asked != SmoothLevel::exact && !other) {
      cells = make_cells(given, machine, at_rest, smoothing, memory, progress.part(0.0, cut_up));
      if (!cells) return tl::unexpected(error_in(given, cells.error()));
      return trajectory(std::move(blocks), machine, *cells, profile::SevenPhase{});
    }
  }
  if (asked == SmoothLevel::exact || other) {
    cells = cut();
    if (asked != SmoothLevel::exact && !given.empty())
      fallbacks.push_back({0, given.size() - 1, SmoothLevel::exact, *other});
  } else if constexpr (!MappedModel<M> && !without_smoothing<M, B>()) {
    const auto within = smoothing_rules<S>(options);
    merge_lines(std::span(blocks), machine, within);
    smoothing = detail::smoothing(given, machine, within, memory, progress.part(0.0, smoothed));
    cells = cut();
    fallbacks = rests_for_travel(given, smoothing, memory);
  }
  if (!cells) return tl::unexpected(error_in(given, cells.error()));
  auto planned = trajectory(std::move(blocks), machine, *cells, profile::SevenPhase{}, std::move(smoothing));
  if (!planned) return planned;
  planned->set_level(asked);
  planned->set_fallbacks(std::move(fallbacks));
  return planned;
}

}  // namespace cncplan::detail
