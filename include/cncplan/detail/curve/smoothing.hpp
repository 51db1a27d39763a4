// Which junctions of a program are smoothed, and the corrections that do it (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

#include "cncplan/block.hpp"
#include "cncplan/core/detail/long_length.hpp"
#include "cncplan/core/progress.hpp"
#include "cncplan/detail/curve/smoothed.hpp"
#include "cncplan/detail/curve/smoothing_ahead.hpp"

namespace cncplan::detail {

/// The corrections of a program, and those of them that act on each block.
template <std::floating_point S, int N>
struct BasicSmoothing {
  using OfBlock = BasicBlockSmoothing<S>;

  std::pmr::vector<BasicCorrection<S, N>> corrections;  ///< in order
  std::pmr::vector<OfBlock> blocks;                     ///< empty where nothing is smoothed

  BasicSmoothing() = default;
  explicit BasicSmoothing(std::pmr::memory_resource* memory) : corrections(memory), blocks(memory) {}

  [[nodiscard]] JunctionMode junction_mode(std::size_t block) const {
    return blocks.empty() ? JunctionMode::exact : blocks[block].junction_mode;
  }
  /// The path that is driven in place of a block's programmed one.
  template <Path P>
  [[nodiscard]] Smoothed<P> path(const P& programmed, std::size_t block,
                                 const std::array<int, 3>& tool) const {
    if (blocks.empty()) return {programmed, {}, 0, tool};
    const OfBlock& own = blocks[block];
    return {programmed, std::span(corrections).subspan(own.first, own.count), own.start, tool};
  }
};

/// The corrections of a program. Its junctions are smoothed but for those at rests, at blocks that are to be
/// exact, where the unit of length changes, and where the tool turns back. Blocks go through `SmoothingAhead`
/// as they do in an executor.
template <MachineModel M, BlockModel B>
  requires EnclosedPath<typename B::Path>
[[nodiscard]] BasicSmoothing<typename M::Scalar, M::axis_count> smoothing(
    std::span<const B> blocks, const M& machine, const SmoothingRules<typename M::Scalar>& rules,
    std::pmr::memory_resource* memory = std::pmr::get_default_resource(), const Progress& progress = {}) {
  using S = typename M::Scalar;
  constexpr std::size_t kept = std::bit_ceil(4 * most_neighbours + 3);
  std::pmr::vector<SmoothingRoom<M, B, kept, most_neighbours>> room(1, memory);
  SmoothingAhead<M, B> ahead(rules, machine, room.front().memory());
  BasicSmoothing<S, M::axis_count> result(memory);
  result.blocks.resize(blocks.size());
  std::pmr::vector<std::size_t> lines(memory);  // the first block of each, where a line is merged or not
  // The next block of a merged line.
  const auto next_of = [&](std::size_t i) {
    if (!blocks[i].straight_on) return blocks.size();
    do ++i;
    while (i < blocks.size() && !(blocks[i].path.length() > S(0)));
    return i;
  };
  std::int64_t told = 0;
  const std::span corrections(room.front().corrections);  // each of them stands there twice
  std::size_t slot = 0;                                   // of the next one
  const auto take = [&] {
    for (; told < ahead.known(); ++told) {
      auto own = ahead.of_block(told);
      // The wider one of two at a junction acts on blocks on which the one before it does not.
      const auto places = static_cast<std::ptrdiff_t>(corrections.size() / 2);
      auto behind = static_cast<std::ptrdiff_t>(own.first) - static_cast<std::ptrdiff_t>(slot);
      if (behind > places / 2) behind -= places;
      if (behind < -places / 2) behind += places;
      const auto there = static_cast<std::ptrdiff_t>(result.corrections.size());
      const std::ptrdiff_t more = behind + static_cast<std::ptrdiff_t>(own.count);
      if (own.count > 0) own.first = static_cast<std::size_t>(there + behind);
      if (own.count > 0 && more > 0) {
        const auto next = corrections.subspan(slot, static_cast<std::size_t>(more));
        result.corrections.insert(result.corrections.end(), next.begin(), next.end());
        slot = (slot + next.size()) % static_cast<std::size_t>(places);
      }
      for (std::size_t i = lines[static_cast<std::size_t>(told)]; i < blocks.size(); i = next_of(i)) {
        auto& block = result.blocks[i] = own;
        own.start += blocks[i].path.length();
        own.junction_mode = JunctionMode::smooth;
        // Those of the line that reach this block.
        const auto* acting = result.corrections.data() + block.first;
        for (; block.count > 0 && !(acting->at + acting->support() > block.start); --block.count)
          ++acting, ++block.first;
        while (block.count > 0 &&
               !(acting[block.count - 1].at - acting[block.count - 1].support() < own.start))
          --block.count;
      }
    }
  };
  const auto finish = [&] {
    while (ahead.ends()) ahead.work();
    take();
  };
  std::size_t goes_on = 0;  // the block that is part of the last line
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    constexpr std::size_t seldom = 256;  // some milliseconds
    if (i % seldom == 0) progress.reach(static_cast<double>(i) / static_cast<double>(blocks.size()));
    const B& block = blocks[i];
    if (!(block.path.length() > S(0))) {
      if (block.exact_stop || block.pause > S(0)) ahead.end_part();
    } else if (i > 0 && i == goes_on) {
      ahead.extend(block);
      goes_on = next_of(i);
    } else {
      S length = S(0);
      for (std::size_t k = i; k < blocks.size(); k = next_of(k)) length += blocks[k].path.length();
      lines.push_back(i);
      if (!ahead.push(block, machine, length)) {
        finish();
        ahead.push(block, machine, length);
      }
      goes_on = next_of(i);
    }
    finish();
  }
  ahead.end_part();
  finish();
  return result;
}

}  // namespace cncplan::detail
