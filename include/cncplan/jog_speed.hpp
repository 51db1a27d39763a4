// How fast a jog may be.
#pragma once

#include <cmath>
#include <concepts>
#include <limits>

#include "cncplan/core/error.hpp"
#include "cncplan/core/vector.hpp"

namespace cncplan {

/// How fast a jog to a place may be, where that is slower than the machine's limits.
template <std::floating_point S, int N>
struct BasicJogSpeed {
  static constexpr S infinity = std::numeric_limits<S>::infinity();

  VectorN<S, N> axes = VectorN<S, N>::Constant(infinity);  ///< of each, mm/s and rad/s; > 0
  S tool = infinity;  ///< mm/s, of X, Y and Z together; > 0. From rest they go straight then
};

template <int N>
using JogSpeed = BasicJogSpeed<double, N>;

/// Nothing, or the first speed that is none.
template <std::floating_point S, int N>
[[nodiscard]] Expected<void> validate(const BasicJogSpeed<S, N>& speed) {
  for (int i = 0; i <= N; ++i) {
    const S own = i < N ? speed.axes[i] : speed.tool;
    if (std::isnan(own)) return refusal(ErrorCode::not_finite, "speed of a jog", own);
    if (!(own > S(0))) return refusal(ErrorCode::not_positive, "speed of a jog", own);
  }
  return {};
}

}  // namespace cncplan
