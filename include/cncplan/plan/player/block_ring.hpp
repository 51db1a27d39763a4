// What lies ahead of a machine that runs: blocks in a ring, seen from where it stands, in the direction it
// goes.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "cncplan/plan/caps.hpp"
#include "cncplan/profile/seven_phase.hpp"

namespace cncplan::plan {

/// A block as real-time control needs it. The velocity in `caps.limits` is what its shape and its axes bear;
/// the feed is what the program asks for, and what the override acts on. Domain, which is not checked: a
/// finite length > 0, limits that `validate` accepts and whose jerk is finite, entry and pause finite, >= 0.
/// A feed that is not positive, or NaN, is never run: the motion rests before it.
template <std::floating_point S>
struct BasicPlayedBlock {
  BasicBlockCaps<S> caps;
  S feed{};              ///< mm/s
  bool rapid{};          ///< obeys the rapid override
  bool optional_stop{};  ///< the motion stops behind it where that is switched on (M1)
  int line{};            ///< of the program, for pauses

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

/// How far a plan has to look ahead: the way from rest to the highest speed and back. Beyond that nothing can
/// slow what comes next, as the motion can still come to rest before it. Each block is taken in as it is met.
template <std::floating_point S>
class Horizon {
 public:
  void take(const BasicLimits<S>& limits, S length) {
    travelled_ += length;
    if (limits.velocity <= limits_.velocity && limits.acceleration >= limits_.acceleration &&
        limits.jerk >= limits_.jerk)
      return;
    limits_ = {std::max(limits_.velocity, limits.velocity),
               std::min(limits_.acceleration, limits.acceleration), std::min(limits_.jerk, limits.jerk)};
    enough_ = S(2) * profile::seven_phase_law(limits_).distance(S(0), limits_.velocity);
  }

  [[nodiscard]] bool reached() const { return travelled_ > enough_; }

 private:
  BasicLimits<S> limits_{S(0), std::numeric_limits<S>::infinity(), std::numeric_limits<S>::infinity()};
  S travelled_{};
  S enough_{};
};

}  // namespace cncplan::plan
