// Plans in one call, with containers.
#pragma once

#include <iterator>
#include <vector>

#include "cncplan/plan/laws.hpp"
#include "cncplan/plan/span_planner.hpp"
#include "cncplan/published/block_planning.hpp"
#include "support/catch.hpp"

namespace cncplan::test {

/// Fails the test where there is no plan.
template <std::floating_point S, class Law = plan::SevenPhase>
std::vector<plan::BasicSpan<S>> spans_of(const std::vector<plan::BasicBlockCaps<S>>& blocks,
                                         const Law& law = {}) {
  std::vector<plan::BasicSpan<S>> spans;
  std::vector<plan::BasicWaypoint<S>> waypoints(blocks.size() + 1);
  REQUIRE(plan::plan_spans(std::span<const plan::BasicBlockCaps<S>>(blocks), law, std::span(waypoints),
                           std::back_inserter(spans)));
  return spans;
}

/// The same, block by block.
template <std::floating_point S, class Law = plan::SevenPhase>
std::vector<plan::BasicSpan<S>> single_blocks_of(const std::vector<plan::BasicBlockCaps<S>>& blocks,
                                                 const Law& law = {}) {
  std::vector<plan::BasicSpan<S>> spans;
  std::vector<S> speeds(blocks.size() + 1);
  REQUIRE(published::plan_blocks(std::span<const plan::BasicBlockCaps<S>>(blocks), law, std::span(speeds),
                                 std::back_inserter(spans)));
  return spans;
}

}  // namespace cncplan::test
