// Whole turns of joints, so that they go on where the formula of a map jumps.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <numbers>

#include "cncplan/core/vector.hpp"

namespace cncplan::path {

/// Along a path: joints that turn, each at two ends, rad with whole turns. Between them a joint is the one of
/// its map's angles that is nearest to the straight way from end to end, so it must stay within half a turn
/// of that way.
template <std::floating_point S, int N>
struct BasicWholeTurns {
  using Vector = VectorN<S, N>;

  Vector from = Vector::Zero();  ///< at the path's start
  Vector to = Vector::Zero();    ///< at its end
  std::uint32_t joints{};        ///< a bit for each joint that this holds for; 0: the map's own angles

  /// Adds them to positions; `share` of the path's length, 0 to 1.
  void add(Vector& position, S share) const {
    constexpr S turn = S(2) * std::numbers::pi_v<S>;
    for (int i = 0; i < N; ++i)
      if (((joints >> static_cast<unsigned>(i)) & 1U) != 0)
        position[i] += turn * std::round((from[i] + (to[i] - from[i]) * share - position[i]) / turn);
  }

  friend bool operator==(const BasicWholeTurns&, const BasicWholeTurns&) = default;
};

}  // namespace cncplan::path
