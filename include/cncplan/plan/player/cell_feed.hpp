// From blocks as they come in to the cells that a player runs: the side of an executor that prepares.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "cncplan/gcode/diagnostic.hpp"
#include "cncplan/junction/deviation.hpp"
#include "cncplan/plan/cell_maker.hpp"
#include "cncplan/plan/merge_lines.hpp"
#include "cncplan/plan/player/block_ring.hpp"
#include "cncplan/plan/player/nearest.hpp"
#include "cncplan/plan/player/smoothing_ahead.hpp"
#include "cncplan/plan/smooth_junction.hpp"
#include "cncplan/plan/tool.hpp"

namespace cncplan::plan {

/// Limits with which a player can reckon: what is infinite becomes so high that no motion is slower for it by
/// more than 10 us a ramp.
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
  return std::clamp<std::size_t>(room / 4 > 2 ? (room / 4 - 2) / 4 : 1, 1, smooth::most_neighbours);
}

/// How many lines a feed with room for so many blocks merges: an eighth of the room waits for the next one.
[[nodiscard]] constexpr std::int64_t merged_lines_for(std::size_t room) {
  return std::min(static_cast<std::int64_t>(room / 8), most_merged_lines);
}

/// Keeps blocks by their number, merges and smooths them and cuts them into cells, as far as there is room
/// for those. One thread pushes and cuts; another one asks for blocks and lets them go.
template <MachineModel M, BlockModel B, std::size_t room>
class CellFeed {
 public:
  using Scalar = typename M::Scalar;
  using Vector = VectorN<Scalar, M::axis_count>;
  using Cell = BasicPlayedBlock<Scalar>;
  using Rules = JointRules<Scalar, junction::BasicDeviation<Scalar>>;

  using Driven = smooth::Smoothed<typename B::Path>;

  CellFeed(const M& machine, const Rules& rules, const SmoothingRules<Scalar>& smoothing)
      : machine_(machine),
        tool_(tool_axes(machine)),
        maker_(machine, rules, true),
        merger_(machine_, smoothing, merged_lines_for(room)),
        smoothing_(smoothing, machine_) {
    if (const auto ok = validate(machine); !ok) fail({ok.error(), 0, 0, {}});
  }

  // For the thread that pushes and cuts.
  /// False when there is no room. Behind an error blocks are taken and dropped.
  bool push(const B& block) {
    if (failed() || passed_over(block)) return true;
    const std::int64_t number = pushed_.load(std::memory_order_relaxed);
    if (number - needed_.load(std::memory_order_acquire) >= static_cast<std::int64_t>(room)) return false;
    Slot& slot = slots_[static_cast<std::size_t>(number) % room];
    slot.block = block;
    slot.start = length_;
    if (number == 0) tell_start(block);
    if (block.path.length() > Scalar(0) && length_of(block.path, machine_) != LengthOf::rotary_axes)
      length_ += block.path.length();
    merger_.push(block_at(), merged());
    pushed_.store(number + 1, std::memory_order_release);
    return true;
  }
  /// Behind what has been pushed the motion rests.
  void end_part() {
    merger_.end(block_at(), merged());
    smoothing_.end_part();
  }

  /// Hands at most so many cells to `take`, which says false when there is no room; whether there are more.
  template <class Take>
  bool cut(std::size_t most, Take&& take) {
    if (waits_.exchange(false, std::memory_order_acquire)) end_part();
    for (; most > 0; --most) {
      if (!waiting_ && !make()) return false;
      if (waiting_) {
        if (!take(*waiting_)) return true;
        waiting_.reset();
      }
      if (maker_.done() && !next_) ready_.store(begun_, std::memory_order_release);
    }
    return true;
  }

  /// Forgets all blocks. The motion begins where the first block that counts, the first one of a line (0: of
  /// any), passes a place, if one is given. Not while blocks are pushed or asked for.
  void restart(int line, const std::optional<Vector>& place) {
    maker_.restart(std::nullopt);
    merger_.restart();
    smoothing_.restart();
    waits_ = false;
    waiting_.reset();
    next_.reset();
    first_line_ = line;
    place_ = place;
    begun_ = 0;
    length_ = skipped_ = Scalar(0);
    pushed_ = ready_ = needed_ = 0;
    if (validate(machine_)) failed_ = false;
  }

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
  void release(std::int64_t number) { needed_.store(number, std::memory_order_release); }

  /// The machine rests and waits for blocks: those that wait for what follows them go on without it.
  void let_go() {
    if (ready() < pushed()) waits_.store(true, std::memory_order_release);
  }

  // For both.
  [[nodiscard]] bool smooths() const { return smoothing_.smooths(); }
  /// How many blocks have been pushed, and of how many all cells have been taken.
  [[nodiscard]] std::int64_t pushed() const { return pushed_.load(std::memory_order_acquire); }
  [[nodiscard]] std::int64_t ready() const { return ready_.load(std::memory_order_acquire); }
  /// Whether a block could not be planned; no cell follows.
  [[nodiscard]] bool failed() const { return failed_.load(std::memory_order_acquire); }
  /// What was wrong with it, only where it has failed.
  [[nodiscard]] const gcode::Diagnostic& fault() const { return fault_; }

 private:
  struct Slot {
    B block;
    Scalar start{};
  };

  [[nodiscard]] const Slot& slot(std::int64_t number) const {
    return slots_[static_cast<std::size_t>(number) % room];
  }

  // For the merger: a block, and what becomes of one that is done.
  [[nodiscard]] auto block_at() {
    return
        [this](std::int64_t number) -> B& { return slots_[static_cast<std::size_t>(number) % room].block; };
  }
  [[nodiscard]] auto merged() {
    return
        [this](std::int64_t number) { smoothing_.push(slot(number).block, machine_, line_length(number)); };
  }
  // mm of the merged line that begins with a block; of another block its own. One that was merged before it
  // was pushed comes without those that follow.
  [[nodiscard]] Scalar line_length(std::int64_t number) const {
    Scalar length = slot(number).block.path.length();
    if (number > 0 && slot(number - 1).block.straight_on) return length;
    const std::int64_t pushed = pushed_.load(std::memory_order_relaxed);
    while (slot(number).block.straight_on && number + 1 < pushed)
      length += slot(++number).block.path.length();
    return length;
  }

  // Merging changes blocks that are not ready, so the other thread must not look at one.
  void tell_start(const B& block) {
    const Start start{block.path.position_at(Scalar(0)), tool_point(block.path, Scalar(0), tool_).position};
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

  // The next cell, or a block that has none. False where there is nothing to cut.
  bool make() {
    if (failed()) return false;
    if (next_) return waiting_ = std::exchange(next_, std::nullopt), true;
    if (maker_.done()) {
      if (begun_ == smoothing_.known()) return false;
      const B& block = slot(begun_).block;
      if (const auto ok = begin(block); !ok) return fail({ok.error(), block.line, block.column, {}}), false;
      ++begun_;
      if (maker_.done()) {
        if (block.exact_stop || block.pause > Scalar(0)) waiting_ = stop(block);
        return true;
      }
    }
    const B& block = slot(begun_ - 1).block;
    if (const auto ok = maker_.next(); !ok) return fail({ok.error(), block.line, block.column, {}}), false;
    auto cell = maker_.cell();
    if (cell.part.to <= skipped_ && !maker_.done()) return true;
    if (cell.part.from < skipped_) {
      cell.part.from = std::min(skipped_, cell.part.to);
      cell.entry = Scalar(0);
    }
    waiting_ = played(block, cell);
    if (!(cell.rest > Scalar(0))) return true;
    next_ = waiting_;
    waiting_ = rest(block, cell.rest);
    return true;
  }

  Expected<void> begin(const B& block) {
    const Driven driven = path(begun_);
    if (auto ok = maker_.begin(block, driven, smoothing_.passing(begun_)); !ok) return ok;
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
  [[nodiscard]] bool near(const B& block, const Vector& place, const Vector& there) const {
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

  [[nodiscard]] Cell played(const B& block, const BasicCell<Scalar>& cell) const {
    const auto& [from, to, limits] = cell.part;
    const bool last = maker_.done();
    Cell result = common(block);
    result.caps = {to - from, cell.entry, finite_limits(limits), last ? block.pause : Scalar(0)};
    result.goes_on = !last || block.goes_on;
    result.from = from;
    result.feed = !block.rapid && std::isfinite(block.feed)
                      ? block.feed
                      : std::min(maker_.wanted_speed(), limits.velocity);
    const BasicLimits<Scalar> above = finite_limits(cell.above);
    result.above = {std::max(above.velocity, limits.velocity),
                    std::min(above.acceleration, result.caps.limits.acceleration),
                    std::min(above.jerk, result.caps.limits.jerk)};
    return result;
  }

  // A rest on the way. Its limits play no part.
  [[nodiscard]] Cell rest(const B& block, Scalar seconds) const {
    Cell result = common(block);
    result.caps = {Scalar(0), Scalar(0), {Scalar(1), Scalar(1), Scalar(1)}, seconds};
    result.feed = Scalar(1);
    return result;
  }

  // A block that is a place to stop.
  [[nodiscard]] Cell stop(const B& block) const {
    Cell result = rest(block, block.pause);
    result.optional_stop = block.word.letter == 'M' && block.word.number == 1;
    result.program_stop = block.word.letter == 'M' && (block.word.number == 0 || block.word.number == 60);
    return result;
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
  CellMaker<M, B, junction::BasicDeviation<Scalar>> maker_;
  LineMerger<M, B> merger_;
  SmoothingAhead<M, B, room, neighbours_for(room)> smoothing_;
  std::array<Slot, room> slots_{};
  Start start_{};
  std::optional<Cell> waiting_;  // for room
  std::optional<Cell> next_;     // behind that
  std::optional<Vector> place_;  // where the motion begins, on the next block
  int first_line_ = 0;           // blocks before it are passed over
  Scalar skipped_{};             // mm of the block before the place where the motion begins
  Scalar length_{};              // mm of all blocks pushed
  std::int64_t begun_ = 0;       // blocks of which cells have been made
  gcode::Diagnostic fault_{};
  std::atomic<bool> failed_{false};
  std::atomic<bool> waits_{false};  // the machine rests, and blocks are held back
  std::atomic<std::int64_t> pushed_{0};
  std::atomic<std::int64_t> ready_{0};
  std::atomic<std::int64_t> needed_{0};
};

}  // namespace cncplan::plan
