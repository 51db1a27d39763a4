// The blocks of a machine that runs, in a ring, and places on them.
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>

#include "cncplan/plan/caps.hpp"

namespace cncplan::plan {

/// A block as real-time control needs it. The velocity in `caps.limits` is what its shape and its axes bear;
/// the feed is what the program asks for, and what the override acts on. Domain, which is not checked: a
/// finite length >= 0, limits that `validate` accepts and whose jerk is finite, entry and pause finite, >= 0.
/// A block of no length waits where it stands: the motion rests before it, as its entry says, and behind it.
/// A feed that is not positive, or NaN, is never run: the motion rests before it.
template <std::floating_point S>
struct BasicPlayedBlock {
  BasicBlockCaps<S> caps;
  S feed{};              ///< mm/s
  bool rapid{};          ///< obeys the rapid override
  bool optional_stop{};  ///< the motion stops behind it where that is switched on (M1)
  int line{};            ///< of the program, for pauses
  bool goes_on{};        ///< the next block belongs to the same motion: single steps do not end behind it

  friend bool operator==(const BasicPlayedBlock&, const BasicPlayedBlock&) = default;
};

using PlayedBlock = BasicPlayedBlock<double>;

/// A place on the path: a block, and the distance from the end at which it is entered in the direction of
/// travel.
template <std::floating_point S>
struct BasicSpot {
  std::int64_t block{};
  S along{};

  friend bool operator==(const BasicSpot&, const BasicSpot&) = default;
};

/// Blocks by their number in the program, the newest ones; older ones are overwritten when room is needed.
template <std::floating_point S>
class BlockRing {
 public:
  using Block = BasicPlayedBlock<S>;

  explicit BlockRing(std::span<Block> memory) : memory_(memory) {}

  [[nodiscard]] std::int64_t oldest() const { return oldest_; }
  [[nodiscard]] std::int64_t end() const { return end_; }
  [[nodiscard]] std::int64_t capacity() const { return static_cast<std::int64_t>(memory_.size()); }
  [[nodiscard]] bool holds(std::int64_t number) const { return number >= oldest_ && number < end_; }
  [[nodiscard]] S length(std::int64_t number) const { return (*this)[number].caps.length; }
  [[nodiscard]] const Block& operator[](std::int64_t number) const {
    return memory_[static_cast<std::size_t>(number % capacity())];
  }

  void push(const Block& block) {
    if (end_ - oldest_ == capacity()) ++oldest_;
    memory_[static_cast<std::size_t>(end_++ % capacity())] = block;
  }

  /// Forgets all blocks; the next one has this number.
  void restart(std::int64_t number) { oldest_ = end_ = number; }

 private:
  std::span<Block> memory_;
  std::int64_t oldest_ = 0;
  std::int64_t end_ = 0;
};

}  // namespace cncplan::plan
