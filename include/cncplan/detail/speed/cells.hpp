// What look-ahead needs to know of a program: cells of its blocks, each with limits along the path (set-up).
#pragma once

#include <concepts>
#include <cstddef>
#include <memory_resource>
#include <span>
#include <vector>

#include "cncplan/core/error.hpp"
#include "cncplan/core/progress.hpp"
#include "cncplan/detail/curve/smoothing.hpp"
#include "cncplan/detail/speed/cell_maker.hpp"
#include "cncplan/detail/speed/segment_limits.hpp"

namespace cncplan::detail {

/// The rest of one block.
template <std::floating_point S>
struct BasicBlockPause {
  std::size_t cells{};  ///< how many cells come before it
  std::size_t block{};
  S seconds{};
};

/// The blocks of a program cut into cells, over each of which one set of limits holds.
template <std::floating_point S>
struct BasicCells {
  std::pmr::vector<BasicSegmentLimits<S>> segment_limits;  ///< of each cell, in order
  std::pmr::vector<std::size_t> blocks;                    ///< to which each belongs
  std::pmr::vector<BasicBlockPause<S>> pauses;  ///< in order; the limits have those behind a cell as a sum

  BasicCells() = default;
  explicit BasicCells(std::pmr::memory_resource* memory)
      : segment_limits(memory), blocks(memory), pauses(memory) {}
};

/// What went wrong with a block.
struct BlockFault {
  Error error;
  std::size_t block{};
};

/// Cuts a program into cells, each block by `Cut`; see `CellMaker`, whose errors these are.
template <template <class, class> class Cut = CutByLimits, MachineModel M, BlockModel B>
[[nodiscard]] Expected<BasicCells<typename M::Scalar>, BlockFault> make_cells(
    std::span<const B> blocks, const M& machine, const BasicJunctionRules<typename M::Scalar>& rules,
    const BasicSmoothing<typename M::Scalar, M::axis_count>& smoothing = {},
    std::pmr::memory_resource* memory = std::pmr::get_default_resource(), const Progress& progress = {}) {
  using S = typename M::Scalar;
  BasicCells<S> cells(memory);
  cells.segment_limits.reserve(blocks.size());
  cells.blocks.reserve(blocks.size());
  const auto rest = [&](std::size_t block, S seconds) {
    if (!(seconds > S(0))) return;
    if (!cells.segment_limits.empty()) cells.segment_limits.back().pause += seconds;
    cells.pauses.push_back({cells.segment_limits.size(), block, seconds});
  };
  CellMaker<M, B, Cut<M, B>> maker(machine, rules);
  const auto tool = tool_axes(machine);
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    constexpr std::size_t seldom = 256;  // blocks: some tens of microseconds, as a rule
    if (i % seldom == 0) progress.reach(static_cast<double>(i) / static_cast<double>(blocks.size()));
    if (const auto ok =
            maker.begin(blocks[i], smoothing.path(blocks[i].path, i, tool), smoothing.junction_mode(i));
        !ok)
      return tl::unexpected(BlockFault{ok.error(), i});
    while (!maker.done()) {
      if (const auto ok = maker.next(); !ok) return tl::unexpected(BlockFault{ok.error(), i});
      const auto& [from, to, limits, inside] = maker.cell().part;
      if (!cells.blocks.empty()) rest(cells.blocks.back(), maker.cell().rest);
      cells.segment_limits.push_back({to - from, maker.cell().entry, limits, S(0), inside});
      cells.blocks.push_back(i);
    }
    rest(i, blocks[i].pause);
  }
  return cells;
}

}  // namespace cncplan::detail
