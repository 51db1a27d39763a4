// Where axes with backlash turn round, on a program's way from block to block (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <vector>

#include "cncplan/core/limits.hpp"
#include "cncplan/plan/machine.hpp"
#include "cncplan/plan/reversal.hpp"
#include "cncplan/plan/steppable.hpp"
#include "cncplan/step/drive.hpp"

namespace cncplan::plan {

/// A place in a block where an axis turns round.
template <std::floating_point S>
struct BasicTurning {
  S at{};    ///< length from the block's start; 0 for the joint before it
  S rate{};  ///< the axis' first and second derivative by length behind it
  S bend{};
  BasicReversalRule<S> rule;

  /// The highest speed there, under limits along the path behind it.
  [[nodiscard]] S speed(const BasicLimits<S>& limits) const {
    return reversal_speed(rate, bend, limits.acceleration, rule);
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
class Turnings {
 public:
  using Scalar = typename M::Scalar;
  using Turning = BasicTurning<Scalar>;

  explicit Turnings(const M& machine) {
    for (std::size_t i = 0; i < rules_.size(); ++i)
      for (const step::BasicDrive<Scalar>& drive : machine.axes[i].motors) {
        const Scalar time = step::backlash_time(drive);
        if (time > rules_[i].time) rules_[i] = {time, step::hysteresis(drive) / drive.steps_per_unit};
      }
  }

  /// The turnings of the next block's path, in order.
  template <class Segment>
  [[nodiscard]] const std::vector<Turning>& next(const Segment& path) {
    found_.clear();
    for (std::size_t i = 0; i < rules_.size(); ++i)
      if (rules_[i].time > Scalar(0)) follow(path, static_cast<int>(i));
    std::sort(found_.begin(), found_.end(), [](const Turning& a, const Turning& b) { return a.at < b.at; });
    return found_;
  }

 private:
  template <class Segment>
  void follow(const Segment& path, int axis) {
    const SteppableSegment<Segment> steppable(path);
    const Scalar end = steppable.parameter_end();
    const auto k = static_cast<std::size_t>(axis);
    for (Scalar from = Scalar(0); from < end;) {
      const Scalar next = steppable.next_turning(axis, from);
      const Scalar to = next > from ? std::min(next, end) : end;
      if (const int goes = sense(steppable.position(to)[axis] - steppable.position(from)[axis]); goes != 0) {
        if (goes == -went_[k]) {
          const Scalar at = from > Scalar(0) ? steppable.length_at(from) : Scalar(0);
          const auto point = path.point_at(at);
          found_.push_back(
              {at, at > Scalar(0) ? Scalar(0) : point.first[axis], point.second[axis], rules_[k]});
        }
        went_[k] = goes;
      }
      from = to;
    }
  }

  // Which way an axis goes: +1, -1, or 0 where it stands still but for rounding.
  static int sense(Scalar travel) {
    constexpr Scalar rounding = std::max(Scalar(1e-9), Scalar(16) * std::numeric_limits<Scalar>::epsilon());
    return travel > rounding ? 1 : travel < -rounding ? -1 : 0;
  }

  std::array<BasicReversalRule<Scalar>, static_cast<std::size_t>(M::axis_count)> rules_{};
  std::array<int, static_cast<std::size_t>(M::axis_count)> went_{};
  std::vector<Turning> found_;
};

}  // namespace cncplan::plan
