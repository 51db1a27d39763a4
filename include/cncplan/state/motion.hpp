// The motion of one axis over time, as a value.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <optional>
#include <span>

#include "cncplan/core/axis_state.hpp"
#include "cncplan/core/detail/jerk_phase.hpp"
#include "cncplan/core/phase.hpp"

namespace cncplan::state {

/// Phases of constant jerk, so many at most, from one state to another; forwards and backwards. Trivially
/// copyable; the default stands still for no time.
template <std::floating_point S, std::size_t Most = 15>
class BasicMotion {
 public:
  using Scalar = S;
  using State = BasicAxisState<S>;
  using Phase = BasicJerkPhase<S>;

  static constexpr std::size_t most_phases = Most;

  constexpr BasicMotion() = default;
  /// No phases yet: `append` adds them. What they add up to is `end` but for rounding.
  constexpr BasicMotion(const State& start, const State& end) : start_(start), end_(end) {}

  /// One of another room, which its phases have to fit in.
  template <std::size_t Other>
    requires(Other < Most)
  constexpr explicit BasicMotion(const BasicMotion<S, Other>& other)
      : start_(other.start()), end_(other.end()) {
    for (const Phase& phase : other.phases()) append(phase);
  }

  /// Begins anew. A motion is large: who makes one writes it where it stays.
  constexpr void reset(const State& start, const State& end) {
    start_ = start, end_ = end;
    duration_ = S(0);
    count_ = 0;
  }

  /// Adds phases that there is room for, but none that takes no time.
  template <std::same_as<Phase>... P>
  constexpr void append(const Phase& first, const P&... others) {
    std::size_t count = count_;  // in a register, as the phases may lie anywhere
    S duration = duration_;
    const auto add = [&](const Phase& phase) {
      const bool lasts = phase.duration > S(0);  // without a branch: which ones last is hard to foretell
      phases_[count] = phase;
      duration += lasts ? phase.duration : S(0);
      count += lasts && count < most_phases ? 1 : 0;
    };
    add(first);
    (add(others), ...);
    count_ = count;
    duration_ = duration;
  }

  /// Adds phases that take time, as long as `next(phase)` makes one and there is room.
  template <class Next>
  constexpr void append_while(Next&& next) {
    std::size_t count = count_;
    S duration = duration_;
    while (count < most_phases && next(phases_[count])) duration += phases_[count++].duration;
    count_ = count;
    duration_ = duration;
  }

  [[nodiscard]] constexpr S duration() const { return duration_; }
  [[nodiscard]] constexpr const State& start() const { return start_; }
  [[nodiscard]] constexpr const State& end() const { return end_; }
  /// They lie in the motion.
  [[nodiscard]] constexpr std::span<const Phase> phases() const& { return {phases_.data(), count_}; }
  void phases() const&& = delete;

  /// State at t; before the start the state there, behind the end on from there at its acceleration.
  [[nodiscard]] constexpr State at(S t) const {
    if (t >= duration_) return Phase{S(0), end_.acceleration, S(0)}.after(end_, t - duration_);
    if (!(t > S(0))) return start_;
    State state = start_;
    for (const Phase& phase : phases()) {
      if (t < phase.duration) return phase.after(state, t);
      state = phase.after(state, phase.duration);
      t -= phase.duration;
    }
    return end_;
  }

  /// From t on; none before the start is asked for, and behind the end there is none.
  [[nodiscard]] constexpr S jerk_at(S t) const {
    for (const Phase& phase : phases()) {
      if (t < phase.duration) return phase.jerk;
      t -= phase.duration;
    }
    return S(0);
  }

  struct Extrema {
    S lowest{};
    S highest{};
  };

  /// Lowest and highest position between start and end.
  [[nodiscard]] Extrema extrema() const {
    Extrema found{std::min(start_.position, end_.position), std::max(start_.position, end_.position)};
    each_way([&](const BasicPhase<S>&, S, S to) {
      found.lowest = std::min(found.lowest, to);
      found.highest = std::max(found.highest, to);
      return false;
    });
    return found;
  }

  /// The time at which a position is first reached; none if it is not reached before the end.
  [[nodiscard]] std::optional<S> time_at(S position) const {
    if (position == start_.position) return S(0);
    std::optional<S> found;
    each_way([&](const BasicPhase<S>& way, S from, S to) {
      if (!(std::min(from, to) <= position && position <= std::max(from, to))) return false;
      found = way.time + way.tau_at(std::abs(position - from));
      return true;
    });
    if (!found && position == end_.position) return duration_;
    return found;
  }

  friend constexpr bool operator==(const BasicMotion& a, const BasicMotion& b) {
    const auto one = a.phases();
    const auto other = b.phases();
    return a.start_ == b.start_ && a.end_ == b.end_ &&
           std::equal(one.begin(), one.end(), other.begin(), other.end());
  }

 private:
  // Calls `visit(way, from, to)` for every part on which the axis goes one way, until it returns true: the
  // part turned forwards, with its distance counted from 0, and the positions at its ends.
  template <class Visit>
  void each_way(Visit&& visit) const {
    State state = start_;
    S time{};
    for (const Phase& phase : phases()) {
      const S a = phase.acceleration, j = phase.jerk;
      std::array<S, 4> marks{S(0), S(0), S(0), phase.duration};
      // where the velocity is zero: v + a t + j t^2/2
      const S square = a * a - S(2) * j * state.velocity;
      if (square > S(0)) {
        const S q = -(a + std::copysign(std::sqrt(square), a));
        const S one = q == S(0) ? S(0) : S(2) * state.velocity / q;
        const S other = j == S(0) ? S(0) : q / j;
        marks[1] = std::clamp(std::min(one, other), S(0), phase.duration);
        marks[2] = std::clamp(std::max(one, other), S(0), phase.duration);
      }
      for (std::size_t i = 0; i + 1 < marks.size(); ++i) {
        const S lasts = marks[i + 1] - marks[i];
        if (!(lasts > S(0))) continue;
        const State from = phase.after(state, marks[i]);
        const State to = phase.after(state, marks[i + 1]);
        const S sign = to.position < from.position ? S(-1) : S(1);
        const BasicPhase<S> way{time + marks[i],          lasts,   S(0), std::max(S(0), sign * from.velocity),
                                sign * from.acceleration, sign * j};
        if (visit(way, from.position, to.position)) return;
      }
      state = phase.after(state, phase.duration);
      time += phase.duration;
    }
  }

  State start_{};
  State end_{};
  S duration_{};
  std::size_t count_{};
  std::array<Phase, most_phases + 1> phases_{};  // the last place takes what is left out
};

using Motion = BasicMotion<double>;

}  // namespace cncplan::state
