// Why a planned motion is no faster at each place.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "cncplan/core/in_space.hpp"
#include "cncplan/core/phase.hpp"
#include "cncplan/core/state.hpp"
#include "cncplan/detail/block_checks.hpp"
#include "cncplan/tool.hpp"
#include "cncplan_tools/detail/limited_by.hpp"

namespace cncplan::tools::report {

/// The speed that a piece of a trajectory is to have: mm/s, rad/s where only rotary axes move.
template <class T>
[[nodiscard]] double wanted_speed_of(const T& trajectory, std::size_t piece) {
  const auto& own = trajectory.program()[trajectory.block_of(piece)];
  const auto& machine = trajectory.machine();
  return cncplan::detail::requested_speed(own, machine, length_of(own.path, machine));
}

namespace detail {

// Whether a phase has nearly the speed that its block asks for, half-way through it. Within a tolerance a
// motion varies its speed all the time, a little below that.
template <class T>
[[nodiscard]] bool near_feed(const T& trajectory, const typename T::Phase& at) {
  constexpr double near = 0.98;
  return at.phase.at(at.phase.duration / 2).velocity >= near * wanted_speed_of(trajectory, at.piece);
}

template <class T>
[[nodiscard]] LimitedBy at_constant_speed(const T& trajectory, const typename T::Phase& at) {
  constexpr double rounding = 1e-6;
  const auto& machine = trajectory.machine();
  const double v = at.phase.velocity;
  if (!(v > 0.0)) return LimitedBy::rest;
  if (v >= (1 - rounding) * wanted_speed_of(trajectory, at.piece)) return LimitedBy::feed;
  const double middle = at.phase.at(at.phase.duration / 2).position;
  const auto path = trajectory.path(at.piece).point_at(middle);
  for (int i = 0; i < path.first.size(); ++i) {
    const auto& axis = machine.axes[static_cast<std::size_t>(i)];
    if (std::abs(path.first[i]) * v >= (1 - rounding) * least_velocity(axis)) return LimitedBy::axis_velocity;
  }
  if (near_feed(trajectory, at)) return LimitedBy::feed;
  return path.second.norm() > 0.0 ? LimitedBy::curvature : LimitedBy::look_ahead;
}

// The largest share that the tool's or an axis' acceleration or jerk takes of its limit, where a path has
// been travelled so far.
template <class M, class P>
[[nodiscard]] double share_of_limits(const M& machine, const P& path, const State& along) {
  const auto axes = motion(path.point_at(along.position), along);
  const auto point =
      path.visit([&](const auto& inside) { return tool_point(inside, along.position, tool_axes(machine)); });
  const auto tool = motion(point, along);
  double share = std::max(tool.acceleration.norm() / machine.limits.acceleration,
                          tool.jerk.norm() / machine.limits.jerk);
  for (int i = 0; i < axes.acceleration.size(); ++i) {
    const auto& axis = machine.axes[static_cast<std::size_t>(i)];
    share = std::max({share, std::abs(axes.acceleration[i]) / least_acceleration(axis),
                      std::abs(axes.jerk[i]) / axis.jerk});
  }
  return share;
}

// Half-way through a phase, by what the bend alone takes at that speed.
template <class T>
[[nodiscard]] bool limited_by_tolerance(const T& trajectory, const typename T::Phase& at) {
  if (trajectory.path(at.piece).exact()) return false;
  const auto half = at.phase.at(at.phase.duration / 2);
  return share_of_limits(trajectory.machine(), trajectory.path(at.piece),
                         State{half.position, half.velocity, 0.0, 0.0}) > 0.5;
}

}  // namespace detail

/// What stands in the way of a higher speed, of each phase of a trajectory.
template <class T>
[[nodiscard]] std::vector<LimitedBy> limited_by(const T& trajectory) {
  const auto phases = trajectory.phases();
  std::vector<LimitedBy> result(phases.size());
  for (std::size_t i = phases.size(); i-- > 0;) {
    const auto& [phase, piece] = phases[i];
    const auto change = [](const Phase& p) { return p.at(p.duration).velocity - p.velocity; };
    const bool steady = phase.acceleration == 0.0 && phase.jerk == 0.0;
    if (!steady && detail::near_feed(trajectory, phases[i])) {
      result[i] = LimitedBy::feed;
    } else if (detail::limited_by_tolerance(trajectory, phases[i])) {
      result[i] = LimitedBy::tolerance;
    } else if (steady) {
      result[i] = detail::at_constant_speed(trajectory, phases[i]);
    } else if (!(change(phase) < 0.0)) {
      result[i] = phase.jerk != 0.0 ? LimitedBy::jerk : LimitedBy::acceleration;
    } else {  // where does it slow down to?
      const bool last = i + 1 == phases.size();
      const bool goes_on = !last && change(phases[i + 1].phase) < 0.0;
      result[i] = goes_on ? result[i + 1]
                  : last || trajectory.block_of(phases[i + 1].piece) != trajectory.block_of(piece)
                      ? LimitedBy::junction
                      : LimitedBy::look_ahead;
    }
  }
  return result;
}

}  // namespace cncplan::tools::report
