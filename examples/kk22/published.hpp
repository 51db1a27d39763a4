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
  namespace plan = cncplan::plan;
  namespace published = cncplan::published;
  const plan::JointRules<double, published::JunctionTable> rules{{}, -1.0, -1.0};  // the table alone
  const std::span all(blocks);
  const bool planar = lengths == Lengths::planar;
  auto cells = (planar ? plan::make_cells<published::ToolLimits>(all, mill, rules)
                       : plan::make_cells<published::WholeBlocks>(all, mill, rules))
                   .value();
  if (planar) published::to_plane(all, cells);
  std::vector<double> speeds(cells.caps.size() + 1);
  std::vector<plan::Span> spans;
  published::plan_blocks(std::span<const plan::BlockCaps>(cells.caps), plan::FivePhase{}, std::span(speeds),
                         std::back_inserter(spans))
      .value();
  auto phases = plan::block_phases(std::span<const plan::Span>(spans), cells);
  if (planar) published::to_space(all, std::span(phases));
  return {mill, {blocks.begin(), blocks.end()}, std::move(phases)};
}

}  // namespace kk22
