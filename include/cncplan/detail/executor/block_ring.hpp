// The blocks of a machine that runs, in a ring between the thread that makes them and the one that ticks.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "cncplan/core/detail/ring_places.hpp"
#include "cncplan/detail/executor/shared_count.hpp"
#include "cncplan/detail/speed/segment_limits.hpp"

namespace cncplan::detail {

/// A block as real-time control needs it, a cell of one that `Executor` was given. The limits in
/// `segment_limits` hold for speeds up to the feed; its velocity is what shape and axes bear. Domain, which
/// is not checked: a finite length >= 0, limits that `validate` accepts and whose jerk is finite, entry and
/// pause finite, >= 0. A block of no length waits where it stands: the motion rests before it, as its entry
/// says, and behind it. A feed that is not positive, or NaN, is never run: the motion rests before it.
template <std::floating_point S>
struct BasicMotionBlock {
  BasicSegmentLimits<S> segment_limits;
  S feed{};              ///< mm/s, what the override acts on
  bool rapid{};          ///< obeys the rapid override
  bool optional_stop{};  ///< the motion stops behind it where that is switched on (M1)
  int line{};            ///< of the program, for pauses
  bool goes_on{};       ///< no single step ends here: the next one is of the same block, or it is words alone
  bool program_stop{};  ///< the motion stops behind it where that is switched on (M0)
  /// Limits up to the highest override of the feed: velocity not below, acceleration and jerk not above those
  /// of `segment_limits`. A velocity of 0: those of `segment_limits`.
  BasicLimits<S> above{S(0), S(0), S(0)};
  std::int64_t block{};  ///< number of the block of the program that it is a cell of
  S from{};              ///< mm from the start of that block to its own

  friend bool operator==(const BasicMotionBlock&, const BasicMotionBlock&) = default;
};

using MotionBlock = BasicMotionBlock<double>;

/// A place on the path: a block, and the distance from the end at which it is entered in the direction of
/// travel.
template <std::floating_point S>
struct BasicPlace {
  std::int64_t block{};
  S along{};

  friend bool operator==(const BasicPlace&, const BasicPlace&) = default;
};

/// Blocks by their number in the program. One thread pushes, another looks and releases; neither waits. A
/// block stays as it is from `push` until it is released. (The two counters are those of `Queue`, except that
/// what was taken stays until it is released.)
template <std::floating_point S>
class BlockRing {
 public:
  using Block = BasicMotionBlock<S>;

  explicit BlockRing(std::span<Block> memory) : memory_(memory), places_(memory.size()) {}

  /// For the thread that pushes: false, and nothing done, when there is no room.
  bool push(const Block& block) {
    const std::int64_t number = pushed_.load();
    if (number - released_.load() >= capacity()) return false;
    memory_[write_] = block;
    write_ = write_ + 1 < memory_.size() ? write_ + 1 : 0;
    pushed_.store(number + 1);
    return true;
  }

  /// How many blocks there have been, for either thread.
  [[nodiscard]] std::int64_t pushed() const { return pushed_.load(); }

  // For the thread that looks.
  /// Takes notice of what was pushed; whether there is anything new.
  bool take() {
    const std::int64_t end = pushed_.load();
    return std::exchange(end_, end) != end;
  }
  /// Lets the blocks before a number go; whether there were any.
  bool release(std::int64_t number) {
    const std::int64_t oldest = std::min(number, end_);
    if (oldest <= oldest_) return false;
    oldest_ = oldest;
    places_.advance(oldest);
    released_.store(oldest);
    return true;
  }
  [[nodiscard]] std::int64_t oldest() const { return oldest_; }
  [[nodiscard]] std::int64_t end() const { return end_; }
  [[nodiscard]] std::int64_t capacity() const { return places_.size(); }
  [[nodiscard]] bool holds(std::int64_t number) const { return number >= oldest_ && number < end_; }
  [[nodiscard]] S length(std::int64_t number) const { return (*this)[number].segment_limits.length; }
  [[nodiscard]] const Block& operator[](std::int64_t number) const { return memory_[places_(number)]; }

  /// Forgets all blocks; the next one has this number. Not while anything is pushed.
  void restart(std::int64_t number) {
    places_.restart(number);
    oldest_ = end_ = number;
    write_ = 0;
    released_.store(number);
    pushed_.store(number);
  }

 private:
  std::span<Block> memory_;
  RingPlaces places_;
  std::size_t write_ = 0;  // where the next block goes
  std::int64_t oldest_ = 0;
  std::int64_t end_ = 0;
  SharedCount pushed_;
  SharedCount released_;
};

}  // namespace cncplan::detail
