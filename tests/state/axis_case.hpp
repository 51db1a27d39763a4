// A motion of one axis from a state to a state, as the tests draw it, and what it does.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>

#include "cncplan/core/axis_limits.hpp"
#include "cncplan/core/axis_state.hpp"
#include "cncplan/state/motion.hpp"
#include "support/random.hpp"

namespace cncplan::test {

using Real = long double;

struct AxisCase {
  AxisState from;
  AxisState to;
  AxisLimits limits;

  /// To paste into a regression test.
  [[nodiscard]] std::string literal() const {
    char text[480];
    std::snprintf(
        text, sizeof text,
        "AxisCase{{%.17g, %.17g, %.17g}, {%.17g, %.17g, %.17g}, {%.17g, %.17g, %.17g, %.17g, %.17g}}",
        from.position, from.velocity, from.acceleration, to.position, to.velocity, to.acceleration,
        limits.velocity_up, limits.velocity_down, limits.acceleration_up, limits.acceleration_down,
        limits.jerk);
    return text;
  }
};

inline Real settled(Real velocity, Real acceleration, Real jerk) {
  return velocity + acceleration * std::abs(acceleration) / (2 * jerk);
}

/// Velocity and acceleration within limits, and the velocity at which the acceleration has come to zero, too.
inline bool within(const AxisLimits& l, double velocity, double acceleration) {
  const Real end = settled(velocity, acceleration, l.jerk);
  return velocity <= l.velocity_up && velocity >= -l.velocity_down && end <= l.velocity_up &&
         end >= -l.velocity_down && acceleration <= l.acceleration_up && acceleration >= -l.acceleration_down;
}

/// The same of a target: by the velocity from which its acceleration comes.
inline bool comes_within(const AxisLimits& l, double velocity, double acceleration) {
  AxisLimits turned = l;
  std::swap(turned.acceleration_up, turned.acceleration_down);
  return within(turned, velocity, -acceleration);
}

/// Rest, limits, equal numbers, whole numbers and limits that differ between directions are drawn often.
inline AxisCase draw_axis_case(Random& random, bool beyond = false) {
  AxisCase c{};
  AxisLimits& l = c.limits;
  const bool whole = random.integer(0, 3) == 0;
  if (whole)
    l = {random.integer(1, 3) * 1.0, 0, random.integer(1, 3) * 1.0, 0, random.integer(1, 3) * 1.0};
  else
    l = {random.log_uniform(0.1, 1e3), 0, random.log_uniform(1, 1e4), 0, random.log_uniform(10, 1e6)};
  const bool differ = random.integer(0, 2) == 0;
  const auto factor = [&] {
    return !differ ? 1.0 : whole ? random.integer(1, 2) : random.log_uniform(0.1, 10);
  };
  l.velocity_down = l.velocity_up * factor();
  l.acceleration_down = l.acceleration_up * factor();
  const auto pick = [&](double low, double high) {
    const int kind = random.integer(0, 9);
    if (kind < 2) return 0.0;
    if (kind < 4) return kind == 2 ? low : high;
    return whole ? random.integer(-4, 4) / 2.0 : random.uniform(low, high) * (kind == 4 ? 1e-3 : 1.0);
  };
  const double wide = beyond ? 2.0 : 1.0;
  const auto draw = [&](double more, double& velocity, double& acceleration) {
    velocity = pick(-more * l.velocity_down, more * l.velocity_up);
    acceleration = pick(-more * l.acceleration_down, more * l.acceleration_up);
  };
  do draw(wide, c.from.velocity, c.from.acceleration);
  while (beyond ? c.from.acceleration * c.from.acceleration > 20 * l.jerk * l.velocity_up
                : !within(l, c.from.velocity, c.from.acceleration));
  do draw(1.0, c.to.velocity, c.to.acceleration);
  while (!comes_within(l, c.to.velocity, c.to.acceleration));
  const double scale =
      l.velocity_up * (l.velocity_up / l.acceleration_up +
                       std::min(l.acceleration_up / l.jerk, std::sqrt(l.velocity_up / l.jerk)));
  c.to.position =
      whole ? random.integer(-8, 8) / 4.0 : (random.coin() ? 1 : -1) * scale * random.log_uniform(1e-4, 1e2);
  if (random.integer(0, 9) == 0) c.to.position = 0.0;
  return c;
}

/// How far a motion misses its target, as shares of way, velocity and acceleration, beyond what the rounding
/// of its times makes; and by how much its limits are exceeded, as shares, where a start beyond them allows
/// no better.
struct AxisErrors {
  double position = 0, velocity = 0, acceleration = 0;
  double velocity_excess = 0, acceleration_excess = 0, jerk_excess = 0;

  [[nodiscard]] double target() const { return std::max({position, velocity, acceleration}); }
  [[nodiscard]] double limits() const {
    return std::max({velocity_excess, acceleration_excess, jerk_excess});
  }
};

/// Integrates the phases.
template <std::floating_point S>
AxisErrors examine(const AxisCase& c, const state::BasicMotion<S>& motion) {
  const AxisLimits& l = c.limits;
  const Real up =
      std::max<Real>({l.velocity_up, c.from.velocity, settled(c.from.velocity, c.from.acceleration, l.jerk)});
  const Real down = std::min<Real>(
      {-l.velocity_down, c.from.velocity, settled(c.from.velocity, c.from.acceleration, l.jerk)});
  const Real rise = std::max(l.acceleration_up, c.from.acceleration);
  const Real fall = std::min(-l.acceleration_down, c.from.acceleration);
  const Real speed = up - down, steep = rise - fall;
  Real p = c.from.position, v = c.from.velocity, a = c.from.acceleration, time = 0, way = 0;
  AxisErrors e;
  const auto grow = [](double& worst, Real value) { worst = std::max(worst, static_cast<double>(value)); };
  const auto note = [&](Real velocity, Real acceleration) {
    grow(e.velocity_excess, std::max(velocity - up, down - velocity) / speed);
    grow(e.acceleration_excess, std::max(acceleration - rise, fall - acceleration) / steep);
  };
  for (const auto& phase : motion.phases()) {
    const Real t = phase.duration, j = phase.jerk;
    if (std::isfinite(l.jerk)) {
      grow(e.jerk_excess, std::abs(phase.acceleration - a) / steep);  // a jump
      grow(e.jerk_excess, std::abs(j) / l.jerk - 1);
    }
    a = phase.acceleration;
    note(v, a);
    if (j != 0 && -a / j > 0 && -a / j < t) note(v - a * a / (2 * j), 0);
    const Real before = p;
    p += t * (v + t * (a / 2 + t * j / 6));
    v += t * (a + t * j / 2);
    a += t * j;
    time += t;
    way += std::abs(p - before);
    note(v, a);
  }
  const Real instant = 64 * std::numeric_limits<S>::epsilon() * time;
  // the way that it takes to build up the accelerations at both ends
  const Real bends =
      (std::pow(std::abs(Real(c.from.acceleration)), 3) + std::pow(std::abs(Real(c.to.acceleration)), 3)) /
      (Real(l.jerk) * l.jerk);
  const Real scale =
      std::max<Real>({way, std::abs(c.from.position), std::abs(c.to.position), 1e-3 * speed * time, bends});
  const auto miss = [](Real off, Real rounding, Real share) {
    return off == 0 ? 0.0 : static_cast<double>(std::max<Real>(off - rounding, 0) / share);
  };
  e.position = miss(std::abs(p - c.to.position), instant * speed, scale);
  e.velocity = miss(std::abs(v - c.to.velocity), instant * steep, speed);
  e.acceleration = std::isfinite(l.jerk) ? miss(std::abs(a - c.to.acceleration), instant * l.jerk, steep) : 0;
  if (std::isnan(p + v + a)) e.position = std::numeric_limits<double>::infinity();
  return e;
}

}  // namespace cncplan::test
