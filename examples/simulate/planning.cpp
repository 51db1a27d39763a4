// Plans a program: caps, then spans, then the timing of each block.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <iterator>

#include "run.hpp"
#include "stopwatch.hpp"
#include "support/failure.hpp"

namespace simulate {

namespace {

using namespace cncplan;
using support::Exit;
using support::Failure;

template <class Rule>
std::vector<plan::BlockCaps> all_caps(const Program& program, const JunctionChoice& policy,
                                      const Rule& rule) {
  std::vector<plan::BlockCaps> caps;
  caps.reserve(program.blocks.size());
  for (std::size_t i = 0; i < program.blocks.size(); ++i)
    caps.push_back(i == 0 ? plan::caps_from_rest(program.blocks[i], rule)
                          : plan::caps(program.blocks[i - 1], program.blocks[i], policy, rule));
  return caps;
}

// Published planning knows limits along the path only; ramps that cross blocks keep the vector sums as well.
std::vector<plan::BlockCaps> all_caps(const Program& program, const Options& options) {
  return options.planning == Planning::block ? all_caps(program, options.junction, plan::CapSpeed{})
                                             : all_caps(program, options.junction, plan::ShareLimits{});
}

std::vector<plan::Span> spans_of(const std::vector<plan::BlockCaps>& caps, const Options& options) {
  std::vector<plan::Span> spans;
  if (options.interpolator == Interpolator::constant) {
    for (std::size_t i = 0; i < caps.size(); ++i) {
      spans.push_back({i, 1, profile::constant_speed(caps[i].length, caps[i].limits.velocity)});
      if (caps[i].pause > 0.0) spans.push_back(plan::pause_span(i + 1, caps[i].pause));
    }
    return spans;
  }
  const auto law =
      options.law == Law::five ? profile::five_phase_solver<double> : profile::seven_phase_solver<double>;
  const auto factory = [law](const Limits& limits) { return law(limits); };
  const std::span<const plan::BlockCaps> blocks(caps);
  const auto out = std::back_inserter(spans);
  std::vector<double> speeds(caps.size() + 1);
  std::vector<plan::Gate> gates(caps.size() + 1);
  const auto planned = options.planning == Planning::block
                           ? plan::plan_blocks(blocks, factory, std::span(speeds), out)
                           : plan::plan_spans(blocks, factory, std::span(gates), out);
  if (!planned)
    throw Failure(Exit::other,
                  fmt::format("planning: {} {}", planned.error().field, message(planned.error().code)));
  return spans;
}

}  // namespace

Plan make_plan(const Program& program, const Options& options, Measures& measures) {
  Plan plan;
  {
    const Stopwatch watch(measures.plan_seconds);
    plan.caps = all_caps(program, options);
    plan.spans = spans_of(plan.caps, options);
  }
  for (const auto& caps : plan.caps) plan.lengths.push_back(caps.length);
  plan::block_timings(std::span<const plan::Span>(plan.spans), std::span<const double>(plan.lengths),
                      std::back_inserter(plan.timings));
  for (const auto& span : plan.spans) {
    plan.length += span.profile.length();
    plan.duration += span.profile.duration();
    const State peak = span.profile.peak();
    measures.peak.velocity = std::max(measures.peak.velocity, peak.velocity);
    measures.peak.acceleration = std::max(measures.peak.acceleration, peak.acceleration);
    measures.peak.jerk = std::max(measures.peak.jerk, peak.jerk);
  }
  for (std::size_t i = 1; i < plan.caps.size(); ++i) {
    const double slower = std::min(program.blocks[i - 1].limits.velocity, program.blocks[i].limits.velocity);
    if (plan.caps[i].entry < slower) ++measures.junctions_limited;
  }
  return plan;
}

}  // namespace simulate
