#include "phases.hpp"

#include <fmt/format.h>

#include <iterator>

#include "cncplan/detail/speed/span_planner.hpp"
#include "cncplan/profile/five_phase.hpp"
#include "cncplan/profile/seven_phase.hpp"
#include "cncplan/published/block_planning.hpp"
#include "cncplan/published/constant_speed.hpp"
#include "support/failure.hpp"

namespace simulate {

namespace {

namespace published = cncplan::published;

std::vector<cncplan::detail::Span> spans_of(const Options& options,
                                            std::span<const cncplan::detail::SegmentLimits> segments) {
  std::vector<cncplan::detail::Span> spans;
  if (options.interpolator == Interpolator::constant) {
    for (std::size_t i = 0; i < segments.size(); ++i) {
      spans.push_back({i, 1, published::constant_speed(segments[i].length, segments[i].limits.velocity)});
      if (segments[i].pause > 0.0) spans.push_back(cncplan::detail::pause_span(i + 1, segments[i].pause));
    }
    return spans;
  }
  const auto law = options.law == Law::five ? cncplan::profile::five_phase_solver<double>
                                            : cncplan::profile::seven_phase_solver<double>;
  const std::span<const cncplan::detail::SegmentLimits> all(segments);
  const auto refuse = [](const auto& planned) {
    if (!planned)
      throw support::Failure(support::Exit::bad_input, fmt::format("planning: {} {}", planned.error().field,
                                                                   message(planned.error().code)));
  };
  if (options.planning == Planning::block) {
    std::vector<double> speeds(segments.size() + 1);
    refuse(published::plan_blocks(all, law, std::span(speeds), std::back_inserter(spans)));
  } else {
    std::vector<cncplan::detail::ConstrainedJunction> junctions(segments.size() + 1);
    refuse(cncplan::detail::plan_spans(all, law, std::span(junctions), std::back_inserter(spans)));
  }
  return spans;
}

}  // namespace

Phases phases_of(const Options& options, const cncplan::detail::BasicCells<double>& cells) {
  const auto spans = spans_of(options, cells.segment_limits);
  return cncplan::detail::block_phases(std::span<const cncplan::detail::Span>(spans), cells);
}

}  // namespace simulate
