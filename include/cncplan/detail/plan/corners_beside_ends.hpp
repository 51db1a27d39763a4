// Corners next to an end of travel, where a curve would leave it (set-up).
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory_resource>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cncplan/block.hpp"
#include "cncplan/detail/block_checks.hpp"
#include "cncplan/detail/curve/smooth_pieces.hpp"
#include "cncplan/machine.hpp"

namespace cncplan::detail {

/// Whether the pieces of a plan stay in the travel: a path along an end of it may be smoothed beyond it, and
/// one under a map to where that jumps.
template <class Pieces, class Run, MachineModel M>
[[nodiscard]] bool stays_in_travel(const Pieces& pieces, const Run& run, const M& machine) {
  const bool ends = has_ends(machine);
  if (!ends && !MappedModel<M>) return true;
  std::optional<VectorN<typename M::Scalar, M::axis_count>> end;
  return std::all_of(pieces.begin(), pieces.end(), [&](const auto& piece) {
    const auto path = run.piece(piece.path, piece.block, piece.from);
    if constexpr (MappedModel<M>)
      if (!goes_on(end, path, machine)) return false;
    return !ends || within_travel(path, machine).has_value();
  });
}

/// Where the curve of a run leaves the travel, the motion rests at the nearer corner; where it does so
/// already, the block is driven exactly. The run is planned anew then.
class CornersBesideEnds {
 public:
  explicit CornersBesideEnds(std::pmr::memory_resource* memory) : leaving_(memory), blocks_(memory) {}

  /// Finds where the pieces of a plan leave the travel. `sources`: of all blocks, those of the run.
  template <class Pieces, class Run, class Sources, BlockModel B, MachineModel M>
  void find(const Pieces& pieces, const Run& run, const Sources& sources, std::span<B> all,
            const M& machine) {
    leaving_.clear();
    if (MappedModel<M>) return;
    for (const auto& [path, block, from] : pieces) {
      const auto piece = run.piece(path, block, from);
      if (within_travel(piece, machine)) continue;
      const std::size_t own = sources[block];
      const bool at_start = 2 * from + piece.length() < all[own].path.length();
      const bool last = block + 1 == sources.size();
      const std::pair at{at_start && block > 0 ? sources[block - 1] : own,
                         at_start || last ? own : sources[block + 1]};
      if (leaving_.empty() || leaving_.back() != at) leaving_.push_back(at);
    }
  }

  /// Has blocks rest where a plan has left the travel. Whether that may help: in a run of `count` blocks that
  /// leaves it at many corners, the level `fast` is as good. `first`: the program's number of the first
  /// block.
  template <BlockModel B>
  bool rest(std::span<B> blocks, std::size_t count, std::size_t first) {
    constexpr std::size_t few = 8, share = 16;
    if (leaving_.empty() || leaving_.size() > few + count / share) return false;
    std::erase_if(blocks_, [first](std::size_t block) { return block < first; });  // a stream has no end
    for (const auto& [before, behind] : leaving_) {
      if (before == behind || blocks[before].exact_stop)
        blocks[behind].exact_path = true;
      else
        blocks[before].exact_stop = true;
      for (const std::size_t block : {before, behind})
        if (!has(first + block)) blocks_.push_back(first + block);
    }
    return true;
  }
  /// Whether a block of the program has such a corner.
  [[nodiscard]] bool has(std::size_t block) const {
    return std::ranges::find(blocks_, block) != blocks_.end();
  }
  [[nodiscard]] std::size_t size() const { return blocks_.size(); }

 private:
  // The blocks before and behind a corner; one and the same where the run begins or ends there.
  std::pmr::vector<std::pair<std::size_t, std::size_t>> leaving_;
  std::pmr::vector<std::size_t> blocks_;  // by the program's numbers
};

}  // namespace cncplan::detail
