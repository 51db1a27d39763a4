// Planning as KK22 published it.
#pragma once

#include <iterator>
#include <span>
#include <vector>

#include "cncplan/cncplan.hpp"
#include "experiments.hpp"
#include "table_programs.hpp"

namespace kk22 {

using MillTrajectory = cncplan::Trajectory<cncplan::Machine<3>, MillBlock>;

/// One profile of five phases a block, at the junction speeds of Table 3. By lengths in space the speed is
/// capped by curvature; by lengths in the plane (section 3.1) it is not, as in the paper.
inline MillTrajectory published_plan(const std::vector<MillBlock>& blocks, Lengths lengths) {
  namespace published = cncplan::published;
  const published::JunctionTable table;
  const cncplan::detail::JunctionRules rules{table, -1.0, -1.0};
  const std::span all(blocks);
  const bool planar = lengths == Lengths::planar;
  auto cells = (planar ? cncplan::detail::make_cells<published::ToolLimits>(all, mill, rules)
                       : cncplan::detail::make_cells<published::WholeBlocks>(all, mill, rules))
                   .value();
  if (planar) published::to_plane(all, cells);
  std::vector<double> speeds(cells.segment_limits.size() + 1);
  std::vector<cncplan::detail::Span> spans;
  published::plan_blocks(std::span<const cncplan::detail::SegmentLimits>(cells.segment_limits),
                         cncplan::profile::FivePhase{}, std::span(speeds), std::back_inserter(spans))
      .value();
  auto phases = cncplan::detail::block_phases(std::span<const cncplan::detail::Span>(spans), cells);
  if (planar) published::to_space(all, std::span(phases));
  return {mill, {blocks.begin(), blocks.end()}, std::move(phases)};
}

}  // namespace kk22
