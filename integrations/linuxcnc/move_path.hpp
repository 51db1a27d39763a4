// SPDX-License-Identifier: GPL-2.0-or-later
// The path of a move, in mm and rad.
#pragma once

#include <cmath>
#include <limits>

#include <cncplan/path/arc_from_center.hpp>
#include <cncplan/path/segment.hpp>

#include "move.hpp"

namespace cncplan::linuxcnc {

/// The axis along which the normal of a circle points, or -1: its plane is tilted.
[[nodiscard]] inline int axis_along(const PmCartesian& normal) {
  const Vector3 n = in_space(normal);
  int axis = 0;
  n.cwiseAbs().maxCoeff(&axis);
  for (int i = 0; i < 3; ++i)
    if (i != axis && std::abs(n[i]) > 1e-9 * std::abs(n[axis])) return -1;
  return axis;
}

/// Errors: those of `arc_from_center`; not_supported for a tilted circle. Radii may differ by any amount, as
/// in LinuxCNC: the interpreter has checked them, and the arc is a spiral.
[[nodiscard]] inline Expected<path::BasicArc<double>> arc_of(const Move& move, const Units& units) {
  const int axis = axis_along(move.normal);
  if (axis < 0) return tl::unexpected(Error{ErrorCode::not_supported, "plane", 0.0, 0.0});
  const bool left = (move.turn >= 0) == (in_space(move.normal)[axis] > 0.0);
  constexpr Plane planes[] = {Plane::yz, Plane::zx, Plane::xy};
  const path::ArcTolerance<double> tolerance{.radius_mismatch = std::numeric_limits<double>::max(),
                                             .smallest_radius = 1e-6};
  return path::arc_from_center<double>(
      units.linear * in_space(move.start.tran), units.linear * in_space(move.end.tran),
      units.linear * in_space(move.center), left ? Turn::counterclockwise : Turn::clockwise, planes[axis],
      tolerance, move.turn >= 0 ? move.turn : -1 - move.turn);
}

/// The first N coordinates of a line or circle. Errors: those of `arc_of`.
template <int N>
[[nodiscard]] Expected<path::BasicSegment<double, N>> path_of(const Move& move, const Units& units) {
  using Vector = VectorN<double, N>;
  const Coordinates factors = units.factors();
  const Vector start = factors.cwiseProduct(coordinates(move.start)).template head<N>();
  const Vector end = factors.cwiseProduct(coordinates(move.end)).template head<N>();
  if (move.shape != Shape::circle) return path::BasicLine<double, N>(start, end);
  const auto arc = arc_of(move, units);
  if (!arc) return tl::unexpected(arc.error());
  if constexpr (N == 3)
    return *arc;
  else
    return path::BasicArcAlong<double, N>(*arc, start, end);
}

}  // namespace cncplan::linuxcnc
