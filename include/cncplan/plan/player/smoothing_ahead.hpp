// Which junctions of blocks that come in one by one are smoothed, and the corrections that do it.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "cncplan/core/enclosed_bounds.hpp"
#include "cncplan/plan/machine_block.hpp"
#include "cncplan/plan/passing.hpp"
#include "cncplan/plan/smooth_junction.hpp"
#include "cncplan/smooth/correction.hpp"
#include "cncplan/smooth/kernel_sizes.hpp"
#include "cncplan/smooth/smoothed.hpp"

namespace cncplan::plan {

/// The corrections of a program, as `smoothing` finds them, for blocks of which no more than `room` are kept.
/// Kernels reach over no more than `neighbours` blocks on each side, so a block's path is known once
/// `4 neighbours + 2` blocks that move have followed, or none will without a rest. Bounded work for a block:
/// the sums over `4 neighbours` kernels and the limits of the block.
///
/// One thread pushes. What it has told as known stays as it is while the block is kept.
template <MachineModel M, BlockModel B, std::size_t room, std::size_t neighbours>
class SmoothingAhead {
 public:
  using Scalar = typename M::Scalar;
  using Rules = SmoothingRules<Scalar>;
  using Driven = smooth::Smoothed<typename B::Path>;
  /// Whether blocks of this kind can be smoothed.
  static constexpr bool possible = EnclosedPath<typename B::Path> && !MappedModel<M>;

  /// A tolerance of 0: every path is kept exactly.
  SmoothingAhead(const Rules& rules, const M& machine)
      : rules_(rules), axes_(axis_tolerances(machine, rules)) {}

  [[nodiscard]] const Rules& rules() const { return rules_; }
  [[nodiscard]] bool smooths() const { return possible && rules_.tolerance > Scalar(0); }

  /// Takes the next block, which is to stay until it is not asked for any more. `line` is the length of the
  /// merged line that begins with it, else its own.
  void push(const B& block, const M& machine, Scalar line) {
    const std::int64_t number = pushed_++;
    if constexpr (possible) {
      if (smooths()) return add(block, number, machine, line);
    }
    of_block(number) = {};
  }
  /// Behind what has been pushed the motion rests.
  void end_part() {
    if (begin_ == end_) return;
    if constexpr (possible) advance(true);
    begin_ = end_;
    sizings_end_ = 0;
    place_ = 0;
    rests_ = true;
  }
  /// Forgets all blocks; the next one begins at rest.
  void restart() {
    begin_ = end_ = widest_ = summed_ = sized_ = known_ = pushed_ = 0;
    sizings_end_ = 0;
    place_ = 0;
    rests_ = true;
  }

  /// Of how many blocks it is known how they are driven.
  [[nodiscard]] std::int64_t known() const { return known_ == end_ ? pushed_ : mover(known_).number; }
  /// How the motion passes the start of a block that is known, and the path that is driven in its place.
  [[nodiscard]] Passing passing(std::int64_t number) const { return of_block(number).passing; }
  [[nodiscard]] Driven driven(const B& block, std::int64_t number, const std::array<int, 3>& tool) const {
    const OfBlock& own = of_block(number);
    const auto first = static_cast<std::size_t>(own.first % most_corrections);
    return {block.path, std::span(corrections_).subspan(first, own.count), own.start, tool};
  }

 private:
  static constexpr int n = M::axis_count;
  static constexpr auto reach = static_cast<std::int64_t>(neighbours);
  // Blocks that move, from the first that is not known and those beside it to the last.
  static constexpr std::size_t most_movers = 4 * neighbours + 8;
  static constexpr std::size_t most_sizings = 4 * most_movers;
  // Two at each junction, while the blocks are kept on which they act.
  static constexpr std::int64_t most_corrections = 2 * (room + neighbours + 1);

  using Correction = smooth::BasicCorrection<Scalar, n>;
  using Sizing = smooth::BasicSizing<Scalar, n>;

  struct OfBlock {
    std::int64_t first{};  // of the corrections
    std::size_t count{};
    double start{};  // mm from the start of the part from rest to rest
    Passing passing = Passing::policy;
  };

  // A block that moves, and the junction at its start.
  struct Mover {
    std::int64_t number{};
    OfBlock own;
    Scalar tolerance{}, left{};
    BasicBeside<Scalar> beside;
    std::size_t sizing{};  // the first of the junction, and how many
    std::size_t sizing_count{};
  };

  [[nodiscard]] OfBlock& of_block(std::int64_t number) {
    return of_blocks_[static_cast<std::size_t>(number) % room];
  }
  [[nodiscard]] const OfBlock& of_block(std::int64_t number) const {
    return of_blocks_[static_cast<std::size_t>(number) % room];
  }
  [[nodiscard]] Mover& mover(std::int64_t i) { return movers_[static_cast<std::size_t>(i) % most_movers]; }
  [[nodiscard]] const Mover& mover(std::int64_t i) const {
    return movers_[static_cast<std::size_t>(i) % most_movers];
  }

  void add(const B& block, std::int64_t number, const M& machine, Scalar line) {
    if (block.path.length() > Scalar(0)) {
      if (end_ > begin_ && last_->straight_on) line = std::max(line, mover(end_ - 1).beside.length);
      const Passing passing = rests_ ? Passing::stop : passing_between(*last_, block, machine, rules_);
      if (passing != Passing::smooth) end_part();
      Mover& own = mover(end_);
      own = {number,
             {0, 0, place_, passing},
             tolerance_of(block, rules_),
             Scalar(1) - block.merged,
             {line, detail::top_limits(block, machine)},
             sizings_end_,
             0};
      if (passing == Passing::smooth) add_junction(own, block, machine);
      place_ += static_cast<double>(block.path.length());
      last_ = &block;
      rests_ = false;
      ++end_;
      advance(false);
    } else {
      of_block(number) = {};
    }
    if (block.exact_stop || block.pause > Scalar(0)) {
      end_part();
      rests_ = true;
    }
  }

  void add_junction(Mover& own, const B& block, const M& machine) {
    const Scalar speed = std::min(mover(end_ - 1).beside.limits.velocity, own.beside.limits.velocity);
    for (const auto& jump : jumps_between(*last_, block, place_, speed, machine)) {
      if (sizings_end_ == most_sizings) own.sizing = make_room();
      sizings_[sizings_end_++] = jump;
      ++own.sizing_count;
    }
  }
  // Lets go of the sizings that are not asked for any more; where those of the last block begin then.
  std::size_t make_room() {
    const std::int64_t oldest = std::max(begin_, sized_ - reach - 1);
    const std::size_t by = mover(oldest).sizing;
    std::move(sizings_.begin() + static_cast<std::ptrdiff_t>(by), sizings_.end(), sizings_.begin());
    for (std::int64_t i = oldest; i <= end_; ++i) mover(i).sizing -= by;
    sizings_end_ -= by;
    return mover(end_).sizing;
  }

  // As far as what follows is known, or with nothing to follow.
  void advance(bool ended) {
    const auto up_to = [&](std::int64_t known, std::int64_t ahead) { return ended ? end_ : known - ahead; };
    for (; widest_ < up_to(end_, reach); ++widest_) find_widest(widest_);
    for (; summed_ < up_to(widest_, reach + 1); ++summed_)
      for_each_sizing(summed_, [this](auto& sizing, auto near, std::size_t at) {
        sizing.sum = smooth::deviation_sum(near, at, axes_);
      });
    for (; sized_ < up_to(summed_, reach + 1); ++sized_) {
      for_each_sizing(sized_, [](auto& sizing, auto near, std::size_t at) {
        sizing.size = smooth::fitted_size(near, at);
      });
      correct(sized_);
    }
    for (; known_ < up_to(sized_, reach); ++known_) of_block(mover(known_).number) = mover(known_).own;
  }

  // Calls visit(sizing, those near it, which of them it is) for each of a junction.
  template <class Visit>
  void for_each_sizing(std::int64_t at, Visit&& visit) {
    const Mover& own = mover(at);
    const std::size_t first = mover(std::max(at - reach - 1, begin_)).sizing;
    const Mover& last = mover(std::min(at + reach + 1, end_ - 1));
    const auto near =
        std::span<const Sizing>(sizings_).subspan(first, last.sizing + last.sizing_count - first);
    for (std::size_t k = own.sizing; k < own.sizing + own.sizing_count; ++k)
      visit(sizings_[k], near, k - first);
  }

  // Room to the rests on both sides and to the farthest neighbours; the lowest tolerance up to the next
  // junctions.
  void find_widest(std::int64_t at) {
    Mover& own = mover(at);
    if (own.sizing_count == 0) return;
    const std::int64_t left = std::max(at - reach, begin_), right = std::min(at + reach, end_);
    const double end = right < end_ ? mover(right).own.start : place_;
    std::int64_t from = at - 1, to = at + 1;
    while (from > left && mover(from).sizing_count == 0) --from;
    while (to < right && mover(to).sizing_count == 0) ++to;
    Scalar tolerance = std::numeric_limits<Scalar>::infinity(), left_over = Scalar(1);
    for (std::int64_t i = from; i < to; ++i) {
      tolerance = std::min(tolerance, mover(i).tolerance);
      left_over = std::min(left_over, mover(i).left);
    }
    for (std::size_t k = own.sizing; k < own.sizing + own.sizing_count; ++k) {
      auto& sizing = sizings_[k];
      sizing.room = static_cast<Scalar>(std::min(sizing.at - mover(left).own.start, end - sizing.at));
      sizing.tolerance = tolerance;
      sizing.left = left_over;
      smooth::set_widest(sizing, axes_);
    }
  }

  // The corrections of a junction, and the blocks on which they act.
  void correct(std::int64_t at) {
    Mover& own = mover(at);
    for (std::size_t k = own.sizing; k < own.sizing + own.sizing_count; ++k) {
      const auto& sizing = sizings_[k];
      if (faster_at_rest(sizing, mover(at - 1).beside, own.beside)) own.own.passing = Passing::stop;
      if (own.own.passing == Passing::stop) continue;  // jumps do no harm at rest
      const Correction correction{sizing.at, sizing.size, sizing.jump, sizing.step};
      // Twice, so that any of them that follow each other stand side by side.
      const auto slot = static_cast<std::size_t>(corrected_ % most_corrections);
      corrections_[slot] = corrections_[slot + static_cast<std::size_t>(most_corrections)] = correction;
      reach_blocks(correction, corrected_++, at);
    }
  }

  void reach_blocks(const Correction& correction, std::int64_t number, std::int64_t behind) {
    const auto support = static_cast<double>(correction.support());
    const double from = correction.at - support, to = correction.at + support;
    const auto use = [&](std::int64_t i) {
      OfBlock& block = mover(i).own;
      if (block.count == 0) block.first = number;
      block.count = static_cast<std::size_t>(number + 1 - block.first);
    };
    for (std::int64_t i = behind - 1; i >= begin_; --i) {
      use(i);
      if (!(mover(i).own.start > from)) break;
    }
    for (std::int64_t i = behind; i < end_; ++i) {
      if (i > behind && !(mover(i).own.start < to)) break;
      use(i);
    }
  }

  Rules rules_;
  smooth::BasicAxisTolerances<Scalar, n> axes_;
  const B* last_ = nullptr;  // that moves
  bool rests_ = true;        // behind it
  double place_ = 0;         // mm from the start of the part to its end so far
  std::int64_t pushed_ = 0;
  // Blocks that move: the first one of the part, and how far each step has come.
  std::int64_t begin_ = 0, end_ = 0, widest_ = 0, summed_ = 0, sized_ = 0, known_ = 0;
  std::int64_t corrected_ = 0;
  std::array<Mover, most_movers> movers_{};
  std::size_t sizings_end_ = 0;
  std::array<Sizing, most_sizings> sizings_{};
  std::array<OfBlock, room> of_blocks_{};
  std::array<Correction, 2 * static_cast<std::size_t>(most_corrections)> corrections_{};
};

}  // namespace cncplan::plan
