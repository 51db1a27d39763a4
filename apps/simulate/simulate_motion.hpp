// A whole run of a motion executor, with events on the way, as the phases of a trajectory.
#pragma once

#include <concepts>
#include <cstddef>
#include <memory_resource>
#include <span>
#include <utility>
#include <vector>

#include "cncplan/core/error.hpp"
#include "cncplan/detail/executor/block_ring.hpp"
#include "cncplan/detail/speed/cells.hpp"
#include "cncplan/detail/speed/motion_table.hpp"
#include "events.hpp"

namespace simulate {

using cncplan::detail::MotionBlock;

/// Runs the cells of blocks with a tick each `period` (s, > 0) and looks as far ahead as a controller would;
/// events, in order of time, come at their exact times. It ends where the program does, where it is
/// stopped, or where it rests and nothing is to come. `blocks` are those of the cells. Error: above_limit for
/// what takes more than `most_periods`.
[[nodiscard]] cncplan::Expected<std::pmr::vector<cncplan::BasicPiecePhase<double>>> simulate_motion(
    std::span<const MotionBlock> cells, std::span<const std::size_t> blocks, std::span<const Event> events,
    double period);

/// Cells as a motion executor takes them, of the blocks that they were cut from; `feed_of` gives a block's
/// own feed (mm/s). A rest before anything moves becomes a cell of its own.
template <cncplan::BlockModel B, std::invocable<const B&> Feed>
[[nodiscard]] std::vector<MotionBlock> motion_blocks(std::span<const B> blocks,
                                                     cncplan::detail::BasicCells<double>& cells,
                                                     Feed&& feed_of) {
  if (!cells.pauses.empty() && cells.pauses.front().cells == 0) {
    double rest = 0.0;
    for (const auto& pause : cells.pauses)
      if (pause.cells == 0) rest += pause.seconds;
    cells.segment_limits.insert(cells.segment_limits.begin(), {0.0, 0.0, {1.0, 1.0, 1.0}, rest});
    cells.blocks.insert(cells.blocks.begin(), cells.pauses.front().block);
  }
  std::vector<MotionBlock> cells_of_blocks;
  cells_of_blocks.reserve(cells.segment_limits.size());
  for (std::size_t i = 0; i < cells.segment_limits.size(); ++i) {
    const B& block = blocks[cells.blocks[i]];
    const bool more = i + 1 < cells.segment_limits.size();
    cells_of_blocks.push_back({.segment_limits = cells.segment_limits[i],
                               .feed = feed_of(block),
                               .rapid = block.rapid,
                               .line = block.line,
                               .goes_on = more && (cells.blocks[i + 1] == cells.blocks[i] || block.goes_on)});
  }
  return cells_of_blocks;
}

}  // namespace simulate
