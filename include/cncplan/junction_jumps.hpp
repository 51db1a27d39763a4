// What jumps at the junctions of a trajectory's blocks (set-up).
#pragma once

#include <concepts>
#include <cstddef>

#include "cncplan/core/path_point.hpp"
#include "cncplan/core/vector.hpp"
#include "cncplan/trajectory.hpp"

namespace cncplan {

/// What jumps at the junctions between pieces.
template <std::floating_point S, int N>
struct BasicJunctionJumps {
  VectorN<S, N> velocity = VectorN<S, N>::Zero();  ///< of each axis, at most
  std::size_t
      accelerations{};  ///< junctions that are passed in motion and where some axis' acceleration jumps
};

/// Looks at every junction; what rounding leaves is no jump: of a velocity 1e-6 mm/s, of an acceleration 1e-3
/// mm/s^2 (on pieces of a micrometre it comes near that).
template <MachineModel M, BlockModel B>
[[nodiscard]] BasicJunctionJumps<typename M::Scalar, M::axis_count> junction_jumps(
    const Trajectory<M, B>& trajectory) {
  using S = typename M::Scalar;
  constexpr S rounding = S(1e-6);
  BasicJunctionJumps<S, M::axis_count> jumps;
  const auto phases = trajectory.phases();
  for (std::size_t i = 1; i < phases.size(); ++i) {
    const auto& [before, piece] = phases[i - 1];
    const auto& [after, next] = phases[i];
    if (piece == next || !(after.velocity > S(0))) continue;
    const auto left = trajectory.path(piece), entered = trajectory.path(next);
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

/// The largest jump of any axis' velocity at a junction between two blocks.
template <MachineModel M, BlockModel B>
[[nodiscard]] typename M::Scalar corner_velocity_step(const Trajectory<M, B>& trajectory) {
  return junction_jumps(trajectory).velocity.maxCoeff();
}

}  // namespace cncplan
