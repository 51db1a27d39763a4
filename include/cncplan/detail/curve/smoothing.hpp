// Which junctions of a program are smoothed, and the corrections that do it (set-up).
#pragma once

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

/// Adds to the corrections of a program those that act on a block and are not there yet, and says where its
/// own stand among them. They come from a ring in which each stands twice; `slot` is the place in it of the
/// first one that is not there yet.
template <std::floating_point S, int N>
void add_acting(std::span<const BasicCorrection<S, N>> ring, std::size_t& slot, BasicBlockSmoothing<S>& own,
                std::pmr::vector<BasicCorrection<S, N>>& all) {
  if (own.count == 0) return;
  const auto places = static_cast<std::ptrdiff_t>(ring.size() / 2);
  // Below 0 where some are there; above where the wider one of two at a junction acts on it alone.
  auto ahead = static_cast<std::ptrdiff_t>(own.first) - static_cast<std::ptrdiff_t>(slot);
  if (ahead > places / 2) ahead -= places;
  if (ahead < -places / 2) ahead += places;
  own.first = static_cast<std::size_t>(static_cast<std::ptrdiff_t>(all.size()) + ahead);
  if (own.first + own.count <= all.size()) return;
  const auto more = ring.subspan(slot, own.first + own.count - all.size());
  all.insert(all.end(), more.begin(), more.end());
  slot = (slot + more.size()) % static_cast<std::size_t>(places);
}

/// Leaves out the first and the last corrections of a block that do not reach it; it ends at so many mm.
template <std::floating_point S, int N>
void leave_out_far(std::span<const BasicCorrection<S, N>> all, const LongLength<S>& end,
                   BasicBlockSmoothing<S>& own) {
  const auto reaches = [&](const BasicCorrection<S, N>& one) {
    return one.at + one.support() > own.start && one.at - one.support() < end;
  };
  for (; own.count > 0 && !reaches(all[own.first]); --own.count) ++own.first;
  while (own.count > 0 && !reaches(all[own.first + own.count - 1])) --own.count;
}

/// The corrections of a program. Its junctions are smoothed but for those at rests, at blocks that are to be
/// exact, where the unit of length changes, and where the tool turns back. Blocks go through `SmoothingAhead`
/// as they do in an executor, a merged line as one.
template <MachineModel M, BlockModel B>
  requires EnclosedPath<typename B::Path>
[[nodiscard]] BasicSmoothing<typename M::Scalar, M::axis_count> smoothing(
    std::span<const B> blocks, const M& machine, const SmoothingRules<typename M::Scalar>& rules,
    std::pmr::memory_resource* memory = std::pmr::get_default_resource(), const Progress& progress = {}) {
  using S = typename M::Scalar;
  using Correction = BasicCorrection<S, M::axis_count>;
  constexpr std::size_t kept = std::bit_ceil(4 * most_neighbours + 3);
  std::pmr::vector<SmoothingRoom<M, B, kept, most_neighbours>> room(1, memory);
  SmoothingAhead<M, B> ahead(rules, machine, room.front().memory());
  BasicSmoothing<S, M::axis_count> result(memory);
  result.blocks.resize(blocks.size());
  std::pmr::vector<std::size_t> lines(memory);  // of each line, merged or not, the first block
  // The next block of a merged line.
  const auto next_of = [&](std::size_t i) {
    if (!blocks[i].straight_on) return blocks.size();
    do ++i;
    while (i < blocks.size() && !(blocks[i].path.length() > S(0)));
    return i;
  };
  std::int64_t told = 0;
  std::size_t slot = 0;
  const auto take = [&] {
    for (; told < ahead.known(); ++told) {
      auto own = ahead.of_block(told);
      add_acting(std::span<const Correction>(room.front().corrections), slot, own, result.corrections);
      for (std::size_t i = lines[static_cast<std::size_t>(told)]; i < blocks.size(); i = next_of(i)) {
        result.blocks[i] = own;
        own.start += blocks[i].path.length();
        own.junction_mode = JunctionMode::smooth;
        own.rests_for_travel = false;
        leave_out_far(std::span<const Correction>(result.corrections), own.start, result.blocks[i]);
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
