// The highest speeds of the tool along a trajectory, by its time (set-up).
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <memory_resource>
#include <vector>

#include "cncplan/trajectory.hpp"

namespace cncplan::detail {

/// s that one of `speed_peaks` is of.
template <std::floating_point S>
inline constexpr S peak_period = S(0.05);

/// The highest speed of the tool in a phase on a piece of a path, mm/s, from bounds; where it does not move
/// that along the path.
template <MachineModel M, BlockModel B>
[[nodiscard]] typename M::Scalar highest_speed(const Trajectory<M, B>& trajectory,
                                               const BasicPhase<typename M::Scalar>& phase,
                                               std::size_t piece) {
  using S = typename M::Scalar;
  const S end = phase.at(phase.duration).position;
  const S tool = trajectory.path(piece).bounds(phase.position, end).tool.first;
  return phase.highest_velocity() * (tool > S(0) ? tool : S(1));
}

/// The same in each `peak_period` of a trajectory.
template <MachineModel M, BlockModel B>
[[nodiscard]] std::pmr::vector<typename M::Scalar> speed_peaks(const Trajectory<M, B>& trajectory,
                                                               std::pmr::memory_resource* memory) {
  using S = typename M::Scalar;
  const auto period_at = [](S time) { return static_cast<std::size_t>(time / peak_period<S>); };
  std::pmr::vector<S> peaks(period_at(trajectory.duration()) + 1, S(0), memory);
  for (const auto& [phase, piece] : trajectory.phases()) {
    const S peak = highest_speed(trajectory, phase, piece);
    const std::size_t last = std::min(period_at(phase.time + phase.duration), peaks.size() - 1);
    for (std::size_t i = period_at(phase.time); i <= last; ++i) peaks[i] = std::max(peaks[i], peak);
  }
  return peaks;
}

}  // namespace cncplan::detail
