// Random moves of one axis, for what is measured of them.
#pragma once

#include <cmath>

#include "cncplan/move_to.hpp"
#include "support/random.hpp"

namespace cncplan::bench {

struct AxisMove {
  AxisState from, to;
  Axis axis;
};

// Limits of a mill's axes, and states in all of them: velocity and acceleration at both ends, within limits.
inline AxisMove draw_axis_move(test::Random& random, bool rest) {
  AxisMove move{};
  Axis& axis = move.axis;
  axis.velocity = random.log_uniform(10, 500);
  axis.acceleration = axis.velocity * random.uniform(3, 20);
  axis.jerk = axis.acceleration * random.uniform(5, 100);
  move.to.position = (random.coin() ? 1 : -1) * random.log_uniform(0.01, 500);
  if (rest) return move;
  const auto draw = [&](AxisState& state, double sign) {
    double settled{};
    do {
      state.velocity = axis.velocity * random.uniform(-1, 1);
      state.acceleration = axis.acceleration * random.uniform(-1, 1);
      settled = state.velocity + sign * state.acceleration * std::abs(state.acceleration) / (2 * axis.jerk);
    } while (std::abs(settled) > axis.velocity);
  };
  draw(move.from, 1);
  draw(move.to, -1);
  return move;
}

}  // namespace cncplan::bench
