// A profile from a state of motion, as the tests of `from_state` draw it, and what it does.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdio>
#include <string>

#include "cncplan/core/limits.hpp"
#include "cncplan/profile/from_state.hpp"
#include "support/profile_oracle.hpp"

namespace cncplan::test {

struct StateCase {
  double length;
  profile::StartState start;
  double end;
  Limits limits;

  /// A literal to paste into a regression test.
  [[nodiscard]] std::string literal() const {
    char text[320];
    std::snprintf(text, sizeof text, "StateCase{%.17g, {%.17g, %.17g}, %.17g, {%.17g, %.17g, %.17g}}", length,
                  start.velocity, start.acceleration, end, limits.velocity, limits.acceleration, limits.jerk);
    return text;
  }
};

/// What a profile does from its start.
struct Travelled {
  Real position = 0, velocity = 0, acceleration = 0, lowest = 0, highest = 0, steepest = 0, duration = 0;
};

/// Integrates jerks over times, from a state.
template <std::floating_point S>
Travelled integrate(const profile::BasicStartState<S>& start, const profile::BasicProfile<S>& p) {
  Travelled t;
  t.velocity = t.lowest = t.highest = start.velocity;
  t.acceleration = start.acceleration;
  t.steepest = std::abs(t.acceleration);
  for (const BasicPhase<S>& phase : p.phases()) {
    const Real d = phase.duration, j = phase.jerk;
    const Real last = t.acceleration + j * d;
    if (t.acceleration * last < 0) {
      const Real extremum = t.velocity - t.acceleration * t.acceleration / (2 * j);
      t.lowest = std::min(t.lowest, extremum);
      t.highest = std::max(t.highest, extremum);
    }
    t.position += d * (t.velocity + d * (t.acceleration / 2 + d * j / 6));
    t.velocity += d * (t.acceleration + d * j / 2);
    t.acceleration = last;
    t.duration += d;
    t.lowest = std::min(t.lowest, t.velocity);
    t.highest = std::max(t.highest, t.velocity);
    t.steepest = std::max(t.steepest, std::abs(t.acceleration));
  }
  return t;
}

}  // namespace cncplan::test
