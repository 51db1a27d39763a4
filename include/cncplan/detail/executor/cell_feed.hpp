// From blocks as they come in to the cells that a motion executor runs: the side of an executor that
// prepares.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "cncplan/detail/curve/merge_lines.hpp"
#include "cncplan/detail/curve/smooth_junction.hpp"
#include "cncplan/detail/curve/smoothing_ahead.hpp"
#include "cncplan/detail/executor/block_ring.hpp"
#include "cncplan/detail/executor/nearest.hpp"
#include "cncplan/detail/executor/shared_count.hpp"
#include "cncplan/detail/speed/cell_maker.hpp"
#include "cncplan/gcode/diagnostic.hpp"
#include "cncplan/tool.hpp"

namespace cncplan::detail {

/// Limits with which a motion executor can reckon: what is infinite becomes so high that no motion is slower
/// for it by more than 10 us a ramp.
template <std::floating_point S>
[[nodiscard]] BasicLimits<S> finite_limits(BasicLimits<S> limits) {
  constexpr S shortest = S(1e-5);  // s, of a change of acceleration
  if (!std::isfinite(limits.jerk)) limits.jerk = limits.acceleration / shortest;
  // no ramp between speeds up to v peaks above sqrt(j v)
  if (!std::isfinite(limits.acceleration))
    limits.acceleration = S(2) * std::sqrt(limits.jerk * limits.velocity);
  return limits;
}

/// Over how many blocks the kernels of a feed with room for so many may reach on each side: it is to know the
/// paths of blocks while a quarter of the room is ahead of them.
[[nodiscard]] constexpr std::size_t neighbours_for(std::size_t room) {
  return std::clamp<std::size_t>(room / 4 > 2 ? (room / 4 - 2) / 4 : 1, 1, most_neighbours);
}

/// How many lines a feed with room for so many blocks merges: an eighth of the room waits for the next one.
[[nodiscard]] constexpr std::int64_t merged_lines_for(std::size_t room) {
  return std::min(static_cast<std::int64_t>(room / 8), most_merged_lines);
}

/// Keeps blocks by their number, merges and smooths them and cuts them into cells, as far as there is room
/// for those. One thread pushes and cuts; another one asks for blocks and lets them go.
template <MachineModel M, BlockModel B>
class CellFeed {
 public:
  using Scalar = typename M::Scalar;
  using Vector = VectorN<Scalar, M::axis_count>;
  using Cell = BasicMotionBlock<Scalar>;
  using Rules = BasicJunctionRules<Scalar>;
  using Driven = Smoothed<typename B::Path>;

  /// A block that is kept.
  struct Slot {
    B block;
    Scalar start{};  ///< mm from the start of the program
  };
  /// What it works in; all of it belongs to the caller. See `CellFeedRoom`.
  struct Memory {
    std::size_t room{};     ///< how many blocks it holds
    std::span<Slot> slots;  ///< a power of two, `room` at least
    typename SmoothingAhead<M, B>::Memory smoothing;
  };

  CellFeed(const M& machine, const Rules& rules, const SmoothingRules<Scalar>& smoothing,
           Scalar most_override, const Memory& memory)
      : machine_(machine),
        tool_(tool_axes(machine)),
        maker_(machine, rules, most_override),
        merger_(machine_, smoothing, merged_lines_for(memory.room)),
        smoothing_(smoothing, machine_, memory.smoothing),
        room_(static_cast<std::int64_t>(memory.room)),
        slots_(memory.slots) {
    if (const auto ok = validate(machine); !ok) fail({ok.error(), 0, 0, {}});
  }

  // For the thread that pushes and cuts.
  /// False when there is no room. Behind an error blocks are taken and dropped.
  bool push(const B& block);
  /// Behind what has been pushed the motion rests: `cut` finds how it comes there.
  void end_part() {
    merger_.end(block_at(), merged());
    ends_at_ = merged_;
  }

  /// Hands cells to `take`, which says false when there is no room; whether there is more to do. It takes so
  /// many steps at most: one towards a cell, or the smoothing of a block.
  template <class Take>
  bool cut(std::size_t most, Take&& take) {
    if (waits_.exchange(false, std::memory_order_acquire)) end_part();
    for (; most > 0; --most) {
      if (!waiting_ && !make()) return false;
      if (waiting_) {
        if (!take(*waiting_)) return true;
        waiting_.reset();
      }
      if (maker_.done() && !next_) ready_.store(begun_);
    }
    return true;
  }

  /// Forgets all blocks. The motion begins where the first block that counts, the first one of a line (0: of
  /// any), passes a place, if one is given. Not while blocks are pushed or asked for.
  void restart(int line, const std::optional<Vector>& place);

  // For the other thread.
  [[nodiscard]] const B& operator[](std::int64_t number) const { return slot(number).block; }
  /// The path that is driven in its place.
  [[nodiscard]] Driven path(std::int64_t number) const {
    return smoothing_.driven(slot(number).block, number, tool_);
  }
  /// Where the first block begins, once it has been pushed: the axes and the tool; 0 where that is no number.
  struct Start {
    Vector position = Vector::Zero();
    BasicVector3<Scalar> tool = BasicVector3<Scalar>::Zero();
  };
  [[nodiscard]] const Start& start() const { return start_; }
  /// mm from the start of the program.
  [[nodiscard]] Scalar start_length(std::int64_t number) const { return slot(number).start; }
  /// Blocks before this one are not asked for again.
  void release(std::int64_t number) { needed_.store(number); }

  /// Nothing comes: blocks that wait for what follows them go on without it.
  void let_go() {
    const std::int64_t ready = this->ready(), pushed = this->pushed();
    if (ready == pushed || ready < let_go_) return;  // those that were let go before come first
    let_go_ = pushed;
    waits_.store(true, std::memory_order_release);
  }

  // For both.
  [[nodiscard]] bool smooths() const { return smoothing_.smooths(); }
  /// How many blocks have been pushed, and of how many all cells have been taken.
  [[nodiscard]] std::int64_t pushed() const { return pushed_.load(); }
  [[nodiscard]] std::int64_t ready() const { return ready_.load(); }
  /// Whether there is no room for a block.
  [[nodiscard]] bool full() const { return pushed_.load() - needed_.load() >= room_; }
  /// Whether a block could not be planned; no cell follows.
  [[nodiscard]] bool failed() const { return failed_.load(std::memory_order_acquire); }
  /// What was wrong with it, only where it has failed.
  [[nodiscard]] const gcode::Diagnostic& fault() const { return fault_; }

 private:
  // Of one push, for which one is enough on average: those of a part that ends are made up for.
  static constexpr int smoothing_steps_in_push = 4;

  [[nodiscard]] Slot& slot(std::int64_t number) const {
    return slots_[static_cast<std::size_t>(number) & (slots_.size() - 1)];
  }

  // For the merger: a block, and what becomes of one that is done.
  [[nodiscard]] auto block_at() {
    return [this](std::int64_t number) -> B& { return slot(number).block; };
  }
  [[nodiscard]] auto merged() {
    return [this](std::int64_t number) { merged_ = number + 1; };
  }
  // mm of the merged line that begins with a block; of another block its own. One that was merged before it
  // was pushed comes without those that follow.
  [[nodiscard]] Scalar line_length(std::int64_t number) const {
    Scalar length = slot(number).block.path.length();
    if (number > 0 && slot(number - 1).block.straight_on) return length;
    const std::int64_t pushed = pushed_.load();
    while (slot(number).block.straight_on && number + 1 < pushed)
      length += slot(++number).block.path.length();
    return length;
  }

  // Merging changes blocks that are not ready, so the other thread must not look at one.
  void tell_start(const B& block) {
    const VectorN<Scalar, M::axis_count> axes = block.path.position_at(Scalar(0));
    const Start start{axes, tool_position(machine_, block.path, Scalar(0), axes, tool_)};
    if (start.position.allFinite() && start.tool.allFinite()) start_ = start;
  }

  void fail(const gcode::Diagnostic& fault) {
    fault_ = fault;
    failed_.store(true, std::memory_order_release);
  }

  // Whether the motion begins at a later line.
  bool passed_over(const B& block) {
    if (first_line_ == 0) return false;
    if (block.line != first_line_) return true;
    first_line_ = 0;
    return false;
  }

  bool smooth();
  bool make();
  Expected<void> begin(const B& block);
  [[nodiscard]] bool near(const B& block, const Vector& place, const Vector& there) const;
  [[nodiscard]] Cell motion_block(const B& block, const BasicCell<Scalar>& cell) const;

  // The feed by the programmed length. It is the tool's, which is faster than that where |q'| > 1, as beside
  // a jump of curvature: a limit of the speed below the feed counts that, else a bound of |q'| does.
  [[nodiscard]] Scalar feed_along(Scalar feed, Scalar most, Scalar from, Scalar to) const {
    if constexpr (SmoothingAhead<M, B>::possible) {
      const Driven driven = path(begun_ - 1);
      for (const auto& correction : driven.corrections())
        if (correction.jump == Jump::curvature)
          return std::clamp(most, feed / std::max(driven.bounds(from, to).tool.first, Scalar(1)), feed);
    }
    return feed;
  }

  // A rest on the way. Its limits play no part.
  [[nodiscard]] Cell rest(const B& block, Scalar seconds) const {
    Cell result = common(block);
    result.segment_limits = {Scalar(0), Scalar(0), {Scalar(1), Scalar(1), Scalar(1)}, seconds};
    result.feed = Scalar(1);
    return result;
  }

  // A block that is a place to stop. Without a dwell it is no step of its own.
  [[nodiscard]] Cell stop(const B& block) const {
    Cell result = rest(block, block.pause);
    result.goes_on = !(block.pause > Scalar(0));
    result.optional_stop = is_code(block.word, 1.0);
    result.program_stop = is_code(block.word, 0.0) || is_code(block.word, 60.0);
    return result;
  }

  // Whether a word is an M code; by its bits, as small processors have no double.
  [[nodiscard]] static bool is_code(const gcode::Word& word, double code) {
    return word.letter == 'M' &&
           std::bit_cast<std::uint64_t>(word.number) == std::bit_cast<std::uint64_t>(code);
  }

  [[nodiscard]] Cell common(const B& block) const {
    Cell result;
    result.rapid = block.rapid;
    result.line = block.line;
    result.block = begun_ - 1;
    return result;
  }

  M machine_;
  std::array<int, 3> tool_;
  CellMaker<M, B> maker_;
  LineMerger<M, B> merger_;
  SmoothingAhead<M, B> smoothing_;
  std::int64_t room_;
  std::span<Slot> slots_;
  Start start_{};
  std::optional<Cell> waiting_;  // for room
  std::optional<Cell> next_;     // behind that
  std::optional<Vector> place_;  // where the motion begins, on the next block
  int first_line_ = 0;           // blocks before it are passed over
  Scalar skipped_{};             // mm of the block before the place where the motion begins
  LongLength<Scalar> length_{};  // mm of all blocks pushed
  std::int64_t merged_ = 0;      // blocks that are as they will be driven but for smoothing
  std::int64_t ends_at_ = -1;    // blocks behind which the motion rests; -1: it is known how
  std::int64_t begun_ = 0;       // blocks of which cells have been made
  std::int64_t let_go_ = 0;      // blocks that do not wait for others
  gcode::Diagnostic fault_{};
  std::atomic<bool> failed_{false};
  std::atomic<bool> waits_{false};  // the machine waits for blocks, and some are held back
  SharedCount pushed_;
  SharedCount ready_;
  SharedCount needed_;
};

/// Memory for `CellFeed`, with room for so many blocks.
template <MachineModel M, BlockModel B, std::size_t room>
struct CellFeedRoom {
  std::array<typename CellFeed<M, B>::Slot, std::bit_ceil(room)> slots{};
  SmoothingRoom<M, B, std::bit_ceil(room), neighbours_for(room)> smoothing{};

  [[nodiscard]] typename CellFeed<M, B>::Memory memory() { return {room, slots, smoothing.memory()}; }
};

template <MachineModel M, BlockModel B>
bool CellFeed<M, B>::push(const B& block) {
  if (failed() || passed_over(block)) return true;
  const std::int64_t number = pushed_.load();
  if (number - needed_.load() >= room_) return false;
  Slot& own = slot(number);
  own.block = block;
  own.start = length_ - LongLength<Scalar>{};
  if (number == 0) tell_start(block);
  if (block.path.length() > Scalar(0) && length_of(block.path, machine_) != LengthOf::rotary_axes)
    length_ += block.path.length();
  merger_.push(block_at(), merged());
  pushed_.store(number + 1);
  for (int step = 0; step < smoothing_steps_in_push && smooth(); ++step) {
  }
  return true;
}

template <MachineModel M, BlockModel B>
void CellFeed<M, B>::restart(int line, const std::optional<Vector>& place) {
  maker_.restart(std::nullopt);
  merger_.restart();
  smoothing_.restart();
  waits_ = false;
  waiting_.reset();
  next_.reset();
  first_line_ = line;
  place_ = place;
  begun_ = merged_ = let_go_ = 0;
  ends_at_ = -1;
  length_ = {};
  skipped_ = Scalar(0);
  for (SharedCount* count : {&pushed_, &ready_, &needed_}) count->store(0);
  if (validate(machine_)) failed_ = false;
}

// One step of smoothing; whether there was any to be done.
template <MachineModel M, BlockModel B>
bool CellFeed<M, B>::smooth() {
  if (!smoothing_.ends() && smoothing_.pushed() == ends_at_) {
    smoothing_.end_part();
    ends_at_ = -1;
    if (!smoothing_.ends()) return true;
  }
  if (smoothing_.ends()) return smoothing_.work(), true;
  const std::int64_t number = smoothing_.pushed();
  if (number == merged_) return false;
  smoothing_.push(slot(number).block, machine_, line_length(number));
  return true;
}

// A step towards the next cell, or a block that has none. False where there is nothing to cut.
template <MachineModel M, BlockModel B>
bool CellFeed<M, B>::make() {
  if (failed()) return false;
  if (next_) return waiting_ = std::exchange(next_, std::nullopt), true;
  if (maker_.done()) {
    if (begun_ == smoothing_.known()) return smooth();
    const B& block = slot(begun_).block;
    if (const auto ok = begin(block); !ok) return fail({ok.error(), block.line, block.column, {}}), false;
    ++begun_;
    if (maker_.done()) {
      if (block.exact_stop || block.pause > Scalar(0)) waiting_ = stop(block);
      return true;
    }
  }
  const B& block = slot(begun_ - 1).block;
  const auto made = maker_.step();
  if (!made) return fail({made.error(), block.line, block.column, {}}), false;
  if (!*made) return true;
  auto cell = maker_.cell();
  if (cell.part.to <= skipped_ && !maker_.done()) return true;
  if (cell.part.from < skipped_) {
    cell.part.from = std::min(skipped_, cell.part.to);
    cell.entry = Scalar(0);
  }
  waiting_ = motion_block(block, cell);
  if (!(cell.rest > Scalar(0))) return true;
  next_ = waiting_;
  waiting_ = rest(block, cell.rest);
  return true;
}

template <MachineModel M, BlockModel B>
Expected<void> CellFeed<M, B>::begin(const B& block) {
  const Driven driven = path(begun_);
  if (auto ok = maker_.begin(block, driven, smoothing_.junction_mode(begun_)); !ok) return ok;
  skipped_ = Scalar(0);
  if (!place_) return {};
  skipped_ = nearest_length(driven, *place_);
  const Vector there = driven.position_at(skipped_);
  const Vector place = *place_;
  place_.reset();
  if (near(block, place, there)) return {};
  return joined(std::optional<Vector>(place), there, machine_);
}

// Whether a place can be one of the path: the axes may have stopped on a corner with the block before,
// which is not smoothed now, or on a line that was merged with others. Both paths are within the tolerance
// of the programmed one.
template <MachineModel M, BlockModel B>
bool CellFeed<M, B>::near(const B& block, const Vector& place, const Vector& there) const {
  const SmoothingRules<Scalar>& rules = smoothing_.rules();
  const Scalar own =
      smoothing_.smooths() ? std::max(rules.tolerance, block.tolerance.value_or(Scalar(0))) : Scalar(0);
  for (int i = 0; i < M::axis_count; ++i) {
    const bool rotary = machine_.axes[static_cast<std::size_t>(i)].kind == AxisKind::rotary;
    const Scalar apart = Scalar(2) * (rotary ? rules.rotary_tolerance : own);
    if (!(std::abs(there[i] - place[i]) <= apart)) return false;
  }
  return true;
}

template <MachineModel M, BlockModel B>
typename CellFeed<M, B>::Cell CellFeed<M, B>::motion_block(const B& block,
                                                           const BasicCell<Scalar>& cell) const {
  const auto& [from, to, limits, inside] = cell.part;
  const bool last = maker_.done();
  Cell result = common(block);
  result.segment_limits = {to - from, cell.entry, finite_limits(limits), last ? block.pause : Scalar(0),
                           inside};
  result.goes_on = !last || block.goes_on;
  result.from = from;
  result.feed = !block.rapid && std::isfinite(block.feed)
                    ? feed_along(block.feed, limits.velocity, from, to)
                    : std::min(maker_.requested_speed(), limits.velocity);
  const BasicLimits<Scalar> above = finite_limits(cell.above);
  result.above = {std::max(above.velocity, limits.velocity),
                  std::min(above.acceleration, result.segment_limits.limits.acceleration),
                  std::min(above.jerk, result.segment_limits.limits.jerk)};
  return result;
}

}  // namespace cncplan::detail
