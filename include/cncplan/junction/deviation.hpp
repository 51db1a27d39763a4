// Junction deviation: the speed at which an imagined arc, that near the corner, is driven at the acceleration
// limit.
#pragma once

#include <limits>

#include "cncplan/junction/geometry.hpp"

namespace cncplan::junction {

/// v^2 = A delta sin(theta/2) / (1 - sin(theta/2)), theta the angle between the tangents seen from inside (pi
/// is straight on, 0 a reversal). With sine s = |t1 - t0| / 2 and cosine c = |t1 + t0| / 2 = sin(theta/2) of
/// half the turn it reads A delta c (1 + c) / s^2, which stays exact for the smallest turns and for the
/// sharpest; no limit where s vanishes up to rounding.
template <std::floating_point S>
struct BasicDeviation {
  S delta{};  ///< mm, >= 0

  [[nodiscard]] S speed_sq(const BasicGeometry<S>& junction) const {
    const S sine_sq = (junction.after.tangent - junction.before.tangent).squaredNorm() / S(4);
    constexpr S rounding = S(4) * std::numeric_limits<S>::epsilon();
    if (sine_sq < rounding * rounding) return std::numeric_limits<S>::infinity();
    const S cosine = (junction.after.tangent + junction.before.tangent).norm() / S(2);
    return junction.limits.acceleration * delta * cosine * (S(1) + cosine) / sine_sq;
  }
};

using Deviation = BasicDeviation<double>;

}  // namespace cncplan::junction
