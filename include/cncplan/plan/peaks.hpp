// The most that a trajectory asks of each axis and of the tool (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "cncplan/core/jet.hpp"
#include "cncplan/core/limits.hpp"
#include "cncplan/plan/trajectory.hpp"

namespace cncplan {

/// Largest magnitudes inside blocks; what jumps at a joint between two of them is not in it.
template <std::floating_point S, int N>
struct BasicPeaks {
  VectorN<S, N> velocity = VectorN<S, N>::Zero();
  VectorN<S, N> acceleration = VectorN<S, N>::Zero();
  VectorN<S, N> jerk = VectorN<S, N>::Zero();
  BasicLimits<S> tool{S(0), S(0), S(0)};   ///< of the tool's vectors
  BasicLimits<S> along{S(0), S(0), S(0)};  ///< of the motion along the path
};

namespace detail {

/// Looks for peaks in one phase after the other. A stretch of a phase whose bounds are no higher than what
/// has been found is passed over; any other is halved. The bound of a jerk is that of the interval;
/// accelerations and velocities are no farther from those in the middle than the bounds of their rates let
/// them go, which is sharp where they are at their highest. Behind a map, the tool's peaks are those of the
/// places that the search for the axes' looks at.
template <class T>
class PeakSearch {
 public:
  using Scalar = typename T::Scalar;
  static constexpr int n = T::MachineType::axis_count;
  using Peaks = BasicPeaks<Scalar, n>;

  explicit PeakSearch(const T& trajectory)
      : trajectory_(trajectory),
        tool_axes_(tool_axes(trajectory.machine())),
        rounding_(std::max(Scalar(1e-11),
                           Scalar(16) * std::numeric_limits<Scalar>::epsilon() * trajectory.length())) {}

  [[nodiscard]] Peaks search() {
    for (const auto& [phase, block] : trajectory_.phases())
      if (const auto path = trajectory_.path(block);
          phase.duration > Scalar(0) && path.length() > Scalar(0)) {
        if (path.exact())
          search(path.programmed(), phase);
        else
          search(path, phase);
      }
    return peaks_;
  }

 private:
  // A bound counts as no higher than what was found if it is so but for this part. Velocities and
  // accelerations are bounded sharply; jerks are not, and their peaks lie mostly at the ends of phases.
  static constexpr Scalar tolerance = Scalar(1e-7);
  static constexpr Scalar jerk_tolerance = Scalar(1e-4);

  template <class P>
  void search(const P& path, const BasicPhase<Scalar>& phase) {
    constexpr int deepest = 11;
    struct Stretch {
      Scalar from, to;
      int depth;
    };
    std::array<Stretch, static_cast<std::size_t>(deepest + 1)> open;
    std::size_t count = 0;
    (void)look(path, phase, Scalar(0));
    (void)look(path, phase, phase.duration);
    open[count++] = {Scalar(0), phase.duration, 0};
    while (count > 0) {
      const auto [from, to, depth] = open[--count];
      const Scalar middle = from + (to - from) / Scalar(2);
      const Look seen = look(path, phase, middle);
      if (depth == deepest || !may_exceed(path, phase, from, to, seen)) continue;
      open[count++] = {middle, to, depth + 1};
      open[count++] = {from, middle, depth + 1};
    }
  }

  // The axes' motion at an instant, and the tool's.
  struct Look {
    AxisMotion<VectorN<Scalar, n>> axes;
    AxisMotion<BasicVector3<Scalar>> tool;
  };

  // Third derivatives step where corrections change their form, which is where phases end: the path is looked
  // at a little inside.
  template <class P>
  Look look(const P& path, const BasicPhase<Scalar>& phase, Scalar tau) {
    BasicState<Scalar> along = phase.at(tau);
    const Scalar end = phase.at(phase.duration).position;
    const auto [low, high] = std::minmax(phase.position, end);
    const Scalar inside = std::min((high - low) / Scalar(2), rounding_);
    along.position = std::clamp(along.position, low + inside, high - inside);
    along.position = std::clamp(along.position, Scalar(0), path.length());
    const Look seen{motion(path.point_at(along.position), along),
                    motion(tool_point(path, along.position, tool_axes_), along)};
    const auto& [axes, tool] = seen;
    peaks_.velocity = peaks_.velocity.cwiseMax(axes.velocity.cwiseAbs());
    peaks_.acceleration = peaks_.acceleration.cwiseMax(axes.acceleration.cwiseAbs());
    peaks_.jerk = peaks_.jerk.cwiseMax(axes.jerk.cwiseAbs());
    grow(peaks_.tool, tool.velocity.norm(), tool.acceleration.norm(), tool.jerk.norm());
    grow(peaks_.along, std::abs(along.velocity), std::abs(along.acceleration), std::abs(along.jerk));
    return seen;
  }

  static void grow(BasicLimits<Scalar>& peak, Scalar velocity, Scalar acceleration, Scalar jerk) {
    peak.velocity = std::max(peak.velocity, velocity);
    peak.acceleration = std::max(peak.acceleration, acceleration);
    peak.jerk = std::max(peak.jerk, jerk);
  }

  using I = BasicInterval<Scalar>;
  struct Motion {
    I velocity, acceleration, jerk;
  };

  // What an axis may do while the path and the motion along it lie in these intervals.
  static Motion enclose(const BasicJet<I>& axis, const I& v, const I& a, Scalar j) {
    const I v2 = square(v);
    return {axis.first * v, axis.second * v2 + axis.first * a,
            axis.third * (v * v2) + axis.second * (I(Scalar(3)) * v * a) + axis.first * I(j)};
  }

  [[nodiscard]] static bool beyond(Scalar bound, Scalar found, Scalar part = tolerance) {
    constexpr Scalar tiny = Scalar(1e-9);
    return bound > found * (Scalar(1) + part) + tiny;
  }

  template <class P>
  [[nodiscard]] bool may_exceed(const P& path, const BasicPhase<Scalar>& phase, Scalar from, Scalar to,
                                const Look& middle) const {
    const BasicState<Scalar> first = phase.at(from), last = phase.at(to);
    I v = I::hull(first.velocity, last.velocity);
    const Scalar top = phase.jerk != Scalar(0) ? -phase.acceleration / phase.jerk : from;
    if (top > from && top < to) v = I::hull(v.low, v.high, phase.at(top).velocity);
    if (beyond(v.largest(), peaks_.along.velocity)) return true;
    const I a = I::hull(first.acceleration, last.acceleration);
    const auto [low, high] = std::minmax(first.position, last.position);
    const auto axes =
        path.enclosure(std::clamp(low, Scalar(0), path.length()), std::clamp(high, Scalar(0), path.length()));
    const Scalar half = (to - from) / Scalar(2);
    BasicLimits<Scalar> tool_sq{Scalar(0), Scalar(0), Scalar(0)};
    for (int i = 0; i < n; ++i) {
      const Motion bound = enclose(axes[static_cast<std::size_t>(i)], v, a, phase.jerk);
      const Scalar jerk = bound.jerk.largest();
      const Scalar acceleration =
          std::min(bound.acceleration.largest(), std::abs(middle.axes.acceleration[i]) + half * jerk);
      const Scalar velocity =
          std::min(bound.velocity.largest(), std::abs(middle.axes.velocity[i]) + half * acceleration);
      if (beyond(velocity, peaks_.velocity[i]) || beyond(acceleration, peaks_.acceleration[i]) ||
          beyond(jerk, peaks_.jerk[i], jerk_tolerance))
        return true;
      if (MappedModel<typename T::MachineType> ||
          std::find(tool_axes_.begin(), tool_axes_.end(), i) == tool_axes_.end())
        continue;
      tool_sq.velocity += velocity * velocity;
      tool_sq.acceleration += acceleration * acceleration;
      tool_sq.jerk += jerk * jerk;
    }
    if constexpr (MappedModel<typename T::MachineType>) return false;
    const Scalar jerk = std::sqrt(tool_sq.jerk);
    const Scalar acceleration =
        std::min(std::sqrt(tool_sq.acceleration), middle.tool.acceleration.norm() + half * jerk);
    const Scalar velocity =
        std::min(std::sqrt(tool_sq.velocity), middle.tool.velocity.norm() + half * acceleration);
    return beyond(velocity, peaks_.tool.velocity) || beyond(acceleration, peaks_.tool.acceleration) ||
           beyond(jerk, peaks_.tool.jerk, jerk_tolerance);
  }

  const T& trajectory_;
  std::array<int, 3> tool_axes_;
  Scalar rounding_;  // mm, of a length along the program
  Peaks peaks_;
};

}  // namespace detail

/// The largest magnitudes of a trajectory: sampled ones could miss a peak. Velocities and accelerations are
/// right to 1e-7 of themselves and jerks to 1e-4 where intervals are sharp (lines and arcs).
template <MachineModel M, BlockModel B>
[[nodiscard]] BasicPeaks<typename M::Scalar, M::axis_count> peaks(const Trajectory<M, B>& trajectory) {
  return detail::PeakSearch<Trajectory<M, B>>(trajectory).search();
}

/// What jumps at the joints between blocks.
template <std::floating_point S, int N>
struct BasicJointJumps {
  VectorN<S, N> velocity = VectorN<S, N>::Zero();  ///< of each axis, at most
  std::size_t accelerations{};  ///< joints that are passed in motion and where some axis' acceleration jumps
};

/// Looks at every joint; what rounding leaves is no jump: of a velocity 1e-6 mm/s, of an acceleration 1e-3
/// mm/s^2 (on pieces of a micrometre it comes near that).
template <MachineModel M, BlockModel B>
[[nodiscard]] BasicJointJumps<typename M::Scalar, M::axis_count> joint_jumps(
    const Trajectory<M, B>& trajectory) {
  using S = typename M::Scalar;
  constexpr S rounding = S(1e-6);
  BasicJointJumps<S, M::axis_count> jumps;
  const auto phases = trajectory.phases();
  for (std::size_t i = 1; i < phases.size(); ++i) {
    const auto& [before, block] = phases[i - 1];
    const auto& [after, next] = phases[i];
    if (block == next || !(after.velocity > S(0))) continue;
    const auto left = trajectory.path(block), entered = trajectory.path(next);
    if (!(left.length() > S(0) && entered.length() > S(0))) continue;
    const BasicState<S> along{S(0), after.velocity, after.acceleration, S(0)};
    const auto end = motion(left.point_at(left.length()), along);
    const auto start = motion(entered.point_at(S(0)), along);
    const VectorN<S, M::axis_count> step = (end.velocity - start.velocity).cwiseAbs();
    jumps.velocity = jumps.velocity.cwiseMax(step);
    const VectorN<S, M::axis_count> jump = (end.acceleration - start.acceleration).cwiseAbs();
    if (step.maxCoeff() > rounding ||
        (jump.array() > S(1e-3) + rounding * end.acceleration.cwiseAbs().array()).any())
      ++jumps.accelerations;
  }
  return jumps;
}

/// The largest jump of any axis' velocity at a joint between two blocks.
template <MachineModel M, BlockModel B>
[[nodiscard]] typename M::Scalar corner_velocity_step(const Trajectory<M, B>& trajectory) {
  return joint_jumps(trajectory).velocity.maxCoeff();
}

}  // namespace cncplan
