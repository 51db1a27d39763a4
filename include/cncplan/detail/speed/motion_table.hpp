// When each block of a program runs and how: constant-jerk phases, each within one block (set-up).
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <memory_resource>
#include <span>
#include <vector>

#include "cncplan/core/phase.hpp"
#include "cncplan/detail/speed/cells.hpp"
#include "cncplan/detail/speed/span.hpp"

namespace cncplan::detail {

/// Cuts planned spans of cells into phases that each lie within one block, in the memory that the cells have.
/// Every block that moves has one.
template <std::floating_point S>
[[nodiscard]] std::pmr::vector<BasicPiecePhase<S>> block_phases(std::span<const BasicSpan<S>> spans,
                                                                const BasicCells<S>& cells) {
  std::pmr::vector<BasicPiecePhase<S>> table(cells.segment_limits.get_allocator());
  table.reserve(cells.segment_limits.size() + 7 * spans.size());
  S start = S(0);
  S travelled = S(0);  // of the block that goes on, in the spans before
  S finished = S(0);   // length of the block that was finished last
  auto pause = cells.pauses.begin();
  const auto rest = [&](std::size_t cell) {
    for (; pause != cells.pauses.end() && pause->cells == cell; ++pause) {
      const bool moved = cell > 0 && pause->block == cells.blocks[cell - 1];
      table.push_back({{start, pause->seconds, moved ? finished : S(0), S(0), S(0), S(0)}, pause->block});
      start += pause->seconds;
    }
  };
  rest(0);
  for (const BasicSpan<S>& span : spans) {
    const S duration = span.profile.duration();
    if (span.count == 0) {
      rest(span.first);
      continue;
    }
    const auto phases = span.profile.phases();
    std::size_t phase = 0;
    S time = S(0), position = S(0), origin = -travelled;  // of the block, where the span's position is 0
    const std::size_t end = span.first + span.count;
    for (std::size_t cell = span.first; cell < end; ++cell) {
      const std::size_t block = cells.blocks[cell];
      position += cells.segment_limits[cell].length;
      const bool block_ends = cell + 1 == cells.blocks.size() || cells.blocks[cell + 1] != block;
      if (!block_ends && cell + 1 < end) continue;
      const S until = cell + 1 == end ? duration : std::max(span.profile.time_at(position), time);
      do {
        while (phase + 1 < phases.size() &&
               (phases[phase].duration == S(0) || time >= phases[phase + 1].time))
          ++phase;
        const S next = phase + 1 < phases.size() ? std::min(phases[phase + 1].time, until) : until;
        const BasicState<S> state = phases[phase].at(std::max(time - phases[phase].time, S(0)));
        const S along = std::max(state.position - origin, S(0));
        table.push_back(
            {{start + time, next - time, along, state.velocity, state.acceleration, state.jerk}, block});
        if (!(next > time)) break;
        time = next;
      } while (time < until);
      travelled = block_ends ? S(0) : position - origin;
      if (!block_ends) continue;
      finished = position - origin;
      origin = position;
    }
    start += duration;
  }
  return table;
}

}  // namespace cncplan::detail
