// SPDX-License-Identifier: GPL-2.0-or-later
// A part of a program that cncplan runs: moves from one rest to the next.
#pragma once

#include <array>
#include <cstdint>

#include "move.hpp"
#include "settings.hpp"

namespace cncplan::linuxcnc {

/// Limits of the axes, mm or rad, and s; infinite for one that the machine lacks.
struct AxisLimits {
  Coordinates velocity = Coordinates::Zero();
  Coordinates acceleration = Coordinates::Zero();
};

/// What holds for the next tick.
struct Requests {
  double feed_share = 1.0;
  double rapid_share = 1.0;
  bool hold{};
  bool stop{};  ///< the part ends there
  bool backwards{};
  bool single_step{};  ///< rest behind every move until a hold has come and gone
};

/// Where the machine is, mm, rad and s.
struct PartState {
  Coordinates position = Coordinates::Zero();
  double velocity{};    ///< along the path
  bool at_rest{};       ///< neither velocity nor acceleration
  double along{};       ///< length since the part's start
  std::int64_t move{};  ///< counted from 0 at the part's start
  bool finished{};
};

class Part {
 public:
  Part() = default;
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;

  /// False where there is no room: again behind the next tick.
  [[nodiscard]] virtual bool push(const Move& move) = 0;
  /// Nothing follows, as far as is known; a `push` behind it goes on.
  virtual void end() = 0;
  [[nodiscard]] virtual PartState tick(double period, const Requests& requests) = 0;
  /// Whether a move cannot be planned; why, as a text, then. Keeps off the heap.
  [[nodiscard]] virtual bool failed(std::array<char, 256>& text) const = 0;
  /// It is over: nothing more is asked of it.
  virtual void leave() = 0;

 protected:
  ~Part() = default;
};

/// The part that runs. Its memory is there from the start, for all machines.
class RunningPart {
 public:
  ~RunningPart() { end(); }

  /// Ends what runs, and touches the memory, so that no servo cycle has to fetch it.
  void set_up();
  /// Ends the part before and begins another one, where the machine stands, mm and rad.
  void begin(const Settings& settings, const AxisLimits& limits, const Coordinates& place);
  void end();

  [[nodiscard]] explicit operator bool() const { return part_ != nullptr; }
  [[nodiscard]] Part* operator->() const { return part_; }

 private:
  Part* part_ = nullptr;
};

}  // namespace cncplan::linuxcnc
