// Limits along the path of a curve, so that what its curvature adds stays within the limits too.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <type_traits>

#include "cncplan/core/limits.hpp"

namespace cncplan::plan {

/// How a path bends at most. At speed v, acceleration a and jerk j along it, with the tangent T, the
/// curvature vector K and the part W of K's change by length that lies across T, a point's acceleration is a
/// T + v^2 K and its jerk (j - v^3 k^2) T + 3 v a K + v^3 W.
template <std::floating_point S>
struct BasicBend {
  S curvature{};                                  ///< k = |K|, 1/mm, >= 0
  S change{};                                     ///< |W|, 1/mm^2, >= 0; zero on a circle
  S length = std::numeric_limits<S>::infinity();  ///< mm, of the path that bends so; infinite: not known
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
    const auto& [curvature, change, length] = bend;
    if (curvature > S(0))
      limits.velocity = std::min({limits.velocity, std::sqrt(limits.acceleration / curvature),
                                  std::cbrt(limits.jerk / std::hypot(curvature * curvature, change))});
    return limits;
  }
};

/// Shares acceleration and jerk between path and bend, so that the vector sums stay within the limits A and J
/// (docs/planning.md). With m = v^3 k^2 and w = v^3 |W|, for any speed v with v^2 k <= A and m + w <= J:
///
/// 1. of the jerk limit, w is set aside: J' = J - w;
/// 2. a ramp at jerk j peaks at no more than sqrt(j v); the jerk sum holds with that peak if
///    (j + m)^2 + 9 m j <= J'^2, so j0 = (sqrt(117 m^2 + 4 J'^2) - 11 m) / 2;
/// 3. a <= min(sqrt(A^2 - v^4 k^2), sqrt(j0 v)), and with it j = sqrt(J'^2 - 9 v^2 k^2 a^2) - m, at least j0.
///
/// Both sums grow with v, a and j, so they hold below these limits as well. A higher speed leaves less to
/// change speed with. Without a length v is such that v^2 k <= 0.8 A and m + w <= 0.5 J, and a is the most
/// there is. Over a known length a higher v, or a lower a with a higher j, is taken where it saves time, that
/// of the length from rest to rest with ramps counted once and, as the neighbours' ramps run through it too,
/// twice.
struct ShareLimits {
  template <std::floating_point S>
  [[nodiscard]] BasicLimits<S> operator()(const std::type_identity_t<BasicBend<S>>& bend,
                                          const BasicLimits<S>& limits) const {
    if (!(bend.curvature > S(0))) return limits;
    const S least = fastest(bend, limits, S(0.8), S(0.5));
    BasicLimits<S> best = at(bend, limits, least, S(1));
    if (!(std::isfinite(limits.jerk) && std::isfinite(bend.length))) return best;
    constexpr int speeds = 4;
    const S rise = (fastest(bend, limits, S(1), S(1)) - least) / S(speeds);
    const S alone = time(best, bend.length, S(1));
    S shortest = time(best, bend.length, S(2));
    for (int i = 0; i <= speeds; ++i)
      for (const S share : {S(1), S(0.85), S(0.7), S(0.55)}) {
        const BasicLimits<S> other = at(bend, limits, least + static_cast<S>(i) * rise, share);
        const S takes = time(other, bend.length, S(2));
        if (!(takes < shortest && time(other, bend.length, S(1)) <= alone)) continue;
        shortest = takes;
        best = other;
      }
    return best;
  }

 private:
  // The speed at which the bend takes these shares of acceleration and jerk.
  template <std::floating_point S>
  static S fastest(const BasicBend<S>& bend, const BasicLimits<S>& limits, S acceleration, S jerk) {
    return std::min({limits.velocity, std::sqrt(acceleration * limits.acceleration / bend.curvature),
                     std::cbrt(jerk * limits.jerk / (bend.curvature * bend.curvature + bend.change))});
  }

  // Steps 1 to 3, with a share of the highest a. Not a number, or not positive, where v leaves nothing.
  template <std::floating_point S>
  static BasicLimits<S> at(const BasicBend<S>& bend, BasicLimits<S> limits, S v, S share) {
    limits.velocity = v;
    const S accelerate = limits.acceleration;
    const S across = v * v * bend.curvature;
    const S m = across * v * bend.curvature;
    if (std::isfinite(accelerate))
      limits.acceleration = std::sqrt((accelerate - across) * (accelerate + across));
    if (std::isfinite(limits.jerk)) {
      const S jerk = limits.jerk - v * v * v * bend.change;
      const S least_jerk = (std::sqrt(S(117) * m * m + S(4) * jerk * jerk) - S(11) * m) / S(2);
      limits.acceleration = share * std::min(limits.acceleration, std::sqrt(least_jerk * v));
      const S turned = S(3) * v * bend.curvature * limits.acceleration;
      limits.jerk = std::sqrt((jerk - turned) * (jerk + turned)) - m;
    }
    return limits;
  }

  // Seconds over the length from rest to rest, each ramp counted `ramps` times; its peak is lower than v
  // where the length is too short for so many.
  template <std::floating_point S>
  static S time(const BasicLimits<S>& limits, S length, S ramps) {
    const auto& [v, a, j] = limits;
    if (!(a > S(0) && j > S(0))) return std::numeric_limits<S>::infinity();
    const S share = length / ramps;
    const S by_jerk = std::cbrt(share * share * j / S(4));  // share = 2 v sqrt(v / j)
    const S steady = a / j;
    const bool reaches_a = by_jerk > a * steady;
    const S peak = reaches_a ? (std::sqrt(steady * steady + S(4) * share / a) - steady) * a / S(2) : by_jerk;
    const S top = std::min(v, peak);
    const S ramp = top > a * steady ? top / a + steady : S(2) * std::sqrt(top / j);
    return length / top + ramps * ramp;
  }
};

/// Limits along a whole curve (of `path/`), mm, s, from limits of the motion: by default such that the
/// vectors of acceleration and jerk keep them, whatever a profile within the result does.
template <class Curve, std::floating_point S, CurveRule<S> Rule = ShareLimits>
[[nodiscard]] BasicLimits<S> limits_on(const Curve& curve, const BasicLimits<S>& limits,
                                       const Rule& rule = {}) {
  return rule(BasicBend<S>{curve.max_curvature(), curve.max_curvature_change(), curve.length()}, limits);
}

}  // namespace cncplan::plan
