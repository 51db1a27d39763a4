// Plans in one call, with containers.
#pragma once

#include <iterator>
#include <vector>

#include "cncplan/detail/speed/span_planner.hpp"
#include "cncplan/profile/laws.hpp"
#include "cncplan/published/block_planning.hpp"
#include "support/catch.hpp"

namespace cncplan::test {

/// Fails the test where there is no plan.
template <std::floating_point S, class Law = profile::SevenPhase>
std::vector<detail::BasicSpan<S>> spans_of(const std::vector<detail::BasicSegmentLimits<S>>& blocks,
                                           const Law& law = {}) {
  std::vector<detail::BasicSpan<S>> spans;
  std::vector<detail::BasicConstrainedJunction<S>> junctions(blocks.size() + 1);
  REQUIRE(detail::plan_spans(std::span<const detail::BasicSegmentLimits<S>>(blocks), law,
                             std::span(junctions), std::back_inserter(spans)));
  return spans;
}

/// The same, block by block.
template <std::floating_point S, class Law = profile::SevenPhase>
std::vector<detail::BasicSpan<S>> single_blocks_of(const std::vector<detail::BasicSegmentLimits<S>>& blocks,
                                                   const Law& law = {}) {
  std::vector<detail::BasicSpan<S>> spans;
  std::vector<S> speeds(blocks.size() + 1);
  REQUIRE(published::plan_blocks(std::span<const detail::BasicSegmentLimits<S>>(blocks), law,
                                 std::span(speeds), std::back_inserter(spans)));
  return spans;
}

}  // namespace cncplan::test
