// Coordinates within a working plane: the swap of KK22 Table 2 and its inverse.
#pragma once

#include <concepts>

#include "cncplan/core/plane.hpp"
#include "cncplan/core/vector.hpp"

namespace cncplan::published {

/// X Y Z as (first, second, third) coordinate of the plane.
template <std::floating_point S>
[[nodiscard]] BasicVector3<S> to_plane(const BasicVector3<S>& xyz, Plane plane) {
  const PlaneAxes a = axes(plane);
  return {xyz(a.first), xyz(a.second), xyz(a.third)};
}

/// Inverse of `to_plane`: back to X Y Z.
template <std::floating_point S>
[[nodiscard]] BasicVector3<S> from_plane(const BasicVector3<S>& swapped, Plane plane) {
  const PlaneAxes a = axes(plane);
  BasicVector3<S> xyz;
  xyz(a.first) = swapped(0);
  xyz(a.second) = swapped(1);
  xyz(a.third) = swapped(2);
  return xyz;
}

}  // namespace cncplan::published
