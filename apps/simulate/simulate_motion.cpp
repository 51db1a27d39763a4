#include "simulate_motion.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "ask.hpp"
#include "cncplan/core/phase.hpp"
#include "cncplan/detail/executor/motion_executor.hpp"

namespace simulate {

using cncplan::BasicPiecePhase;
using cncplan::Phase;
using cncplan::detail::MotionExecutor;
using cncplan::detail::MotionSetPoint;

namespace {

// Writes down what a motion executor does: phases, cut where cells begin.
class SimulationRecord {
 public:
  SimulationRecord(std::span<const MotionBlock> cells, std::span<const std::size_t> blocks) : cells_(cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const bool same = i > 0 && blocks[i] == blocks[i - 1];
      places_.push_back({blocks[i], same ? places_.back().from + cells[i - 1].segment_limits.length : 0.0});
    }
  }

  /// From a state on, for so long, with the jerk it has.
  void add(const MotionSetPoint& now, double time, double lasts) {
    const bool goes_on = now.velocity > 0.0 || now.jerk == 0.0;  // each motion from rest is one of its own
    if (open_.duration > 0.0 && now.jerk == open_.jerk && goes_on) {
      open_.duration += lasts;
      return;
    }
    close();
    double along = now.along;
    for (auto cell = static_cast<std::size_t>(now.block); cell < cell_; ++cell)  // by rounding still before
      along = std::max(along - cells_[cell].segment_limits.length, 0.0);
    cell_ = std::max(cell_, static_cast<std::size_t>(now.block));
    open_ = {time, lasts, along, now.velocity, now.acceleration, now.jerk};
  }

  [[nodiscard]] std::pmr::vector<BasicPiecePhase<double>> finish() {
    close();
    return std::move(phases_);
  }

 private:
  struct Place {
    std::size_t block;
    double from;  // length of the block before the cell
  };

  void close() {
    for (; open_.duration > 0.0; ++cell_) {
      const double length = cells_[cell_].segment_limits.length;
      if (cell_ + 1 == cells_.size() || open_.at(open_.duration).position < length + rounding) {
        push(open_);
        break;
      }
      const double tau = open_.tau_at(length);
      const cncplan::State then = open_.at(tau);
      Phase first = open_;
      first.duration = tau;
      if (tau > 0.0) push(first);
      open_ = {open_.time + tau, open_.duration - tau, 0.0, std::max(then.velocity, 0.0), then.acceleration,
               open_.jerk};
    }
    open_ = {};
  }
  void push(Phase phase) {
    phase.position += places_[cell_].from;
    phases_.push_back({phase, places_[cell_].block});
  }

  static constexpr double rounding = 1e-10;  // mm

  std::span<const MotionBlock> cells_;
  std::vector<Place> places_;
  std::pmr::vector<BasicPiecePhase<double>> phases_;
  std::size_t cell_ = 0;
  Phase open_{};
};

}  // namespace

cncplan::Expected<std::pmr::vector<BasicPiecePhase<double>>> simulate_motion(
    std::span<const MotionBlock> cells, std::span<const std::size_t> blocks, std::span<const Event> events,
    double period) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr std::size_t most_ahead = 8192;  // within a tolerance cells are short
  const std::size_t window = std::clamp<std::size_t>(cells.size(), 1, most_ahead);
  std::vector<MotionBlock> memory(window + 1);
  std::vector<cncplan::detail::SegmentLimits> ahead(window);
  std::vector<cncplan::detail::ConstrainedJunction> junctions(window + 1), spare_junctions(window + 1);
  MotionExecutor motion_executor({memory, ahead, junctions, spare_junctions});
  SimulationRecord record(cells, blocks);
  double time = 0.0;
  std::int64_t ticks = 1;  // the next one ends at so many periods
  std::size_t fed = 0;
  auto event = events.begin();
  for (;;) {
    for (; event != events.end() && event->time <= time; ++event) ask(motion_executor, *event);
    while (fed < cells.size() && motion_executor.push(cells[fed])) ++fed;
    const MotionSetPoint now = motion_executor.tick(0.0);  // what is asked for takes effect
    const bool done = fed == cells.size() && motion_executor.finished();
    const double lasts = motion_executor.until_change();
    if (done || motion_executor.stopped() || (std::isinf(lasts) && event == events.end())) break;
    const double next_event = event != events.end() ? event->time : infinity;
    if (std::min(time + lasts, next_event) > most_periods * period)
      return tl::unexpected(
          cncplan::Error{cncplan::ErrorCode::above_limit, "periods", time / period, most_periods});
    if (std::isinf(lasts))
      ticks = static_cast<std::int64_t>(next_event / period);  // at rest nothing is ticked
    while (!(static_cast<double>(ticks) * period > time)) ++ticks;
    const double next_tick = static_cast<double>(ticks) * period;
    const double due = std::isinf(lasts) ? next_event : std::min(next_tick, next_event);
    const bool edge = lasts < due - time;
    const double step = edge ? lasts : due - time;
    record.add(now, time, step);
    motion_executor.tick(step);
    time = edge ? time + step : due;
  }
  return record.finish();
}

}  // namespace simulate
