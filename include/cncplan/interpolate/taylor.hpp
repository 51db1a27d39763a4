// Second-order Taylor interpolation of any parametric curve (KK22 Eq. 16).
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include "cncplan/core/concepts.hpp"

namespace cncplan::interpolate {

/// The parameter one step of `period` seconds further on, from the speed V and acceleration A at its start:
///
///     u + T V / |r'| + T^2/2 ( A / |r'| - V^2 (r'.r'') / |r'|^4 )
///
/// never beyond the end. The truncation error is of the order of J T^3 / 6 in path length per step. A step
/// may be shorter than the period: from a block's start to the next instant of the grid, so that unused time
/// carries over.
template <ParametricPath P>
[[nodiscard]] typename P::Scalar taylor_step(const P& path, typename P::Scalar u, typename P::Scalar velocity,
                                             typename P::Scalar acceleration, typename P::Scalar period) {
  using S = typename P::Scalar;
  const typename P::Vector first = path.derivative(u);
  const S norm_sq = first.squaredNorm();
  const S norm = std::sqrt(norm_sq);
  const S slope = velocity / norm;
  const S bend = acceleration / norm - slope * slope * first.dot(path.second_derivative(u)) / norm_sq;
  return std::min(u + period * (slope + period * bend / S(2)), path.parameter_end());
}

}  // namespace cncplan::interpolate
