#include "phases.hpp"

#include <fmt/format.h>

#include <iterator>
#include <utility>

#include "ask.hpp"
#include "cncplan/plan/player/play.hpp"
#include "cncplan/plan/span_planner.hpp"
#include "cncplan/profile/five_phase.hpp"
#include "cncplan/profile/seven_phase.hpp"
#include "cncplan/published/block_planning.hpp"
#include "cncplan/published/constant_speed.hpp"
#include "support/failure.hpp"

namespace simulate {

namespace {

namespace plan = cncplan::plan;
namespace published = cncplan::published;

std::vector<plan::Span> spans_of(const Options& options, std::span<const plan::BlockCaps> caps) {
  std::vector<plan::Span> spans;
  if (options.interpolator == Interpolator::constant) {
    for (std::size_t i = 0; i < caps.size(); ++i) {
      spans.push_back({i, 1, published::constant_speed(caps[i].length, caps[i].limits.velocity)});
      if (caps[i].pause > 0.0) spans.push_back(plan::pause_span(i + 1, caps[i].pause));
    }
    return spans;
  }
  const auto law = options.law == Law::five ? cncplan::profile::five_phase_solver<double>
                                            : cncplan::profile::seven_phase_solver<double>;
  const std::span<const plan::BlockCaps> all(caps);
  const auto refuse = [](const auto& planned) {
    if (!planned)
      throw support::Failure(support::Exit::bad_input, fmt::format("planning: {} {}", planned.error().field,
                                                                   message(planned.error().code)));
  };
  if (options.planning == Planning::block) {
    std::vector<double> speeds(caps.size() + 1);
    refuse(published::plan_blocks(all, law, std::span(speeds), std::back_inserter(spans)));
  } else {
    std::vector<plan::Waypoint> waypoints(caps.size() + 1);
    refuse(plan::plan_spans(all, law, std::span(waypoints), std::back_inserter(spans)));
  }
  return spans;
}

}  // namespace

std::pmr::vector<cncplan::BasicPiecePhase<double>> phases_of(const Options& options,
                                                             const plan::BasicCells<double>& cells) {
  const auto spans = spans_of(options, cells.caps);
  return plan::block_phases(std::span<const plan::Span>(spans), cells);
}

std::pmr::vector<cncplan::BasicPiecePhase<double>> played(const Options& options,
                                                          const plan::BasicCells<double>& cells,
                                                          const std::vector<plan::PlayedBlock>& blocks,
                                                          const std::vector<Event>& events) {
  std::vector<plan::TimedRequest> requests;
  for (const Event& event : events)
    requests.push_back({event.time, [&event](plan::Player& player) { ask(player, event); }});
  auto phases =
      plan::play(std::span<const plan::PlayedBlock>(blocks), std::span<const std::size_t>(cells.blocks),
                 std::span<const plan::TimedRequest>(requests), options.period, most_periods);
  if (!phases) refuse_periods(options.period);
  return *phases;
}

}  // namespace simulate
