// What `plan` does, for the files that define it for one kind of machine each.
#pragma once

#include <algorithm>
#include <memory>
#include <memory_resource>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "cncplan/compiled.hpp"
#include "cncplan/detail/curve/merge_lines.hpp"
#include "cncplan/detail/speed/cells.hpp"
#include "cncplan/gcode/work_coordinates.hpp"
#include "cncplan/plan_blocks.hpp"
#include "cncplan/program_error.hpp"
#include "cncplan/published/block_planning.hpp"
#include "drive_live.hpp"
#include "drive_look_ahead.hpp"
#include "events.hpp"
#include "phases.hpp"
#include "plan.hpp"
#include "planned_on.hpp"
#include "progress.hpp"
#include "stopwatch.hpp"
#include "support/failure.hpp"
#include "support/fallback_lines.hpp"

namespace simulate {

namespace detail {

[[noreturn]] inline void refuse(cncplan::ProgramError error, const std::string& file) {
  error.file = file;
  throw support::Failure(support::Exit::bad_input, cncplan::to_text(error));
}

template <class B, class M>
[[nodiscard]] double requested_speed(const B& block, const M& machine) {
  return cncplan::detail::requested_speed(block, machine, cncplan::length_of(block.path, machine));
}

/// Joints between motions that are slower than the feeds on both sides.
template <class M>
[[nodiscard]] std::size_t count_limited(const cncplan::detail::BasicCells<double>& cells, const M& machine,
                                        const Program<M>& program) {
  std::size_t count = 0;
  for (std::size_t i = 1; i < cells.segment_limits.size(); ++i) {
    const std::size_t before = cells.blocks[i - 1], after = cells.blocks[i];
    if (program.motion_of[before] != program.motion_of[after] &&
        cells.segment_limits[i].entry < std::min(requested_speed(program.blocks[before], machine),
                                                 requested_speed(program.blocks[after], machine)))
      ++count;
  }
  return count;
}

/// Blocks as they are driven, and cut into cells.
template <class M>
[[nodiscard]] cncplan::detail::BasicCells<double> cells_of(
    const Options& options, const M& machine, const Program<M>& program, std::span<const BlockOf<M>> blocks,
    const cncplan::detail::BasicSmoothing<double, M::axis_count>& smoothing) {
  const cncplan::detail::JunctionRules rules{options.junction, options.corner_tolerance,
                                             options.rotary_tolerance * cncplan::gcode::radians_per_degree};
  const bool whole = options.planning == Planning::block || options.interpolator == Interpolator::constant;
  auto cells =
      whole ? cncplan::detail::make_cells<cncplan::published::WholeBlocks>(blocks, machine, rules, smoothing)
            : cncplan::detail::make_cells(blocks, machine, rules, smoothing);
  if (!cells) refuse(cncplan::detail::error_in(blocks, cells.error()), program.file);
  return std::move(*cells);
}

/// Along curves: by the library's own door, or live where there are events.
template <class M>
[[nodiscard]] Plan plan_smooth(const Options& options, const support::Machine& file, const M& machine,
                               const Program<M>& program) {
  using Block = BlockOf<M>;
  cncplan::PlanOptions planning{
      .tolerance = options.tolerance,
      .level = options.level(),
      .rotary_tolerance = options.rotary_tolerance * cncplan::gcode::radians_per_degree};
  auto planned = [&]() -> cncplan::Expected<cncplan::Trajectory<M, Block>, cncplan::ProgramError> {
    if (options.events) {
      const cncplan::LevelExecutorOptions executor;  // by default
      planning.level = std::max(planning.level, cncplan::SmoothLevel::good);
      planning.reserve = executor.reserve;
      planning.hold_factor = executor.hold_factor;
      return drive_live(std::span<const Block>(program.blocks), machine, planning,
                        read_events(*options.events), options.period);
    }
    Progress progress(!options.quiet, 1.0, Progress::Begin::late);
    planning.progress = [&](double share) {
      progress.reach(share);
      return true;
    };
    auto all = cncplan::plan_blocks(program.blocks, machine, planning);
    progress.finish();
    return all;
  }();
  if (!planned) refuse(planned.error(), program.file);
  Plan result;
  result.motion_of = program.motion_of;
  result.junctions_limited = 0;
  result.fallbacks = support::fallback_lines(*planned);
  result.motion = std::make_unique<PlannedOn<M, Block>>(file, std::move(*planned));
  return result;
}

/// On the exact path, or at the level fast.
template <class M>
[[nodiscard]] Plan plan_look_ahead(const Options& options, const support::Machine& file, const M& machine,
                                   const Program<M>& program) {
  using Block = BlockOf<M>;
  using Trajectory = cncplan::Trajectory<M, Block>;
  Plan result;
  result.motion_of = program.motion_of;
  std::pmr::vector<Block> driven(program.blocks.begin(), program.blocks.end());
  typename Trajectory::Smoothing smoothing;
  if constexpr (smoothed_by_corrections<M>)
    if (options.tolerance > 0.0) {
      const cncplan::detail::SmoothingRules<double> within{
          options.tolerance, options.rotary_tolerance * cncplan::gcode::radians_per_degree};
      cncplan::detail::merge_lines(std::span(driven), machine, within);
      smoothing = cncplan::detail::smoothing(std::span<const Block>(driven), machine, within);
    }
  const auto cells = cells_of(options, machine, program, std::span<const Block>(driven), smoothing);
  result.junctions_limited = count_limited(cells, machine, program);
  const auto drive = [&] {
    auto phases =
        drive_look_ahead<M>(options, machine, {program.blocks, driven}, read_events(*options.events));
    if (!phases) refuse(phases.error(), program.file);
    return std::move(*phases);
  };
  Phases phases = options.events ? drive() : phases_of(options, cells);
  auto beside_ends = cncplan::detail::rests_for_travel(std::span<const Block>(driven), smoothing,
                                                       driven.get_allocator().resource());
  Trajectory trajectory(machine, std::move(driven), std::move(phases), std::move(smoothing));
  trajectory.set_fallbacks(std::move(beside_ends));
  result.fallbacks = support::fallback_lines(trajectory);
  result.motion = std::make_unique<PlannedOn<M, Block>>(file, std::move(trajectory),
                                                        options.interpolator == Interpolator::taylor);
  return result;
}

}  // namespace detail

template <class M>
Plan plan(const Options& options, const support::Machine& file, const M& machine, const Program<M>& program) {
  double seconds = 0.0;
  Plan result = [&] {
    const Stopwatch watch(seconds);
    if constexpr (!std::is_same_v<M, Rows>)
      if (options.level() >
          (cncplan::MappedModel<M> ? cncplan::SmoothLevel::exact : cncplan::SmoothLevel::fast))
        return detail::plan_smooth(options, file, machine, program);
    return detail::plan_look_ahead(options, file, machine, program);
  }();
  result.seconds = seconds;
  return result;
}

}  // namespace simulate
