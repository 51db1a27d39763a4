// Planning as KK22 published it.
#pragma once

#include <iterator>
#include <span>
#include <vector>

#include "cncplan/cncplan.hpp"
#include "experiments.hpp"

namespace kk22 {

using MillTrajectory = cncplan::Trajectory<cncplan::Machine<3>, cncplan::Block<3>>;

/// One profile of five phases a block, at the junction speeds of Table 3.
inline MillTrajectory published_plan(const std::vector<cncplan::Block<3>>& blocks) {
  namespace plan = cncplan::plan;
  namespace published = cncplan::published;
  const plan::JointRules<double, published::JunctionTable> rules{{}, -1.0, -1.0};  // the table alone
  const auto cells = plan::make_cells<published::WholeBlocks>(std::span(blocks), mill, rules).value();
  std::vector<double> speeds(cells.caps.size() + 1);
  std::vector<plan::Span> spans;
  published::plan_blocks(std::span<const plan::BlockCaps>(cells.caps), plan::FivePhase{}, std::span(speeds),
                         std::back_inserter(spans))
      .value();
  return {mill, blocks, plan::block_phases(std::span<const plan::Span>(spans), cells)};
}

}  // namespace kk22
