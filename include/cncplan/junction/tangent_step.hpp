// Tangent policy: how far the velocity of any axis may jump at a joint.
#pragma once

#include <limits>

#include "cncplan/junction/geometry.hpp"

namespace cncplan::junction {

/// v max_axis |t1 - t0| <= step. Tangent joints pass freely.
template <std::floating_point S>
struct BasicTangentStep {
  S step{};  ///< mm/s, >= 0

  [[nodiscard]] S speed_sq(const BasicGeometry<S>& joint) const {
    const S jump = (joint.after.tangent - joint.before.tangent).template lpNorm<Eigen::Infinity>();
    constexpr S rounding = S(4) * std::numeric_limits<S>::epsilon();
    if (jump < rounding) return std::numeric_limits<S>::infinity();
    const S speed = step / jump;
    return speed * speed;
  }
};

using TangentStep = BasicTangentStep<double>;

}  // namespace cncplan::junction
