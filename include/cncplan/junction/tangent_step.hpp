// Tangent policy: how far the velocity of any axis may jump at a junction.
#pragma once

#include <limits>

#include "cncplan/junction/geometry.hpp"

namespace cncplan::junction {

/// v max_axis |t1 - t0| <= step. Tangent junctions pass freely.
template <std::floating_point S>
struct BasicTangentStep {
  S step{};  ///< mm/s, >= 0

  [[nodiscard]] S speed_sq(const BasicGeometry<S>& junction) const {
    const S jump = (junction.after.tangent - junction.before.tangent).template lpNorm<Eigen::Infinity>();
    constexpr S rounding = S(4) * std::numeric_limits<S>::epsilon();
    if (jump < rounding) return std::numeric_limits<S>::infinity();
    const S speed = step / jump;
    return speed * speed;
  }
};

using TangentStep = BasicTangentStep<double>;

}  // namespace cncplan::junction
