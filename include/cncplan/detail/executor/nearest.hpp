// Where a path passes a place.
#pragma once

#include <algorithm>
#include <limits>

#include "cncplan/core/concepts.hpp"

namespace cncplan::detail {

/// The length at which a path is nearest to a place, of several the first: the best of 64 pieces, then halved
/// by the sign of the distance's slope. On a path with more bends than pieces it may be another near place.
template <Path P>
[[nodiscard]] typename P::Scalar nearest_length(const P& path, const typename P::Vector& place) {
  using S = typename P::Scalar;
  constexpr int pieces = 64;
  const S length = path.length();
  const S step = length / static_cast<S>(pieces);
  S best = std::numeric_limits<S>::infinity();
  S nearest = S(0);
  for (int i = 0; i <= pieces; ++i) {
    const S s = i == pieces ? length : static_cast<S>(i) * step;
    const S distance = (path.position_at(s) - place).squaredNorm();
    if (distance < best) best = distance, nearest = s;
  }
  S low = std::max(nearest - step, S(0)), high = std::min(nearest + step, length);
  for (int halving = 0; halving < std::numeric_limits<S>::digits; ++halving) {
    const S middle = low + (high - low) / S(2);
    if (!(middle > low && middle < high)) break;
    const auto at = path.point_at(middle);
    ((at.position - place).dot(at.first) < S(0) ? low : high) = middle;
  }
  return (path.position_at(high) - place).squaredNorm() < best ? high : nearest;
}

}  // namespace cncplan::detail
