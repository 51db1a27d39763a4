// A flat program as blocks of the four-axis machine (set-up).
#pragma once

#include <algorithm>
#include <concepts>
#include <optional>
#include <utility>
#include <vector>

#include "cncplan/tire_mold/wall_cutter.hpp"
#include "cncplan/tire_mold/wall_part.hpp"

namespace cncplan::tire_mold {

/// Collects the blocks of a program, flat block by flat block. The table's angle goes on without a jump from
/// one to the next. The sidewall's pieces belong to the caller.
template <std::floating_point S>
class BasicWallProgram {
 public:
  using Block = BasicWallBlock<S>;

  /// Nothing nearer to the artwork's origin than `smallest_radius` (mm, > 0) is mapped. The table's first
  /// angle is the one nearest to `table`, rad: whole turns on it turn the program on.
  BasicWallProgram(const kinematics::BasicSidewall<S>& sidewall, S smallest_radius, S table = S(0))
      : cutter_(sidewall, smallest_radius), table_(table) {}

  [[nodiscard]] const std::vector<Block>& blocks() const { return blocks_; }

  /// The table's least and greatest angle, rad; none without blocks.
  [[nodiscard]] std::optional<std::pair<S, S>> table_range() const {
    std::optional<std::pair<S, S>> range;
    for (const Block& block : blocks_) {
      const auto box = block.path.box();
      range = std::pair(range ? std::min(range->first, box.low[3]) : box.low[3],
                        range ? std::max(range->second, box.high[3]) : box.high[3]);
    }
    return range;
  }

  /// Appends a flat block that begins where the last one ended. One of length zero is a place to stop. A kink
  /// is a stop before it and one behind it. Errors, with nothing appended: those of the cutter.
  Expected<void> append(const cncplan::BasicBlock<S, 3, path::BasicSpline<S, 3>>& flat) {
    parts_.clear();
    if (flat.path.length() > S(0))
      if (auto ok = cutter_.cut(flat.path, parts_); !ok) return ok;
    for (const BasicWallPart<S>& part : parts_) {
      if (part.kink) stop();
      follow_wall(part, table_, [&](const BasicWallPath<S>& path) {
        blocks_.push_back(
            {.path = path, .feed = flat.feed, .rapid = flat.rapid, .line = flat.line, .column = flat.column});
      });
      if (part.kink) stop();
    }
    if (blocks_.empty()) return {};  // before the first motion there is nothing to wait for
    if (flat.exact_stop) stop();
    blocks_.back().pause += flat.pause;
    return {};
  }

 private:
  void stop() {
    if (!blocks_.empty()) blocks_.back().exact_stop = true;
  }

  BasicWallCutter<S> cutter_;
  S table_{};
  std::vector<BasicWallPart<S>> parts_;
  std::vector<Block> blocks_;
};

using WallProgram = BasicWallProgram<double>;

}  // namespace cncplan::tire_mold
