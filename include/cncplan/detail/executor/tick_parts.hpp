// What a tick of a clock is made of (set-up).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "cncplan/core/detail/fixed_list.hpp"
#include "cncplan/detail/executor/trajectory_clock.hpp"

namespace cncplan::detail {

/// The parts of the last tick, rests left out. `Clock`: a `TrajectoryClock`.
template <class Clock>
class TickParts {
 public:
  using S = typename Clock::S;
  using Ramp = typename Clock::Ramp;

  static constexpr std::size_t most = 8;  ///< what a tick does beyond them is not told

  /// s from the start of the tick.
  struct Part {
    S start{}, duration{};
    const Ramp* ramp{};
    S elapsed{};  ///< of the ramp, where the part begins

    [[nodiscard]] BasicState<S> clock_at(const typename Clock::Chain& chain, S within) const {
      return ramp->at(chain, elapsed + within);
    }
  };
  using List = FixedList<Part, most>;

  TickParts() = default;
  TickParts(const TickParts&) = delete;
  TickParts& operator=(const TickParts&) = delete;

  /// Another tick begins.
  void clear() { parts_.clear(); }
  /// The clock begins anew.
  void reset() {
    clear();
    kept_number_ = -1;
  }
  /// A part that the clock has just driven, if there is room.
  void add(S start, S duration, const Clock& clock) {
    if (parts_.full()) return;
    const S begun = clock.standing() ? clock.elapsed() : clock.elapsed() - duration;
    parts_.push_back({start, duration, &keep(clock), begun});
  }

  [[nodiscard]] const List& list() const { return parts_; }
  /// The part that a time of the tick lies in, or the nearest. There has to be one.
  [[nodiscard]] const Part& at(S seconds) const {
    std::size_t i = 0;
    while (i + 1 < parts_.size() && seconds > parts_[i].start + parts_[i].duration) ++i;
    return parts_[i];
  }

 private:
  // The clock's ramp as it is now. One is large, and most ticks have that of the tick before.
  const Ramp& keep(const Clock& clock) {
    if (kept_number_ != clock.ramp_number()) {
      kept_number_ = clock.ramp_number();
      kept_ = (kept_ + 1) % most;
      ramps_[kept_] = clock.ramp();
    }
    return ramps_[kept_];
  }

  List parts_;
  std::array<Ramp, most> ramps_{};
  std::size_t kept_ = 0;  // the last one of these, and its number
  std::int64_t kept_number_ = -1;
};

}  // namespace cncplan::detail
