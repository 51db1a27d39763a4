// A whole run of a player, with requests on the way, as the phases of a trajectory (set-up).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "cncplan/core/error.hpp"
#include "cncplan/core/phase.hpp"
#include "cncplan/plan/cells.hpp"
#include "cncplan/plan/motion_table.hpp"
#include "cncplan/plan/player/player.hpp"

namespace cncplan::plan {

/// What is asked of a player, and when.
struct TimedRequest {
  double time{};  ///< s from the start
  std::function<void(Player&)> ask;
};

namespace detail {

// Writes down what a player does: phases, cut where cells begin.
class PlayRecord {
 public:
  PlayRecord(std::span<const PlayedBlock> cells, std::span<const std::size_t> blocks) : cells_(cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const bool same = i > 0 && blocks[i] == blocks[i - 1];
      places_.push_back({blocks[i], same ? places_.back().from + cells[i - 1].caps.length : 0.0});
    }
  }

  /// From a state on, for so long, with the jerk it has.
  void add(const Played& now, double time, double lasts) {
    const bool goes_on = now.velocity > 0.0 || now.jerk == 0.0;  // each motion from rest is one of its own
    if (open_.duration > 0.0 && now.jerk == open_.jerk && goes_on) {
      open_.duration += lasts;
      return;
    }
    close();
    double along = now.along;
    for (auto cell = static_cast<std::size_t>(now.block); cell < cell_; ++cell)  // by rounding still before
      along = std::max(along - cells_[cell].caps.length, 0.0);
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
      const double length = cells_[cell_].caps.length;
      if (cell_ + 1 == cells_.size() || open_.at(open_.duration).position < length + rounding) {
        push(open_);
        break;
      }
      const double tau = open_.tau_at(length);
      const State then = open_.at(tau);
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

  std::span<const PlayedBlock> cells_;
  std::vector<Place> places_;
  std::pmr::vector<BasicPiecePhase<double>> phases_;
  std::size_t cell_ = 0;
  Phase open_{};
};

}  // namespace detail

/// Runs the cells of blocks with a tick each `period` (s, > 0) and looks as far ahead as a controller would;
/// requests, in order of time, come at their exact times. It ends where the program does, where it is
/// stopped, or where it rests and nothing is to come. `blocks` are those of the cells. Error: above_limit for
/// what takes more than `most_ticks`.
[[nodiscard]] inline Expected<std::pmr::vector<BasicPiecePhase<double>>> play(
    std::span<const PlayedBlock> cells, std::span<const std::size_t> blocks,
    std::span<const TimedRequest> requests, double period, double most_ticks = 1e10) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  constexpr std::size_t most_ahead = 8192;  // within a tolerance cells are short
  const std::size_t window = std::clamp<std::size_t>(cells.size(), 1, most_ahead);
  std::vector<PlayedBlock> memory(window + 1);
  std::vector<BlockCaps> ahead(window);
  std::vector<Waypoint> waypoints(window + 1), spare_waypoints(window + 1);
  Player player({memory, ahead, waypoints, spare_waypoints});
  detail::PlayRecord record(cells, blocks);
  double time = 0.0;
  std::int64_t ticks = 1;  // the next one ends at so many periods
  std::size_t fed = 0;
  auto request = requests.begin();
  for (;;) {
    for (; request != requests.end() && request->time <= time; ++request) request->ask(player);
    while (fed < cells.size() && player.push(cells[fed])) ++fed;
    const Played now = player.tick(0.0);  // what is asked for takes effect
    const bool done = fed == cells.size() && player.finished();
    const double lasts = player.until_change();
    if (done || player.stopped() || (std::isinf(lasts) && request == requests.end())) break;
    const double next_request = request != requests.end() ? request->time : infinity;
    if (std::min(time + lasts, next_request) > most_ticks * period)
      return tl::unexpected(Error{ErrorCode::above_limit, "periods", time / period, most_ticks});
    if (std::isinf(lasts))
      ticks = static_cast<std::int64_t>(next_request / period);  // at rest nothing is ticked
    while (!(static_cast<double>(ticks) * period > time)) ++ticks;
    const double next_tick = static_cast<double>(ticks) * period;
    const double due = std::isinf(lasts) ? next_request : std::min(next_tick, next_request);
    const bool edge = lasts < due - time;
    const double step = edge ? lasts : due - time;
    record.add(now, time, step);
    player.tick(step);
    time = edge ? time + step : due;
  }
  return record.finish();
}

/// Cells as a player takes them, of the blocks that they were cut from; `feed_of` gives a block's own feed
/// (mm/s). A rest before anything moves becomes a cell of its own.
template <BlockModel B, std::invocable<const B&> Feed>
[[nodiscard]] std::vector<PlayedBlock> played_blocks(std::span<const B> blocks, BasicCells<double>& cells,
                                                     Feed&& feed_of) {
  if (!cells.pauses.empty() && cells.pauses.front().cells == 0) {
    double rest = 0.0;
    for (const auto& pause : cells.pauses)
      if (pause.cells == 0) rest += pause.seconds;
    cells.caps.insert(cells.caps.begin(), {0.0, 0.0, {1.0, 1.0, 1.0}, rest});
    cells.blocks.insert(cells.blocks.begin(), cells.pauses.front().block);
  }
  std::vector<PlayedBlock> played;
  played.reserve(cells.caps.size());
  for (std::size_t i = 0; i < cells.caps.size(); ++i) {
    const B& block = blocks[cells.blocks[i]];
    const bool more = i + 1 < cells.caps.size();
    played.push_back({.caps = cells.caps[i],
                      .feed = feed_of(block),
                      .rapid = block.rapid,
                      .line = block.line,
                      .goes_on = more && (cells.blocks[i + 1] == cells.blocks[i] || block.goes_on)});
  }
  return played;
}

/// Both at once.
template <BlockModel B, std::invocable<const B&> Feed>
[[nodiscard]] Expected<std::pmr::vector<BasicPiecePhase<double>>> play(std::span<const B> blocks,
                                                                       BasicCells<double> cells,
                                                                       std::span<const TimedRequest> requests,
                                                                       double period, Feed&& feed_of,
                                                                       double most_ticks = 1e10) {
  const auto played = played_blocks(blocks, cells, std::forward<Feed>(feed_of));
  return play(std::span<const PlayedBlock>(played), std::span<const std::size_t>(cells.blocks), requests,
              period, most_ticks);
}

}  // namespace cncplan::plan
