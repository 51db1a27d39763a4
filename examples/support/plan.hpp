// A planned program: pieces of the axes' path, end to end, and when each is driven.
#pragma once

#include <fmt/format.h>

#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "cncplan/cncplan.hpp"
#include "support/failure.hpp"

namespace support {

struct Plan {
  std::vector<double> lengths;  ///< of each piece
  std::vector<cncplan::plan::BlockCaps> caps;
  std::vector<cncplan::plan::Span> spans;
  std::vector<cncplan::plan::BlockTiming> timings;
  double duration = 0.0;
  double length = 0.0;
};

/// Adds up what follows from caps and spans.
inline Plan plan_of(std::vector<cncplan::plan::BlockCaps> caps, std::vector<cncplan::plan::Span> spans) {
  Plan plan;
  plan.caps = std::move(caps);
  plan.spans = std::move(spans);
  for (const auto& block : plan.caps) plan.lengths.push_back(block.length);
  cncplan::plan::block_timings(std::span<const cncplan::plan::Span>(plan.spans),
                               std::span<const double>(plan.lengths), std::back_inserter(plan.timings));
  for (const auto& span : plan.spans) {
    plan.length += span.profile.length();
    plan.duration += span.profile.duration();
  }
  return plan;
}

/// Ramps that cross pieces. Throws `Failure`.
template <class Factory>
std::vector<cncplan::plan::Span> spans_of(const std::vector<cncplan::plan::BlockCaps>& caps,
                                          const Factory& factory) {
  std::vector<cncplan::plan::Span> spans;
  std::vector<cncplan::plan::Gate> gates(caps.size() + 1);
  const auto planned = cncplan::plan::plan_spans(std::span<const cncplan::plan::BlockCaps>(caps), factory,
                                                 std::span(gates), std::back_inserter(spans));
  if (!planned)
    throw Failure(Exit::other,
                  fmt::format("planning: {} {}", planned.error().field, message(planned.error().code)));
  return spans;
}

}  // namespace support
