// Second-order Taylor interpolation of any parametric curve (KK22 Eq. 16).
#pragma once

#include <cmath>
#include <concepts>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/curve_point.hpp"
#include "cncplan/core/state.hpp"

namespace cncplan::published {

/// What moves the parameter on: rule(point at u, u, state there, seconds, largest parameter) is the next one.
template <class R, class P>
concept StepRule = ParametricPath<P> &&
    requires(const R& rule, const CurvePoint<typename P::Vector>& point, typename P::Scalar x,
             const BasicState<typename P::Scalar>& along) {
  { rule(point, x, along, x, x) } -> std::same_as<typename P::Scalar>;
};

/// Eq. 16: from the speed V and acceleration A at u, T seconds further on,
///
///     u + T V / |r'| + T^2/2 ( A / |r'| - V^2 (r'.r'') / |r'|^4 )
///
/// never beyond the end. The truncation error is J T^3 / 6 in path length per step, and of the same order in
/// the change of the curve's speed. A curve that stands still there (|r'| = 0) has no next step: the end.
struct Taylor {
  template <class Vector, class S = typename Vector::Scalar>
  [[nodiscard]] S operator()(const CurvePoint<Vector>& point, S u, const BasicState<S>& along, S period,
                             S end) const {
    const S inverse_sq = S(1) / point.first.squaredNorm();
    const S inverse = std::sqrt(inverse_sq);
    const S slope = along.velocity * inverse;
    const S bend = along.acceleration * inverse - slope * slope * point.first.dot(point.second) * inverse_sq;
    const S next = u + period * (slope + period * bend / S(2));
    return next < end ? next : end;
  }
};

/// One step of Eq. 16 along a path. A step may be shorter than the period: from a block's start to the next
/// instant of the grid, so that unused time carries over.
template <ParametricPath P>
[[nodiscard]] typename P::Scalar taylor_step(const P& path, typename P::Scalar u, typename P::Scalar velocity,
                                             typename P::Scalar acceleration, typename P::Scalar period) {
  return Taylor{}(curve_point(path, u), u, {typename P::Scalar{}, velocity, acceleration, {}}, period,
                  path.parameter_end());
}

}  // namespace cncplan::published
