// Plans a program: caps, then spans, then the timing of each piece.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "playing.hpp"
#include "run.hpp"
#include "stopwatch.hpp"
#include "support/failure.hpp"

namespace simulate {

namespace {

using namespace cncplan;
using support::Exit;
using support::Failure;

using Caps = std::vector<plan::BlockCaps>;

// Published planning knows limits along the path only; ramps that cross blocks keep the vector sums as well.
Caps block_caps(const Program& program, const Options& options) {
  return options.planning == Planning::block
             ? plan::all_caps(program.blocks, options.junction, plan::CapSpeed{})
             : plan::all_caps(program.blocks, options.junction, plan::ShareLimits{});
}

// A mill's pieces are the program's blocks.
Caps route_caps(const Program& program, const Route<MillPath>& route, const Options& options,
                const Machine& machine) {
  Caps caps = block_caps(program, options);
  slow_reversals(route, machine, caps);
  return caps;
}

// Behind a rotary table, each piece keeps to the limits of its block, and the axes to theirs.
template <plan::JointPath P>
Caps route_caps(const Program& program, const Route<P>& route, const Options& options,
                const Machine& machine) {
  constexpr double default_corner_time = 0.001;
  const Caps of_blocks = block_caps(program, options);
  std::vector<plan::JointBlock<P>> pieces;
  pieces.reserve(route.size());
  std::size_t block = 0;
  const auto end_blocks_before = [&](std::size_t next) {
    for (; block < next; ++block) {
      if (pieces.empty()) continue;
      pieces.back().stop_at_end = pieces.back().stop_at_end || program.blocks[block].stop_at_end;
      pieces.back().pause += program.blocks[block].pause;
    }
  };
  for (const Piece<P>& piece : route) {
    end_blocks_before(piece.block);
    pieces.push_back({piece.path, of_blocks[piece.block].limits.velocity, false, 0.0, piece.block});
  }
  end_blocks_before(program.blocks.size());
  Caps caps;
  plan::joint_caps(std::span<const plan::JointBlock<P>>(pieces),
                   machine.joint_limits<P::Vector::RowsAtCompileTime>(),
                   options.corner_time.value_or(default_corner_time), std::back_inserter(caps));
  for (std::size_t i = 0; i < caps.size(); ++i) {
    const plan::BlockCaps& block_caps = of_blocks[route[i].block];
    caps[i].limits.acceleration = std::min(caps[i].limits.acceleration, block_caps.limits.acceleration);
    caps[i].limits.jerk = std::min(caps[i].limits.jerk, block_caps.limits.jerk);
    if (i > 0 && route[i].block != route[i - 1].block)
      caps[i].entry = std::min(caps[i].entry, block_caps.entry);
  }
  slow_reversals(route, machine, caps);
  return caps;
}

std::vector<plan::Span> spans_of(const Caps& caps, const Options& options) {
  std::vector<plan::Span> spans;
  if (options.interpolator == Interpolator::constant) {
    for (std::size_t i = 0; i < caps.size(); ++i) {
      spans.push_back({i, 1, published::constant_speed(caps[i].length, caps[i].limits.velocity)});
      if (caps[i].pause > 0.0) spans.push_back(plan::pause_span(i + 1, caps[i].pause));
    }
    return spans;
  }
  const auto law =
      options.law == Law::five ? profile::five_phase_solver<double> : profile::seven_phase_solver<double>;
  if (options.planning == Planning::span) return support::spans_of(caps, law);
  std::vector<double> speeds(caps.size() + 1);
  const auto planned = published::plan_blocks(std::span<const plan::BlockCaps>(caps), law, std::span(speeds),
                                              std::back_inserter(spans));
  if (!planned)
    throw Failure(Exit::bad_input,
                  fmt::format("planning: {} {}", planned.error().field, message(planned.error().code)));
  return spans;
}

// The program as the highest override would have it: each block at its feed times `share`, within what the
// machine bears.
Program raised(Program program, const Options& options, const Machine& machine, double share) {
  for (std::size_t i = 0; i < program.blocks.size(); ++i) {
    plan::Block& block = program.blocks[i];
    if (block.kind == junction::Kind::rapid) continue;
    block.limits.velocity =
        std::min({share * program.origins[i].feed, options.limits.velocity, machine.feed_limit});
    if (machine.kinematics == Kinematics::cartesian) block.limits = limits_along(machine, block);
  }
  return program;
}

// The program played: nothing is known of the events before they come, but how far the feed goes.
template <class P>
Plan played(const Program& program, const Route<P>& route, const Options& options, const Machine& machine) {
  const auto events = read_events(*options.events);
  const Caps caps =
      route_caps(raised(program, options, machine, highest_feed(events)), route, options, machine);
  std::vector<plan::PlayedBlock> pieces;
  for (std::size_t i = 0; i < route.size(); ++i) {
    const std::size_t block = route[i].block;
    const Origin& origin = program.origins[block];
    pieces.push_back({.caps = caps[i],
                      .feed = origin.length > 0.0 ? origin.feed : caps[i].limits.velocity,
                      .rapid = program.blocks[block].kind == junction::Kind::rapid,
                      .line = origin.line});
  }
  return play(pieces, events, options.period);
}

State peak_of(const Plan& plan) {
  State peak;
  const auto grow = [&](const State& state) {
    peak.velocity = std::max(peak.velocity, std::abs(state.velocity));
    peak.acceleration = std::max(peak.acceleration, std::abs(state.acceleration));
    peak.jerk = std::max(peak.jerk, std::abs(state.jerk));
  };
  for (const auto& span : plan.spans) grow(span.profile.peak());
  for (const auto& phase : plan.phases)
    for (const double tau : {0.0, phase.duration}) grow(phase.at(tau));
  for (const auto& timing : plan.timings) peak.velocity = std::max(peak.velocity, timing.peak_velocity);
  return peak;
}

}  // namespace

template <class P>
Plan make_plan(const Program& program, const Route<P>& route, const Options& options, const Machine& machine,
               Measures& measures) {
  Plan plan;
  {
    const Stopwatch watch(measures.plan_seconds);
    if (options.events) {
      plan = played(program, route, options, machine);
    } else {
      Caps caps = route_caps(program, route, options, machine);
      std::vector<plan::Span> spans = spans_of(caps, options);
      plan = support::plan_of(std::move(caps), std::move(spans));
    }
  }
  measures.peak = peak_of(plan);
  for (std::size_t i = 1; i < plan.caps.size(); ++i) {
    const std::size_t before = route[i - 1].block, after = route[i].block;
    const double slower =
        std::min(program.blocks[before].limits.velocity, program.blocks[after].limits.velocity);
    if (before != after && plan.caps[i].entry < slower) ++measures.junctions_limited;
  }
  return plan;
}

template Plan make_plan(const Program&, const Route<MillPath>&, const Options&, const Machine&, Measures&);
template Plan make_plan(const Program&, const Route<PolarPath>&, const Options&, const Machine&, Measures&);
template Plan make_plan(const Program&, const Route<RowPath>&, const Options&, const Machine&, Measures&);

}  // namespace simulate
