// Limits along the path of a curve, so that what its curvature adds stays within the limits too.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include "cncplan/core/limits.hpp"

namespace cncplan::plan {

/// Limits along the path from limits of the whole motion and the curvature (1/mm, >= 0).
template <class R, class S>
concept CurveRule = requires(const R& rule, S curvature, const BasicLimits<S>& limits) {
  { rule(curvature, limits) } -> std::same_as<BasicLimits<S>>;
};

/// Lowers the speed alone: v^2/R within the acceleration limit, and v^3/R^2, the jerk of a circle at constant
/// speed, within the jerk limit. Acceleration and jerk along the path keep their limits, so the vector sums
/// may exceed them: what the paper's profiles assume.
struct CapSpeed {
  template <std::floating_point S>
  [[nodiscard]] BasicLimits<S> operator()(S curvature, BasicLimits<S> limits) const {
    if (curvature > S(0))
      limits.velocity = std::min({limits.velocity, std::sqrt(limits.acceleration / curvature),
                                  std::cbrt(limits.jerk / (curvature * curvature))});
    return limits;
  }
};

/// Shares acceleration and jerk between path and curvature, so that the vector sums stay within the limits.
/// On a circle of curvature k the acceleration is (a, v^2 k) and the jerk (j - v^3 k^2, 3 v a k), along and
/// across the path (docs/planning.md). The rule:
///
/// 1. v is lowered until v^2 k <= 0.8 A and m = v^3 k^2 <= 0.5 J, so that something is left to change speed
/// with;
/// 2. a ramp at jerk j peaks at no more than sqrt(j v); the jerk sum holds with that peak if
///    (j + m)^2 + 9 m j <= J^2, so j0 = (sqrt(117 m^2 + 4 J^2) - 11 m) / 2;
/// 3. a = min(sqrt(A^2 - v^4 k^2), sqrt(j0 v)), and with it j = sqrt(J^2 - 9 v^2 k^2 a^2) - m, at least j0.
///
/// Both sums grow with v, a and j, so they hold below these limits as well.
struct ShareLimits {
  template <std::floating_point S>
  [[nodiscard]] BasicLimits<S> operator()(S curvature, BasicLimits<S> limits) const {
    if (!(curvature > S(0))) return limits;
    const S accelerate = limits.acceleration;
    const S jerk = limits.jerk;
    const S v = std::min({limits.velocity, std::sqrt(S(0.8) * accelerate / curvature),
                          std::cbrt(S(0.5) * jerk / (curvature * curvature))});
    limits.velocity = v;
    const S across = v * v * curvature;
    const S m = across * v * curvature;
    if (std::isfinite(jerk)) {
      const S least_jerk = (std::sqrt(S(117) * m * m + S(4) * jerk * jerk) - S(11) * m) / S(2);
      const S left =
          std::isfinite(accelerate) ? std::sqrt((accelerate - across) * (accelerate + across)) : accelerate;
      limits.acceleration = std::min(left, std::sqrt(least_jerk * v));
      const S turned = S(3) * v * curvature * limits.acceleration;
      limits.jerk = std::sqrt((jerk - turned) * (jerk + turned)) - m;
    } else if (std::isfinite(accelerate)) {
      limits.acceleration = std::sqrt((accelerate - across) * (accelerate + across));
    }
    return limits;
  }
};

}  // namespace cncplan::plan
