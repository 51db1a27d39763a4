#include "playing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "support/failure.hpp"

namespace simulate {

namespace {

using namespace cncplan;

// Looks as far ahead as a controller would.
constexpr std::size_t window = 256;

// Writes down what a player does: phases, cut where pieces begin.
class Record {
 public:
  Record(const std::vector<plan::PlayedBlock>& pieces, support::Plan& plan) : pieces_(pieces), plan_(plan) {}

  /// From a state on, for so long, with the jerk it has.
  void add(const plan::Played& now, double time, double lasts) {
    const bool goes_on = now.velocity > 0.0 || now.jerk == 0.0;  // each motion from rest is one of its own
    if (open_.duration > 0.0 && now.jerk == open_.jerk && goes_on) {
      open_.duration += lasts;
      return;
    }
    close();
    piece_ = static_cast<std::size_t>(now.block);
    double along = now.along;
    for (; piece_ + 1 < plan_.piece_phases.size(); ++piece_)  // by rounding still in the piece before
      along = std::max(along - pieces_[piece_].caps.length, 0.0);
    open_ = {time, lasts, along, now.velocity, now.acceleration, now.jerk};
  }

  void close() {
    for (; open_.duration > 0.0; enter(piece_ + 1)) {
      const double length = pieces_[piece_].caps.length;
      Phase rest = open_;
      if (piece_ + 1 == pieces_.size() || open_.at(open_.duration).position < length + rounding) {
        push(open_);
        break;
      }
      const double tau = open_.tau_at(length);
      const State then = open_.at(tau);
      rest.duration = tau;
      if (tau > 0.0) push(rest);
      open_ = {open_.time + tau, open_.duration - tau, 0.0, std::max(then.velocity, 0.0), then.acceleration,
               open_.jerk};
    }
    open_ = {};
  }

  /// Where each piece's phases begin, for all of them.
  void finish() {
    close();
    enter(pieces_.size());
  }

 private:
  void enter(std::size_t piece) {
    piece_ = piece;
    while (plan_.piece_phases.size() <= piece) plan_.piece_phases.push_back(plan_.phases.size());
  }
  void push(const Phase& phase) {
    enter(piece_);
    plan_.phases.push_back(phase);
  }

  static constexpr double rounding = 1e-10;  // mm

  const std::vector<plan::PlayedBlock>& pieces_;
  support::Plan& plan_;
  std::size_t piece_ = 0;
  Phase open_{};
};

// When a piece is driven, from the first motion in it to the last: rests between are its own.
plan::BlockTiming timing(std::span<const Phase> phases, double entered) {
  plan::BlockTiming timing;
  timing.start = entered;
  bool first = true;
  for (const Phase& phase : phases) {
    const State start = phase.at(0.0);
    State end = phase.at(phase.duration);
    end.velocity = std::max(end.velocity, 0.0);  // rounding, where it comes to rest
    if (!(start.velocity > 0.0 || end.velocity > 0.0)) continue;
    if (first) {
      timing.start = phase.time;
      timing.entry = start;
      first = false;
    }
    timing.duration = phase.time + phase.duration - timing.start;
    timing.exit = end;
    const double top = phase.jerk != 0.0 ? -phase.acceleration / phase.jerk : 0.0;
    timing.peak_velocity = std::max({timing.peak_velocity, start.velocity, end.velocity,
                                     top > 0.0 && top < phase.duration ? phase.at(top).velocity : 0.0});
  }
  return timing;
}

}  // namespace

support::Plan play(const std::vector<plan::PlayedBlock>& pieces, const std::vector<Event>& events,
                   double period) {
  support::Plan plan;
  for (const auto& piece : pieces) {
    plan.caps.push_back(piece.caps);
    plan.lengths.push_back(piece.caps.length);
    plan.length += piece.caps.length;
  }
  std::vector<plan::PlayedBlock> memory(window + 1);
  std::vector<plan::BlockCaps> ahead(window);
  std::vector<plan::Gate> gates(window + 1), spare_gates(window + 1);
  plan::Player player({memory, ahead, gates, spare_gates});
  Record record(pieces, plan);
  constexpr double most_ticks = 1e10;
  double time = 0.0;
  std::int64_t ticks = 1;  // the next one ends at so many periods
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::size_t fed = 0;
  auto event = events.begin();
  plan::Played now{};
  for (;;) {
    for (; event != events.end() && event->time <= time; ++event) ask(player, *event);
    while (fed < pieces.size() && player.push(pieces[fed])) ++fed;
    now = player.tick(0.0);  // what is asked for takes effect
    const bool done = fed == pieces.size() && player.finished();
    const double lasts = player.until_change();
    if (done || player.stopped() || (std::isinf(lasts) && event == events.end())) break;
    const double next_event = event != events.end() ? event->time : infinity;
    if (std::min(time + lasts, next_event) > most_ticks * period)
      throw support::Failure(
          support::Exit::bad_input,
          fmt::format("with its events the program takes more than {:.0e} periods of {:.6g} s", most_ticks,
                      period));
    if (std::isinf(lasts))
      ticks = static_cast<std::int64_t>(next_event / period);  // at rest nothing is ticked
    while (!(static_cast<double>(ticks) * period > time)) ++ticks;
    const double next_tick = static_cast<double>(ticks) * period;
    const double due = std::isinf(lasts) ? next_event : std::min(next_tick, next_event);
    const bool edge = lasts < due - time;
    const double step = edge ? lasts : due - time;
    record.add(now, time, step);
    player.tick(step);
    time = edge ? time + step : due;
  }
  record.finish();
  plan.duration = time;
  const auto last = static_cast<std::size_t>(std::max<std::int64_t>(now.block, 0));
  plan.completed = fed == pieces.size() && player.finished();
  double entered = 0.0;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto phases = plan.phases_of(i);
    plan.timings.push_back(timing(phases, entered));
    if (!phases.empty()) entered = phases.back().time + phases.back().duration;
    if (i < last) plan.end.state.position += plan.lengths[i];
  }
  plan.end.block = last;
  plan.end.along = now.along;
  plan.end.state.position += now.along;
  return plan;
}

}  // namespace simulate
