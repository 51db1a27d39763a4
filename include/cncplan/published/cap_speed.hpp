// Speed on a curve in planning as published: what a bend takes of the limits only lowers the speed. KK22 has
// no such cap; published/planar_length.hpp plans without it.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <type_traits>

#include "cncplan/core/limits.hpp"

namespace cncplan::published {

/// Limits along a path of curvature k (1/mm, >= 0) at most, whose curvature vector changes across the path by
/// no more than `change` (1/mm^2, >= 0; zero on a circle) over length: v^2 k within the acceleration limit,
/// and the jerk at constant speed, v^3/R^2 on a circle, within the jerk limit. Acceleration and jerk along
/// the path keep their limits, so the vector sums may exceed them: what KK22's profiles assume.
template <std::floating_point S>
[[nodiscard]] BasicLimits<S> cap_speed(S curvature, std::type_identity_t<S> change,
                                       BasicLimits<std::type_identity_t<S>> limits) {
  if (curvature > S(0))
    limits.velocity = std::min({limits.velocity, std::sqrt(limits.acceleration / curvature),
                                std::cbrt(limits.jerk / std::hypot(curvature * curvature, change))});
  return limits;
}

}  // namespace cncplan::published
