// Planning as KK22 published it.
#pragma once

#include <iterator>
#include <span>
#include <vector>

#include "cncplan/cncplan.hpp"

namespace kk22 {

/// One profile of five phases a block, at the junction speeds of Table 3.
inline cncplan::plan::Plan published_plan(const std::vector<cncplan::plan::Block>& blocks) {
  namespace plan = cncplan::plan;
  const auto caps = plan::all_caps(blocks, cncplan::published::JunctionTable{}, plan::CapSpeed{});
  std::vector<double> speeds(caps.size() + 1);
  plan::Plan result;
  cncplan::published::plan_blocks(std::span<const plan::BlockCaps>(caps), plan::FivePhase{},
                                  std::span(speeds), std::back_inserter(result.spans))
      .value();
  for (const plan::BlockCaps& block : caps) result.lengths.push_back(block.length);
  for (const plan::Span& span : result.spans) result.duration += span.profile.duration();
  return result;
}

}  // namespace kk22
