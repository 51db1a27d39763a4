// SPDX-License-Identifier: GPL-2.0-or-later
// The moves that wait and run, and as many behind them as can be run backwards.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "move.hpp"

namespace cncplan::linuxcnc {

/// Moves by their number, counted from 0 since the last `clear`.
class MoveQueue {
 public:
  static constexpr std::int64_t room = 2048;
  static constexpr std::int64_t kept_behind = 512;
  static constexpr std::int64_t spare = 64;  ///< LinuxCNC may send some more once it was told of a full queue

  void clear() { end_ = current_ = 0; }
  [[nodiscard]] bool empty() const { return current_ >= end_; }
  /// Behind the last move.
  [[nodiscard]] std::int64_t end() const { return end_; }
  /// The one that runs, or runs next; `end` where there is none.
  [[nodiscard]] std::int64_t current() const { return current_; }
  void set_current(std::int64_t number) { current_ = number; }
  [[nodiscard]] std::int64_t waiting() const { return end_ - current_; }

  [[nodiscard]] bool should_wait() const { return waiting() >= room - kept_behind - spare; }
  [[nodiscard]] bool has_room() const { return waiting() < room - kept_behind; }

  /// A slot for the next move; `push` takes what stands there.
  [[nodiscard]] Move& next() { return moves_[slot(end_)]; }
  void push() { ++end_; }
  [[nodiscard]] Move& operator[](std::int64_t number) { return moves_[slot(number)]; }

 private:
  [[nodiscard]] static std::size_t slot(std::int64_t number) {
    return static_cast<std::size_t>(number % room);
  }

  std::array<Move, static_cast<std::size_t>(room)> moves_{};
  std::int64_t end_ = 0;
  std::int64_t current_ = 0;
};

}  // namespace cncplan::linuxcnc
