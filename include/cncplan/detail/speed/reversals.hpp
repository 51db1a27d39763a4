// Where axes with backlash turn round, on a program's way from block to block.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>

#include "cncplan/core/limits.hpp"
#include "cncplan/detail/steppable.hpp"
#include "cncplan/machine.hpp"
#include "cncplan/step/drive.hpp"
#include "cncplan/step/reversal.hpp"

namespace cncplan::detail {

/// A place in a block where an axis turns round.
template <std::floating_point S>
struct BasicReversal {
  S at{};    ///< length from the block's start; 0 for the junction before it
  S rate{};  ///< the axis' first and second derivative by length behind it
  S bend{};
  step::BasicReversalRule<S> rule;

  /// The highest speed there, under limits along the path behind it.
  [[nodiscard]] S speed(const BasicLimits<S>& limits) const {
    return step::reversal_speed(rate, bend, limits.acceleration, rule);
  }
  /// s at rest that are needed there where the motion stops.
  [[nodiscard]] S pause(const BasicLimits<S>& limits) const {
    const S t = rule.time;
    const S way = std::min(limits.acceleration * t * t / S(2), limits.jerk * t * t * t / S(6));
    return std::abs(rate) * way > rule.distance ? t : S(0);
  }
};

/// Follows the axes of a machine whose motors have backlash along the blocks of a program.
template <MachineModel M>
class Reversals {
 public:
  using Scalar = typename M::Scalar;
  using Reversal = BasicReversal<Scalar>;

  explicit Reversals(const M& machine) {
    for (std::size_t i = 0; i < axes_.size(); ++i)
      for (const step::BasicDrive<Scalar>& drive : machine.axes[i].motors) {
        const Scalar time = step::backlash_time(drive);
        if (time > axes_[i].rule.time) axes_[i].rule = {time, step::hysteresis(drive) / drive.steps_per_unit};
        any_ = any_ || time > Scalar(0);
      }
  }

  /// Begins with the next path; it is to stay until its reversals are taken.
  template <Path P>
  void begin(const P& path) {
    if (!any_) return;
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      axes_[i].from = Scalar(0);
      axes_[i].next = never;
      if (axes_[i].rule.time > Scalar(0)) look_on(path, i);
    }
  }

  /// Where the next one is, infinite where there is none.
  [[nodiscard]] Scalar next() const { return any_ ? axes_[nearest()].next : never; }

  /// Takes it from the path.
  template <Path P>
  [[nodiscard]] Reversal take(const P& path) {
    const std::size_t i = nearest();
    const Scalar at = axes_[i].next;
    const auto k = static_cast<int>(i);
    const auto point = path.point_at(at);
    look_on(path, i);
    return {at, at > Scalar(0) ? Scalar(0) : point.first[k], point.second[k], axes_[i].rule};
  }

 private:
  static constexpr Scalar never = std::numeric_limits<Scalar>::infinity();

  struct Axis {
    step::BasicReversalRule<Scalar> rule{};
    int went{};     // +1 or -1, at last
    Scalar from{};  // parameter up to which it has been followed
    Scalar next{never};
  };

  [[nodiscard]] std::size_t nearest() const {
    const auto sooner = [](const Axis& a, const Axis& b) { return a.next < b.next; };
    return static_cast<std::size_t>(std::min_element(axes_.begin(), axes_.end(), sooner) - axes_.begin());
  }

  template <class Segment>
  void look_on(const Segment& path, std::size_t i) {
    Axis& axis = axes_[i];
    const int k = static_cast<int>(i);
    const SteppableSegment<Segment> steppable(path);
    const Scalar end = steppable.parameter_end();
    axis.next = never;
    while (axis.from < end && axis.next == never) {
      const Scalar turn = steppable.next_reversal(k, axis.from);
      const Scalar to = turn > axis.from ? std::min(turn, end) : end;
      if (const int goes = sense(steppable.position(to)[k] - steppable.position(axis.from)[k]); goes != 0) {
        if (goes == -axis.went)
          axis.next = axis.from > Scalar(0) ? steppable.length_at(axis.from) : Scalar(0);
        axis.went = goes;
      }
      axis.from = to;
    }
  }

  // Which way an axis goes: +1, -1, or 0 where it stands still but for rounding.
  static int sense(Scalar travel) {
    constexpr Scalar rounding = std::max(Scalar(1e-9), Scalar(16) * std::numeric_limits<Scalar>::epsilon());
    return travel > rounding ? 1 : travel < -rounding ? -1 : 0;
  }

  std::array<Axis, static_cast<std::size_t>(M::axis_count)> axes_{};
  bool any_ = false;  // of them has backlash
};

}  // namespace cncplan::detail
