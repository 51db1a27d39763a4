// What `drive_look_ahead` does, for the files that define it for one kind of machine each.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>

#include "ask.hpp"
#include "cncplan/executor.hpp"
#include "cncplan/gcode/work_coordinates.hpp"
#include "drive_look_ahead.hpp"

namespace simulate {

namespace detail {

/// What an executor does, written down as phases, which are cut where blocks begin. Between them it rests.
class PhaseRecord {
 public:
  /// mm, of each block as it is driven.
  explicit PhaseRecord(std::vector<double> lengths) : lengths_(std::move(lengths)) {}

  /// From a state on a block on, for so long, with the jerk it has.
  void add(std::size_t block, const cncplan::State& now, double time, double lasts) {
    const bool goes_on = now.velocity > 0.0 || now.jerk == 0.0;  // each motion from rest is one of its own
    const bool at_once = time - (open_.time + open_.duration) <= same_time;
    if (open_.duration > 0.0 && at_once && now.jerk == open_.jerk && goes_on) {
      open_.duration += lasts;
      return;
    }
    close();
    if (time - end_ > same_time) phases_.push_back({{end_, time - end_, place_, 0.0, 0.0, 0.0}, block_});
    if (block > block_) place_ = 0.0;
    block_ = std::max(block_, block);  // by rounding it may still be before
    open_ = {time, lasts, place_, now.velocity, now.acceleration, now.jerk};
  }

  [[nodiscard]] Phases finish() {
    close();
    return std::move(phases_);
  }

 private:
  static constexpr double same_time = 1e-9;  // s: sums of ticks differ by their rounding

  void close() {
    constexpr double rounding = 1e-10;  // mm
    if (open_.duration > 0.0) end_ = open_.time + open_.duration;
    for (; open_.duration > 0.0; ++block_) {
      const double length = lengths_[block_], end = open_.at(open_.duration).position;
      if (block_ + 1 == lengths_.size() || end < length + rounding) {
        phases_.push_back({open_, block_});
        place_ = std::min(end, length);
        break;
      }
      const double tau = open_.tau_at(length);
      const cncplan::State then = open_.at(tau);
      cncplan::Phase first = open_;
      first.duration = tau;
      if (tau > 0.0) phases_.push_back({first, block_});
      open_ = {open_.time + tau, open_.duration - tau, 0.0, std::max(then.velocity, 0.0), then.acceleration,
               open_.jerk};
    }
    open_ = {};
  }

  std::vector<double> lengths_;
  Phases phases_;
  cncplan::Phase open_{};
  std::size_t block_ = 0;
  double place_ = 0.0;  // mm from the start of the block
  double end_ = 0.0;    // s, of what has been written down
};

}  // namespace detail

template <class M>
cncplan::Expected<Phases, cncplan::ProgramError> drive_look_ahead(const Options& options, const M& machine,
                                                                  const DrivenBlocks<M>& blocks,
                                                                  const std::vector<Event>& events) {
  using Executor = cncplan::Executor<M, 4096, BlockOf<M>>;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const typename Executor::Options how{
      .tolerance = smoothed_by_corrections<M> ? options.tolerance : 0.0,
      .rotary_tolerance = options.rotary_tolerance * cncplan::gcode::radians_per_degree,
      .junction_deviation = std::max(options.corner_tolerance, 0.0),
      .most_override = highest_feed(events)};
  const auto executor = options.corner_tolerance < 0.0
                            ? std::make_unique<Executor>(machine, options.junction, how)
                            : std::make_unique<Executor>(machine, how);
  executor->program_stop(false);
  std::vector<double> lengths;
  for (const BlockOf<M>& block : blocks.driven) lengths.push_back(block.path.length());
  detail::PhaseRecord record(std::move(lengths));
  double time = 0.0;
  std::int64_t ticks = 1;  // the next one ends at so many periods
  std::size_t fed = 0, again = 0;
  for (auto event = events.begin();;) {
    for (; event != events.end() && event->time <= time; ++event) ask(*executor, *event);
    while (fed < blocks.programmed.size() && executor->push(blocks.programmed[fed])) ++fed;
    if (fed == blocks.programmed.size()) executor->end_of_program();
    executor->plan();
    const auto point = executor->tick(0.0);  // what is asked for takes effect
    const double lasts = executor->until_change();
    // Many words in a row take several ticks.
    const bool goes_on = std::isinf(lasts) && executor->state() != cncplan::ExecutorState::held;
    if (goes_on && !executor->finished() && ++again <= blocks.programmed.size()) continue;
    again = 0;
    if (const auto error = executor->error()) return tl::unexpected<cncplan::ProgramError>(*error);
    if (executor->finished() || (std::isinf(lasts) && event == events.end())) break;
    const double next_event = event != events.end() ? event->time : infinity;
    if (std::min(time + lasts, next_event) > most_periods * options.period) refuse_periods(options.period);
    if (std::isinf(lasts)) {  // at rest nothing is ticked
      ticks = static_cast<std::int64_t>(next_event / options.period);
      time = next_event;
      continue;
    }
    while (!(static_cast<double>(ticks) * options.period > time)) ++ticks;
    const double next_tick = static_cast<double>(ticks) * options.period;
    const double due = std::min(next_tick, next_event);
    const bool edge = lasts < due - time;
    const double step = edge ? lasts : due - time;
    record.add(point.block, point.along, time, step);
    executor->tick(step);
    time = edge ? time + step : due;
  }
  return record.finish();
}

}  // namespace simulate
