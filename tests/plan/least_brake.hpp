// The least time of a brake on a straight line, in closed form.
#pragma once

#include <algorithm>
#include <cmath>

namespace cncplan::test {

// s to rest on a straight line, from a speed and an acceleration, in closed form. On a bend, where jerk
// across the path turns into some along it, it may be a little less.
inline double least_time(double v, double a, double most, double jerk) {
  const double settled = v + std::max(a, 0.0) * std::abs(a) / (2 * jerk);
  const double push = std::max(-a, 0.0), lead = std::max(a, 0.0) / jerk;
  const double peak = std::sqrt(jerk * settled + push * push / 2);
  if (peak < push) return push / jerk;  // it brakes too hard already
  if (peak <= most) return lead + (2 * peak - push) / jerk;
  const double rises = (most * most - push * push) / (2 * jerk), falls = most * most / (2 * jerk);
  return lead + (2 * most - push) / jerk + (settled - rises - falls) / most;
}

}  // namespace cncplan::test
