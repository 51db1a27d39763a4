// Acceleration-step policy: how far the normal acceleration may jump where curvature does (line to arc, arc
// to arc).
#pragma once

#include <algorithm>
#include <limits>

#include "cncplan/junction/geometry.hpp"

namespace cncplan::junction {

/// v^2 |k1 - k0| <= step, k the curvature vectors at the junction (v^2/R for a line into an arc of radius R).
template <std::floating_point S>
struct BasicAccelerationStep {
  S step{};  ///< mm/s^2, >= 0

  [[nodiscard]] S speed_sq(const BasicGeometry<S>& junction) const {
    const S jump = (junction.after.curvature - junction.before.curvature).norm();
    constexpr S rounding = S(16) * std::numeric_limits<S>::epsilon();
    const S larger = std::max(junction.after.curvature.norm(), junction.before.curvature.norm());
    if (jump <= rounding * larger) return std::numeric_limits<S>::infinity();
    return step / jump;
  }
};

using AccelerationStep = BasicAccelerationStep<double>;

}  // namespace cncplan::junction
