// Limits along the path of a curve, so that what its curvature adds stays within the limits too.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <type_traits>

#include "cncplan/core/limits.hpp"

namespace cncplan::plan {

/// How a path bends at most. At speed v, acceleration a and jerk j along it, with the tangent T, the
/// curvature vector K and the part W of K's change by length that lies across T, a point's acceleration is a
/// T + v^2 K and its jerk (j - v^3 k^2) T + 3 v a K + v^3 W.
template <std::floating_point S>
struct BasicBend {
  S curvature{};  ///< k = |K|, 1/mm, >= 0
  S change{};     ///< |W|, 1/mm^2, >= 0; zero on a circle
};

using Bend = BasicBend<double>;

/// Limits along the path from its bend and limits of the whole motion.
template <class R, class S>
concept CurveRule = requires(const R& rule, const BasicBend<S>& bend, const BasicLimits<S>& limits) {
  { rule(bend, limits) } -> std::same_as<BasicLimits<S>>;
};

/// Lowers the speed alone: v^2 k within the acceleration limit, and the jerk at constant speed (v^3/R^2 on a
/// circle) within the jerk limit. Acceleration and jerk along the path keep their limits, so the vector sums
/// may exceed them: what the paper's profiles assume.
struct CapSpeed {
  template <std::floating_point S>
  [[nodiscard]] BasicLimits<S> operator()(const std::type_identity_t<BasicBend<S>>& bend,
                                          BasicLimits<S> limits) const {
    const auto& [curvature, change] = bend;
    if (curvature > S(0))
      limits.velocity = std::min({limits.velocity, std::sqrt(limits.acceleration / curvature),
                                  std::cbrt(limits.jerk / std::hypot(curvature * curvature, change))});
    return limits;
  }
};

/// Shares acceleration and jerk between path and bend, so that the vector sums stay within the limits A and J
/// (docs/planning.md). With m = v^3 k^2 and w = v^3 |W|:
///
/// 1. v is lowered until v^2 k <= 0.8 A and m + w <= 0.5 J, so that something is left to change speed with;
/// of
///    the jerk limit, w is set aside: J' = J - w;
/// 2. a ramp at jerk j peaks at no more than sqrt(j v); the jerk sum holds with that peak if
///    (j + m)^2 + 9 m j <= J'^2, so j0 = (sqrt(117 m^2 + 4 J'^2) - 11 m) / 2;
/// 3. a = min(sqrt(A^2 - v^4 k^2), sqrt(j0 v)), and with it j = sqrt(J'^2 - 9 v^2 k^2 a^2) - m, at least j0.
///
/// Both sums grow with v, a and j, so they hold below these limits as well.
struct ShareLimits {
  template <std::floating_point S>
  [[nodiscard]] BasicLimits<S> operator()(const std::type_identity_t<BasicBend<S>>& bend,
                                          BasicLimits<S> limits) const {
    const auto& [curvature, change] = bend;
    if (!(curvature > S(0))) return limits;
    const S accelerate = limits.acceleration;
    const S v = std::min({limits.velocity, std::sqrt(S(0.8) * accelerate / curvature),
                          std::cbrt(S(0.5) * limits.jerk / (curvature * curvature + change))});
    limits.velocity = v;
    const S across = v * v * curvature;
    const S m = across * v * curvature;
    if (std::isfinite(accelerate))
      limits.acceleration = std::sqrt((accelerate - across) * (accelerate + across));
    if (std::isfinite(limits.jerk)) {
      const S jerk = limits.jerk - v * v * v * change;
      const S least_jerk = (std::sqrt(S(117) * m * m + S(4) * jerk * jerk) - S(11) * m) / S(2);
      limits.acceleration = std::min(limits.acceleration, std::sqrt(least_jerk * v));
      const S turned = S(3) * v * curvature * limits.acceleration;
      limits.jerk = std::sqrt((jerk - turned) * (jerk + turned)) - m;
    }
    return limits;
  }
};

}  // namespace cncplan::plan
