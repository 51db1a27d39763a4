// Which junctions of blocks that come in one by one are smoothed, and the corrections that do it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "cncplan/block.hpp"
#include "cncplan/core/box.hpp"
#include "cncplan/core/detail/long_length.hpp"
#include "cncplan/core/detail/ring_places.hpp"
#include "cncplan/core/enclosed_bounds.hpp"
#include "cncplan/core/interval.hpp"
#include "cncplan/detail/block_checks.hpp"
#include "cncplan/detail/curve/correction.hpp"
#include "cncplan/detail/curve/junction_mode.hpp"
#include "cncplan/detail/curve/kernel_sizes.hpp"
#include "cncplan/detail/curve/smooth_junction.hpp"
#include "cncplan/detail/curve/smoothed.hpp"

namespace cncplan::detail {

/// How a block is driven.
template <std::floating_point S>
struct BasicBlockSmoothing {
  std::size_t first{};    ///< of the corrections that act on it: its place among those that are kept
  std::size_t count{};    ///< of them
  LongLength<S> start{};  ///< mm from the start of the program
  JunctionMode junction_mode = JunctionMode::exact;
  bool rests_for_travel{};  ///< at its start, where a correction could leave the travel of an axis
};

/// Where the axes are between two lengths of a block, or of the merged line that begins with it.
template <BlockModel B, std::floating_point S>
[[nodiscard]] auto positions_between(const B& block, S from, S to) {
  constexpr int n = B::Path::Vector::RowsAtCompileTime;
  std::array<BasicInterval<S>, static_cast<std::size_t>(n)> positions;
  if (block.straight_on) {
    const auto start = block.path.point_at(S(0));
    for (int i = 0; i < n; ++i)
      positions[static_cast<std::size_t>(i)] = BasicInterval<S>::hull(
          start.position[i] + from * start.first[i], start.position[i] + to * start.first[i]);
    return positions;
  }
  // Near where an axis turns, what its derivative allows from the middle on is closer than its enclosure.
  const auto enclosed = block.path.enclosure(from, to);
  const S half = (to - from) / S(2);
  const auto middle = block.path.position_at(from + half);
  for (int i = 0; i < n; ++i) {
    const auto& jet = enclosed[static_cast<std::size_t>(i)];
    const S far = half > S(0) ? half * jet.first.largest() : S(0);
    positions[static_cast<std::size_t>(i)] = {std::max(jet.value.low, middle[i] - far),
                                              std::min(jet.value.high, middle[i] + far)};
  }
  return positions;
}

/// The corrections of a program, for blocks of which only the last ones are kept. Kernels reach over no more
/// than `neighbours` blocks on each side, so a block's path is known once `4 neighbours + 2` blocks that move
/// have followed, or none will without a rest. Bounded work in each call: the sums over `4 neighbours`
/// kernels, and the limits of one block.
///
/// Where the programmed paths stay in the travel of the axes, so do those that are driven: a junction at
/// which that is not certain is passed at rest, on the programmed path.
///
/// One thread pushes. What it has told as known stays as it is while the block is kept.
template <MachineModel M, BlockModel B>
class SmoothingAhead {
 public:
  using Scalar = typename M::Scalar;
  using Rules = SmoothingRules<Scalar>;
  using Driven = Smoothed<typename B::Path>;
  using Correction = BasicCorrection<Scalar, M::axis_count>;
  using Sizing = BasicSizing<Scalar, M::axis_count>;
  /// Whether blocks of this kind can be smoothed.
  static constexpr bool possible = EnclosedPath<typename B::Path> && !MappedModel<M>;

  using OfBlock = BasicBlockSmoothing<Scalar>;
  /// A block that moves, and the junction at its start.
  struct Mover {
    const B* block{};
    std::int64_t number{};
    OfBlock own;
    Scalar tolerance{}, left{};
    BasicBeside<Scalar> beside;
    std::size_t sizing{};  ///< the first of the junction
    std::size_t sizing_count{};
  };
  /// What it works in; all of it belongs to the caller. See `SmoothingRoom`.
  struct Memory {
    std::size_t neighbours{};
    std::span<OfBlock> blocks;  ///< a power of two, as many as blocks are kept
    std::span<Mover> movers;
    std::span<Sizing> sizings;
    std::span<Correction> corrections;
  };

  /// A tolerance of 0: every path is kept exactly.
  SmoothingAhead(const Rules& rules, const M& machine, const Memory& memory)
      : rules_(rules),
        axes_(axis_tolerances(machine, rules)),
        has_ends_(has_ends(machine)),
        travel_(travel(machine)),
        memory_(memory),
        places_(memory.movers.size()) {}

  [[nodiscard]] const Rules& rules() const { return rules_; }
  [[nodiscard]] bool smooths() const { return possible && rules_.tolerance > Scalar(0); }

  /// Takes the next block, which is to stay until it is not asked for any more. `line` is the length of the
  /// merged line that begins with it, else its own. False, and nothing done, while a part ends: `work` first.
  bool push(const B& block, const M& machine, Scalar line);
  /// Takes a block that goes straight on from the last one, as a part of it: it counts as no neighbour of its
  /// own, and `line` of that one has its length too.
  void extend(const B& block) {
    place_ += block.path.length();
    last_ = &block;
    if (block.exact_stop || block.pause > Scalar(0)) end_part();
  }
  /// Behind what has been pushed the motion rests: `work` finds how it comes there.
  void end_part() {
    rests_ = true;
    ends_ = begin_ != end_;
  }
  /// Whether a part ends.
  [[nodiscard]] bool ends() const { return ends_; }
  /// Goes on with the end of a part, by one block.
  void work();
  /// Forgets all blocks; the next one begins at rest.
  void restart();

  /// Of how many blocks it is known how they are driven.
  [[nodiscard]] std::int64_t known() const { return known_ == end_ ? pushed_ : mover(known_).number; }
  [[nodiscard]] std::int64_t pushed() const { return pushed_; }
  /// Of a block that is known.
  [[nodiscard]] const OfBlock& of_block(std::int64_t number) const {
    return memory_.blocks[static_cast<std::size_t>(number) & (memory_.blocks.size() - 1)];
  }
  /// How the motion passes its start, and the path that is driven in its place.
  [[nodiscard]] JunctionMode junction_mode(std::int64_t number) const {
    return of_block(number).junction_mode;
  }
  [[nodiscard]] Driven driven(const B& block, std::int64_t number, const std::array<int, 3>& tool) const {
    const OfBlock& own = of_block(number);
    return {block.path, memory_.corrections.subspan(own.first, own.count), own.start, tool};
  }

 private:
  [[nodiscard]] OfBlock& place_of(std::int64_t number) {
    return memory_.blocks[static_cast<std::size_t>(number) & (memory_.blocks.size() - 1)];
  }
  [[nodiscard]] Mover& mover(std::int64_t i) const { return memory_.movers[places_(i)]; }
  [[nodiscard]] std::int64_t reach() const { return static_cast<std::int64_t>(memory_.neighbours); }

  void add(const B& block, JunctionMode junction_mode, const M& machine, Scalar line);
  void add_junction(Mover& own, const B& block, const M& machine);
  std::size_t make_room();
  void advance(int most);
  template <class Visit>
  void for_each_sizing(std::int64_t at, Visit&& visit);
  void find_widest(std::int64_t at);
  void correct(std::int64_t at);
  template <class Visit>
  void for_each_reached(const Correction& correction, std::int64_t behind, Visit&& visit) const;
  void reach_blocks(const Correction& correction, std::size_t slot, std::int64_t behind);
  [[nodiscard]] bool may_leave_travel(const Correction& correction, Scalar tolerance,
                                      std::int64_t behind) const;

  Rules rules_;
  BasicAxisTolerances<Scalar, M::axis_count> axes_;
  bool has_ends_;
  BasicBox<Scalar, M::axis_count> travel_;
  Memory memory_;
  RingPlaces places_;           // of movers
  const B* last_ = nullptr;     // that moves
  bool rests_ = true;           // behind it
  bool ends_ = false;           // the part takes no more blocks
  LongLength<Scalar> place_{};  // mm from the start of the program to its end so far
  std::int64_t pushed_ = 0;
  // Blocks that move: the first one of the part, and how far each step has come.
  std::int64_t begin_ = 0, end_ = 0, widest_ = 0, summed_ = 0, sized_ = 0, known_ = 0;
  std::size_t sizings_end_ = 0;
  std::size_t corrected_ = 0;  // the place of the next correction
};

/// Memory for `SmoothingAhead`: `room` blocks are kept, a power of two.
template <MachineModel M, BlockModel B, std::size_t room, std::size_t neighbours>
struct SmoothingRoom {
  using Ahead = SmoothingAhead<M, B>;
  // Blocks that move, from the first that is not known and those beside it to the last.
  static constexpr std::size_t most_movers = 4 * neighbours + 8;

  std::array<typename Ahead::OfBlock, room> blocks{};
  std::array<typename Ahead::Mover, most_movers> movers{};
  std::array<typename Ahead::Sizing, 4 * most_movers> sizings{};
  // Two at each junction while the blocks are kept on which they act; each of them stands there twice.
  std::array<typename Ahead::Correction, 4 * (room + neighbours + 1)> corrections{};

  [[nodiscard]] typename Ahead::Memory memory() { return {neighbours, blocks, movers, sizings, corrections}; }
};

template <MachineModel M, BlockModel B>
bool SmoothingAhead<M, B>::push(const B& block, const M& machine, Scalar line) {
  if (ends_) return false;
  if constexpr (possible) {
    if (smooths()) {
      const bool moves = block.path.length() > Scalar(0);
      if (moves) {
        const JunctionMode junction_mode =
            rests_ ? JunctionMode::stop : junction_mode_between(*last_, block, machine, rules_);
        if (junction_mode != JunctionMode::smooth && begin_ != end_) {
          ends_ = true;
          return false;
        }
        add(block, junction_mode, machine, line);
      } else {
        place_of(pushed_) = {};
      }
      ++pushed_;
      if (block.exact_stop || block.pause > Scalar(0)) end_part();
      return true;
    }
  }
  place_of(pushed_++) = {};
  return true;
}

template <MachineModel M, BlockModel B>
void SmoothingAhead<M, B>::work() {
  if (!ends_) return;
  if constexpr (possible) advance(1);
  if (known_ < end_) return;
  begin_ = end_;
  sizings_end_ = 0;
  ends_ = false;
}

template <MachineModel M, BlockModel B>
void SmoothingAhead<M, B>::restart() {
  begin_ = end_ = widest_ = summed_ = sized_ = known_ = pushed_ = 0;
  places_.restart(0);
  sizings_end_ = 0;
  place_ = {};
  rests_ = true;
  ends_ = false;
}

template <MachineModel M, BlockModel B>
void SmoothingAhead<M, B>::add(const B& block, JunctionMode junction_mode, const M& machine, Scalar line) {
  if (end_ > begin_ && last_->straight_on) line = std::max(line, mover(end_ - 1).beside.length);
  Mover& own = mover(end_);
  own = {&block,
         pushed_,
         {0, 0, place_, junction_mode},
         tolerance_of(block, rules_),
         Scalar(1) - block.merged,
         {line, top_limits(block, machine)},
         sizings_end_,
         0};
  if (junction_mode == JunctionMode::smooth) add_junction(own, block, machine);
  place_ += block.path.length();
  last_ = &block;
  rests_ = false;
  places_.advance(++end_ - places_.size() + 1);
  advance(std::numeric_limits<int>::max());
}

template <MachineModel M, BlockModel B>
void SmoothingAhead<M, B>::add_junction(Mover& own, const B& block, const M& machine) {
  const Scalar speed = std::min(mover(end_ - 1).beside.limits.velocity, own.beside.limits.velocity);
  for (const auto& jump : jumps_between(*last_, block, place_, speed, machine)) {
    if (sizings_end_ == memory_.sizings.size()) own.sizing = make_room();
    memory_.sizings[sizings_end_++] = jump;
    ++own.sizing_count;
  }
}

// Lets go of the sizings that are not asked for any more; where those of the last block begin then.
template <MachineModel M, BlockModel B>
std::size_t SmoothingAhead<M, B>::make_room() {
  const std::int64_t oldest = std::max(begin_, sized_ - reach() - 1);
  const std::size_t by = mover(oldest).sizing;
  std::move(memory_.sizings.begin() + static_cast<std::ptrdiff_t>(by), memory_.sizings.end(),
            memory_.sizings.begin());
  for (std::int64_t i = oldest; i <= end_; ++i) mover(i).sizing -= by;
  sizings_end_ -= by;
  return mover(end_).sizing;
}

// As far as what follows is known, or with nothing to follow, each step by so many blocks at most.
template <MachineModel M, BlockModel B>
void SmoothingAhead<M, B>::advance(int most) {
  const auto step = [&](std::int64_t& done, std::int64_t known, std::int64_t ahead, const auto& work) {
    const std::int64_t up_to = ends_ && known == end_ ? end_ : known - ahead;
    for (int left = most; left > 0 && done < up_to; --left) work(done++);
  };
  step(widest_, end_, reach(), [this](std::int64_t at) { find_widest(at); });
  step(summed_, widest_, reach() + 1, [this](std::int64_t at) {
    for_each_sizing(
        at, [this](auto& sizing, auto near, std::size_t i) { sizing.sum = deviation_sum(near, i, axes_); });
  });
  step(sized_, summed_, reach() + 1, [this](std::int64_t at) {
    for_each_sizing(at, [](auto& sizing, auto near, std::size_t i) { sizing.size = fitted_size(near, i); });
    correct(at);
  });
  step(known_, sized_, reach(), [this](std::int64_t at) { place_of(mover(at).number) = mover(at).own; });
}

// Calls visit(sizing, those near it, which of them it is) for each of a junction.
template <MachineModel M, BlockModel B>
template <class Visit>
void SmoothingAhead<M, B>::for_each_sizing(std::int64_t at, Visit&& visit) {
  const Mover& own = mover(at);
  const std::size_t first = mover(std::max(at - reach() - 1, begin_)).sizing;
  const Mover& last = mover(std::min(at + reach() + 1, end_ - 1));
  const auto near =
      std::span<const Sizing>(memory_.sizings).subspan(first, last.sizing + last.sizing_count - first);
  for (std::size_t k = own.sizing; k < own.sizing + own.sizing_count; ++k)
    visit(memory_.sizings[k], near, k - first);
}

// Room to the rests on both sides and to the farthest neighbours; the lowest tolerance up to the next
// junctions.
template <MachineModel M, BlockModel B>
void SmoothingAhead<M, B>::find_widest(std::int64_t at) {
  Mover& own = mover(at);
  if (own.sizing_count == 0) return;
  const std::int64_t left = std::max(at - reach(), begin_), right = std::min(at + reach(), end_);
  const LongLength<Scalar> end = right < end_ ? mover(right).own.start : place_;
  std::int64_t from = at - 1, to = at + 1;
  while (from > left && mover(from).sizing_count == 0) --from;
  while (to < right && mover(to).sizing_count == 0) ++to;
  Scalar tolerance = std::numeric_limits<Scalar>::infinity(), left_over = Scalar(1);
  for (std::int64_t i = from; i < to; ++i) {
    tolerance = std::min(tolerance, mover(i).tolerance);
    left_over = std::min(left_over, mover(i).left);
  }
  for (std::size_t k = own.sizing; k < own.sizing + own.sizing_count; ++k) {
    Sizing& sizing = memory_.sizings[k];
    sizing.room = std::min(sizing.at - mover(left).own.start, end - sizing.at);
    sizing.tolerance = tolerance;
    sizing.left = left_over;
    set_widest(sizing, axes_);
  }
}

// The corrections of a junction, and the blocks on which they act.
template <MachineModel M, BlockModel B>
void SmoothingAhead<M, B>::correct(std::int64_t at) {
  Mover& own = mover(at);
  const auto sizings = std::span<const Sizing>(memory_.sizings).subspan(own.sizing, own.sizing_count);
  const auto correction_of = [](const Sizing& sizing) {
    return Correction{sizing.at, sizing.size, sizing.jump, sizing.step};
  };
  own.own.rests_for_travel = std::any_of(sizings.begin(), sizings.end(), [&](const Sizing& sizing) {
    return may_leave_travel(correction_of(sizing), sizing.tolerance, at);
  });
  for (const Sizing& sizing : sizings) {
    if (own.own.rests_for_travel || faster_at_rest(sizing, mover(at - 1).beside, own.beside))
      own.own.junction_mode = JunctionMode::stop;
    if (own.own.junction_mode == JunctionMode::stop) continue;  // jumps do no harm at rest
    const Correction correction = correction_of(sizing);
    // Twice, so that any of them that follow each other stand side by side.
    const std::size_t room = memory_.corrections.size() / 2, slot = corrected_;
    corrected_ = slot + 1 < room ? slot + 1 : 0;
    memory_.corrections[slot] = memory_.corrections[slot + room] = correction;
    reach_blocks(correction, slot, at);
  }
}

// Calls visit(block) for those on which a correction acts; `behind`: the one behind its junction.
template <MachineModel M, BlockModel B>
template <class Visit>
void SmoothingAhead<M, B>::for_each_reached(const Correction& correction, std::int64_t behind,
                                            Visit&& visit) const {
  const LongLength<Scalar> from = correction.at - correction.support(),
                           to = correction.at + correction.support();
  // Rounding must not take it farther than its neighbours: the blocks before them may have been let go.
  for (std::int64_t i = behind - 1; i >= std::max(begin_, behind - reach()); --i) {
    visit(i);
    if (!(mover(i).own.start > from)) break;
  }
  for (std::int64_t i = behind; i < std::min(end_, behind + reach()); ++i) {
    if (i > behind && !(mover(i).own.start < to)) break;
    visit(i);
  }
}

template <MachineModel M, BlockModel B>
void SmoothingAhead<M, B>::reach_blocks(const Correction& correction, std::size_t slot, std::int64_t behind) {
  for_each_reached(correction, behind, [&](std::int64_t i) {
    OfBlock& block = mover(i).own;
    if (block.count == 0) block.first = slot;
    const std::size_t room = memory_.corrections.size() / 2;
    block.count = (slot < block.first ? slot + room : slot) + 1 - block.first;
  });
}

// Whether a correction pushes an axis towards an end of its travel where the path is no farther from that
// than corrections may take it: a direction's pushes one way, a curvature's both ways.
template <MachineModel M, BlockModel B>
bool SmoothingAhead<M, B>::may_leave_travel(const Correction& correction, Scalar tolerance,
                                            std::int64_t behind) const {
  if (!has_ends_) return false;
  constexpr Scalar rounding =
      std::max(Scalar(1e-11), Scalar(4) * std::numeric_limits<Scalar>::epsilon());  // mm or rad
  const bool curvature = correction.jump == Jump::curvature;
  const Scalar deviates =
      correction.size * (curvature ? correction.size : Scalar(1)) * largest<Scalar>(correction.jump);
  bool leaves = false;
  for_each_reached(correction, behind, [&](std::int64_t i) {
    if (leaves) return;
    const LongLength<Scalar>& start = mover(i).own.start;
    const Scalar length = (i + 1 < end_ ? mover(i + 1).own.start : place_) - start;
    const Scalar from = std::max(correction.at - correction.support() - start, Scalar(0));
    const Scalar to = std::min(correction.at + correction.support() - start, length);
    const auto positions = positions_between(*mover(i).block, from, to);
    for (int axis = 0; axis < M::axis_count; ++axis) {
      const Scalar step = correction.step[axis], per_angle = axes_.per_angle[axis];
      if (!(std::abs(step) * deviates > rounding)) continue;
      const Scalar most = per_angle > Scalar(0) ? Scalar(1) / per_angle : tolerance;
      const auto& [low, high] = positions[static_cast<std::size_t>(axis)];
      leaves = leaves || ((curvature || step < Scalar(0)) && low - most < travel_.low[axis]) ||
               ((curvature || step > Scalar(0)) && high + most > travel_.high[axis]);
    }
  });
  return leaves;
}

}  // namespace cncplan::detail
