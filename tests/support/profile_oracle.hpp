// What a profile does, found by integrating its emitted phases in long double, and what it could do at best,
// found by bisection: oracles that share nothing with the solver.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "cncplan/core/limits.hpp"
#include "cncplan/profile/boundary.hpp"
#include "cncplan/profile/profile.hpp"
#include "support/random.hpp"

namespace cncplan::test {

using Real = long double;

struct ProfileCase {
  double length;
  profile::BoundarySpeeds speeds;
  Limits limits;

  /// A literal to paste into a regression test.
  [[nodiscard]] std::string literal() const {
    char text[256];
    std::snprintf(text, sizeof text, "ProfileCase{%.17g, {%.17g, %.17g}, {%.17g, %.17g, %.17g}}", length,
                  speeds.start, speeds.end, limits.velocity, limits.acceleration, limits.jerk);
    return text;
  }
};

/// Errors of one profile. Position and speed in units of the machine epsilon times the largest magnitude
/// involved; the rest relative.
struct ProfileErrors {
  double end_position{};
  double end_speed{};
  double end_acceleration{};
  double continuity{};  ///< largest jump of position or speed between the phases of the table, in epsilons
  double velocity_excess{};
  double acceleration_excess{};
  double jerk_excess{};
  double lowest_speed{};  ///< below zero by that much, relative to the speed limit
  double time_loss{};     ///< duration over the optimum - 1
};

/// Distance of a ramp with zero acceleration at both ends, from the definition of its shape.
inline Real ramp_distance(Real from, Real to, Real acceleration, Real jerk, bool seven) {
  const Real change = std::abs(to - from);
  Real duration = 2 * std::sqrt(change / jerk);
  if (change * jerk > acceleration * acceleration)
    duration = seven ? change / acceleration + acceleration / jerk : 2 * change / acceleration;
  return (from + to) / 2 * duration;
}

/// The shortest time, by bisection on the top speed.
inline Real best_duration(const ProfileCase& c, bool seven) {
  const Real acceleration = c.limits.acceleration, jerk = c.limits.jerk;
  const auto ramps = [&](Real top) {
    return ramp_distance(c.speeds.start, top, acceleration, jerk, seven) +
           ramp_distance(top, c.speeds.end, acceleration, jerk, seven);
  };
  // bisect on the speed above the higher end, where doubles are dense
  const Real base = std::max(c.speeds.start, c.speeds.end);
  Real low = 0, high = static_cast<Real>(c.limits.velocity) - base;
  if (ramps(base + high) > c.length)
    for (int halving = 0; halving < 400 && low < high; ++halving) {
      const Real middle = halving < 200 && low == 0 ? high * 0.25L : (low + high) / 2;
      if (middle <= low || middle >= high) break;
      (ramps(base + middle) <= c.length ? low : high) = middle;
    }
  else
    low = high;
  const Real top = base + low;
  const auto time = [&](Real from, Real to) {
    const Real sum = from + to;
    return sum > 0 ? 2 * ramp_distance(from, to, acceleration, jerk, seven) / sum : 0;
  };
  return time(c.speeds.start, top) + time(top, c.speeds.end) + (c.length - ramps(top)) / top;
}

/// How much longer a profile takes than the best, relative; a bound from above where that is below 1e-12.
/// With a top speed a little higher the ramps alone must be longer than the length, so the best time lies
/// between the two.
inline double time_loss(const ProfileCase& c, const profile::Profile& p, bool seven) {
  const auto bisected = [&] { return static_cast<double>(p.duration() / best_duration(c, seven) - 1); };
  const auto& parts = p.parts();
  const bool rising = c.speeds.start <= c.speeds.end;
  const auto& ramp = rising ? parts.down : parts.up;  // next to the higher end speed
  const Real high = std::max(c.speeds.start, c.speeds.end);
  const Real climb =
      std::abs(static_cast<Real>(ramp.acceleration) * (static_cast<Real>(ramp.first) + ramp.hold));
  const Real top = high + climb * (1 + 1e-13L);
  if (top > c.limits.velocity || parts.cruise * top > 1e-12L * c.length) return bisected();
  const Real acceleration = c.limits.acceleration, jerk = c.limits.jerk;
  const Real first = ramp_distance(c.speeds.start, top, acceleration, jerk, seven);
  const Real second = ramp_distance(top, c.speeds.end, acceleration, jerk, seven);
  if (!(first + second > c.length)) return bisected();
  const Real time = 2 * first / (c.speeds.start + top) + 2 * second / (top + c.speeds.end) +
                    (c.length - first - second) / top;
  const double loss = static_cast<double>(p.duration() / time - 1);
  return loss < 1e-12 ? loss : bisected();
}

/// Integrates the phases and compares with what was asked for. Finite limits.
inline ProfileErrors examine(const ProfileCase& c, const profile::Profile& p) {
  constexpr Real epsilon = std::numeric_limits<double>::epsilon();
  const Real fastest = std::max<Real>(p.peak().velocity, 1e-300L);
  const Real farthest = std::max<Real>(c.length, 1e-300L);
  ProfileErrors errors;
  const auto grow = [](double& worst, Real value) { worst = std::max(worst, static_cast<double>(value)); };
  Real position = 0, velocity = c.speeds.start, acceleration = p.start_acceleration();
  const auto table = p.phases();
  for (const Phase& phase : table) {
    if (phase.duration == 0) continue;
    grow(errors.continuity, std::abs(position - phase.position) / farthest / epsilon);
    grow(errors.continuity, std::abs(velocity - phase.velocity) / fastest / epsilon);
    const Real t = phase.duration, j = phase.jerk;
    const Real last_acceleration = acceleration + j * t;
    Real highest = velocity;
    if (acceleration > 0 && last_acceleration < 0) highest = velocity - acceleration * acceleration / (2 * j);
    position += t * (velocity + t * (acceleration / 2 + t * j / 6));
    velocity += t * (acceleration + t * j / 2);
    acceleration = last_acceleration;
    grow(errors.velocity_excess, std::max(highest, velocity) / c.limits.velocity - 1);
    grow(errors.lowest_speed, -velocity / c.limits.velocity);
    grow(errors.acceleration_excess, std::abs(acceleration) / c.limits.acceleration - 1);
    grow(errors.jerk_excess, std::abs(j) / c.limits.jerk - 1);
  }
  grow(errors.end_position, std::abs(position - c.length) / farthest / epsilon);
  grow(errors.end_speed, std::abs(velocity - c.speeds.end) / fastest / epsilon);
  grow(errors.end_acceleration, std::abs(acceleration) / c.limits.acceleration);
  return errors;
}

/// Draws over the whole domain: lengths 1e-9 to 1e6, speeds to 1e4, accelerations 1 to 1e7, jerks 1 to 1e10,
/// with the corners (equal speeds, rest, already at the top speed, ramps that just fit) drawn often.
inline ProfileCase draw(Random& random) {
  ProfileCase c{};
  c.limits = {random.log_uniform(1e-3, 1e4), random.log_uniform(1.0, 1e7), random.log_uniform(1.0, 1e10)};
  const auto speed = [&] {
    switch (random.integer(0, 5)) {
      case 0:
        return 0.0;
      case 1:
        return c.limits.velocity;
      case 2:
        return c.limits.velocity * random.log_uniform(1e-12, 1.0);
      case 3:
        return c.limits.velocity * (1.0 - random.log_uniform(1e-15, 1.0));
      default:
        return c.limits.velocity * random.uniform(0.0, 1.0);
    }
  };
  c.speeds.start = speed();
  switch (random.integer(0, 4)) {
    case 0:
      c.speeds.end = c.speeds.start;
      break;
    case 1:
      c.speeds.end = c.speeds.start * (1.0 - random.log_uniform(1e-16, 1e-2));
      break;
    default:
      c.speeds.end = speed();
  }
  if (random.coin()) std::swap(c.speeds.start, c.speeds.end);
  const double direct = static_cast<double>(
      ramp_distance(c.speeds.start, c.speeds.end, c.limits.acceleration, c.limits.jerk, random.coin()));
  c.length = random.log_uniform(1e-9, 1e6);
  const double near_direct = direct * (1.0 + random.log_uniform(1e-16, 1e3));
  if (random.integer(0, 3) != 0 && near_direct >= 1e-9 && near_direct <= 1e6) c.length = near_direct;
  return c;
}

}  // namespace cncplan::test
