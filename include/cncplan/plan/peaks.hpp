// The most that a trajectory asks of each axis and of the tool (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

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

/// Looks for peaks in one phase after the other. A stretch of a phase whose proven bounds are no higher than
/// what has been found is passed over; any other is halved.
template <class T>
class PeakSearch {
 public:
  using Scalar = typename T::Scalar;
  static constexpr int n = T::MachineType::axis_count;
  using Peaks = BasicPeaks<Scalar, n>;

  explicit PeakSearch(const T& trajectory)
      : trajectory_(trajectory), tool_axes_(tool_axes(trajectory.machine())) {}

  [[nodiscard]] Peaks search() {
    for (const auto& [phase, block] : trajectory_.phases())
      if (phase.duration > Scalar(0) && trajectory_.program()[block].path.length() > Scalar(0))
        search(trajectory_.program()[block].path, phase);
    return peaks_;
  }

 private:
  // What is found is right to this part of itself.
  static constexpr Scalar tolerance = Scalar(1e-5);

  template <class P>
  void search(const P& path, const BasicPhase<Scalar>& phase) {
    constexpr int deepest = 9;  // a maximum is flat: what is missed by then is below the tolerance
    struct Stretch {
      Scalar from, to;
      int depth;
    };
    std::array<Stretch, static_cast<std::size_t>(deepest + 1)> open;
    std::size_t count = 0;
    look(path, phase, Scalar(0));
    look(path, phase, phase.duration);
    open[count++] = {Scalar(0), phase.duration, 0};
    while (count > 0) {
      const Stretch stretch = open[--count];
      if (!may_exceed(path, phase, stretch.from, stretch.to) || stretch.depth == deepest) continue;
      const Scalar middle = stretch.from + (stretch.to - stretch.from) / Scalar(2);
      look(path, phase, middle);
      open[count++] = {middle, stretch.to, stretch.depth + 1};
      open[count++] = {stretch.from, middle, stretch.depth + 1};
    }
  }

  template <class P>
  void look(const P& path, const BasicPhase<Scalar>& phase, Scalar tau) {
    BasicState<Scalar> along = phase.at(tau);
    along.position = std::clamp(along.position, Scalar(0), path.length());
    const auto axes = motion(path.point_at(along.position), along);
    const auto tool = motion(tool_point(path, along.position, tool_axes_), along);
    peaks_.velocity = peaks_.velocity.cwiseMax(axes.velocity.cwiseAbs());
    peaks_.acceleration = peaks_.acceleration.cwiseMax(axes.acceleration.cwiseAbs());
    peaks_.jerk = peaks_.jerk.cwiseMax(axes.jerk.cwiseAbs());
    grow(peaks_.tool, tool.velocity.norm(), tool.acceleration.norm(), tool.jerk.norm());
    grow(peaks_.along, std::abs(along.velocity), std::abs(along.acceleration), std::abs(along.jerk));
  }

  static void grow(BasicLimits<Scalar>& peak, Scalar velocity, Scalar acceleration, Scalar jerk) {
    peak.velocity = std::max(peak.velocity, velocity);
    peak.acceleration = std::max(peak.acceleration, acceleration);
    peak.jerk = std::max(peak.jerk, jerk);
  }

  template <class P>
  [[nodiscard]] bool may_exceed(const P& path, const BasicPhase<Scalar>& phase, Scalar from,
                                Scalar to) const {
    const BasicState<Scalar> first = phase.at(from), last = phase.at(to);
    const Scalar top = phase.jerk != Scalar(0) ? -phase.acceleration / phase.jerk : from;
    Scalar v = std::max(std::abs(first.velocity), std::abs(last.velocity));
    if (top > from && top < to) v = std::max(v, std::abs(phase.at(top).velocity));
    const Scalar a = std::max(std::abs(first.acceleration), std::abs(last.acceleration));
    const Scalar j = std::abs(phase.jerk);
    const auto [low, high] = std::minmax(first.position, last.position);
    const auto b =
        path.bounds(std::clamp(low, Scalar(0), path.length()), std::clamp(high, Scalar(0), path.length()));
    const auto beyond = [](Scalar bound, Scalar found) {
      constexpr Scalar tiny = Scalar(1e-9);
      return bound > found * (Scalar(1) + tolerance) + tiny;
    };
    for (int i = 0; i < n; ++i)
      if (beyond(b.first[i] * v, peaks_.velocity[i]) ||
          beyond(b.second[i] * v * v + b.first[i] * a, peaks_.acceleration[i]) ||
          beyond(b.third[i] * v * v * v + Scalar(3) * b.second[i] * v * a + b.first[i] * j, peaks_.jerk[i]))
        return true;
    const auto& t = b.tool;
    return beyond(v, peaks_.along.velocity) || beyond(t.first * v, peaks_.tool.velocity) ||
           beyond(std::hypot(t.first * a + t.second_along * v * v, t.second_across * v * v),
                  peaks_.tool.acceleration) ||
           beyond(std::hypot(t.first * j + Scalar(3) * t.second_along * v * a + t.third_along * v * v * v,
                             Scalar(3) * t.second_across * v * a + t.third_across * v * v * v),
                  peaks_.tool.jerk);
  }

  const T& trajectory_;
  std::array<int, 3> tool_axes_;
  Peaks peaks_;
};

}  // namespace detail

/// The largest magnitudes of a trajectory, right to 1e-5 of themselves: sampled ones could miss a peak.
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

/// Looks at every joint; what rounding leaves of a velocity or an acceleration is no jump.
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
    const auto& left = trajectory.program()[block].path;
    const auto& entered = trajectory.program()[next].path;
    if (!(left.length() > S(0) && entered.length() > S(0))) continue;
    const BasicState<S> along{S(0), after.velocity, after.acceleration, S(0)};
    const auto end = motion(left.point_at(left.length()), along);
    const auto start = motion(entered.point_at(S(0)), along);
    const VectorN<S, M::axis_count> step = (end.velocity - start.velocity).cwiseAbs();
    jumps.velocity = jumps.velocity.cwiseMax(step);
    const auto jump = (end.acceleration - start.acceleration).cwiseAbs();
    if (step.maxCoeff() > rounding ||
        (jump.array() > rounding * (S(1) + end.acceleration.cwiseAbs().array())).any())
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
