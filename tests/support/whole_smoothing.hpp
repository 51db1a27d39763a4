// The corrections of a program whose blocks are all there: what those of blocks that come in one by one are
// held against.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "cncplan/detail/curve/smoothing.hpp"
#include "support/fit_sizes.hpp"

namespace cncplan::test {

/// Makes the corrections of a program, one part from rest to rest after the other, with all its blocks at
/// hand.
template <MachineModel M, BlockModel B>
class WholeSmoothing {
 public:
  using S = typename M::Scalar;
  static constexpr int n = M::axis_count;
  using Result = BasicSmoothing<S, n>;

  WholeSmoothing(std::span<const B> blocks, const M& machine, const SmoothingRules<S>& rules)
      : blocks_(blocks), machine_(machine), rules_(rules), axes_(axis_tolerances(machine, rules)) {}

  [[nodiscard]] Result run() {
    result_.blocks.resize(blocks_.size());
    LongLength<S> place{};
    bool rests = true;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      const B& block = blocks_[i];
      auto& own = result_.blocks[i];
      own.start = place;
      if (block.path.length() > S(0)) {
        own.junction_mode =
            rests ? JunctionMode::stop : junction_mode_between(blocks_[last_], block, machine_, rules_);
        if (own.junction_mode != JunctionMode::smooth) finish(place);
        if (rests || !blocks_[last_].straight_on) {
          if (own.junction_mode == JunctionMode::smooth) add_junction(last_, i);
          moving_.push_back(i);
        }
        last_ = i;
        rests = false;
        place += block.path.length();
      }
      rests = rests || block.exact_stop || block.pause > S(0);
    }
    finish(place);
    return std::move(result_);
  }

 private:
  // A line that begins with a block.
  [[nodiscard]] BasicBeside<S> beside(std::size_t first) const {
    S length = blocks_[first].path.length();
    for (std::size_t i = first; i < last_ && blocks_[i].straight_on; ++i)
      length += blocks_[i + 1].path.length();
    return {length, top_limits(blocks_[first], machine_)};
  }

  void add_junction(std::size_t before, std::size_t behind) {
    const S speed = std::min(top_limits(blocks_[before], machine_).velocity,
                             top_limits(blocks_[behind], machine_).velocity);
    for (const auto& jump :
         jumps_between(blocks_[before], blocks_[behind], result_.blocks[behind].start, speed, machine_)) {
      sizings_.push_back(jump);
      junctions_.push_back(moving_.size());
    }
  }

  // Corrections of the part that ends here, and which of its blocks each acts on.
  void finish(LongLength<S> end) {
    if (!sizings_.empty()) {
      set_rooms(end);
      fit_sizes(std::span(sizings_), axes_);
      for (std::size_t i = 0; i < sizings_.size(); ++i) {
        auto& behind = result_.blocks[moving_[junctions_[i]]];
        if (rests_at(i)) behind.junction_mode = JunctionMode::stop;
        if (behind.junction_mode == JunctionMode::stop) continue;  // jumps do no harm at rest
        result_.corrections.push_back({sizings_[i].at, sizings_[i].size, sizings_[i].jump, sizings_[i].step});
        reach_blocks(result_.corrections.size() - 1, junctions_[i]);
      }
      sizings_.clear();
      junctions_.clear();
    }
    moving_.clear();
  }

  [[nodiscard]] LongLength<S> start_of(std::size_t moving, LongLength<S> end) const {
    return moving < moving_.size() ? result_.blocks[moving_[moving]].start : end;
  }

  // Room to the rests on both sides and to the farthest neighbours; the lowest tolerance next to each.
  void set_rooms(LongLength<S> end) {
    for (std::size_t i = 0; i < sizings_.size(); ++i) {
      auto& sizing = sizings_[i];
      const std::size_t at = junctions_[i];  // the block behind
      const std::size_t left = at > most_neighbours ? at - most_neighbours : 0;
      const std::size_t right = std::min(at + most_neighbours, moving_.size());
      sizing.room = std::min(sizing.at - start_of(left, end), start_of(right, end) - sizing.at);
      std::size_t from = left, to = right;
      for (std::size_t k = i; k-- > 0 && from == left && junctions_[k] > left;)
        if (junctions_[k] < at) from = junctions_[k];
      for (std::size_t k = i + 1; k < sizings_.size() && to == right && junctions_[k] < right; ++k)
        if (junctions_[k] > at) to = junctions_[k];
      sizing.tolerance = std::numeric_limits<S>::infinity();
      for (std::size_t k = from; k < to; ++k) {
        const B& block = blocks_[moving_[k]];
        sizing.tolerance = std::min(sizing.tolerance, tolerance_of(block, rules_));
        sizing.left = std::min(sizing.left, S(1) - block.merged);
      }
    }
  }

  [[nodiscard]] bool rests_at(std::size_t i) const {
    const std::size_t behind = junctions_[i];
    return faster_at_rest(sizings_[i], beside(moving_[behind - 1]), beside(moving_[behind]));
  }

  void reach_blocks(std::size_t correction, std::size_t junction) {
    const auto& own = result_.corrections[correction];
    const S support = own.support();
    const LongLength<S> from = own.at - support, to = own.at + support;
    const auto act_on = [&](std::size_t i) {
      auto& block = result_.blocks[i];
      if (block.count == 0) block.first = correction;
      block.count = correction + 1 - block.first;
    };
    const auto moves = [&](std::size_t i) { return blocks_[i].path.length() > S(0); };
    const std::size_t behind = moving_[junction];
    for (std::size_t i = behind; i-- > moving_.front();) {
      if (!moves(i)) continue;
      act_on(i);
      if (!(result_.blocks[i].start > from)) break;
    }
    for (std::size_t i = behind; i <= last_; ++i) {
      if (!moves(i)) continue;
      if (i > behind && !(result_.blocks[i].start < to)) break;
      act_on(i);
    }
  }

  std::span<const B> blocks_;
  const M& machine_;
  SmoothingRules<S> rules_;
  BasicAxisTolerances<S, n> axes_;
  Result result_;
  // Of the part that is open: blocks that move, of a merged line the first.
  std::vector<std::size_t> moving_;
  std::size_t last_ = 0;  // block of it that moves
  std::vector<BasicSizing<S, n>> sizings_;
  std::vector<std::size_t> junctions_;  // of each, the block behind it among those that move
};

}  // namespace cncplan::test
