// The least time to rest through two stretches of different limits, by search: nothing of the brake's.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "cncplan/core/limits.hpp"

namespace cncplan::test {

/// From speed v and acceleration a, `room` mm before the border between two stretches. In the first one the
/// acceleration goes to -p at full jerk, stays there up to a time r, and goes back to 0 at full jerk; in the
/// second the way to rest is the textbook's. A grid over p and r is made finer round its best point.
class BrakeOracle {
 public:
  BrakeOracle(double v, double a, double room, const Limits& first, const Limits& second)
      : v_(v), a_(a), room_(room), first_(first), second_(second) {}

  /// Infinity where no such motion is within limits.
  [[nodiscard]] double least_time() const {
    const double longest = 4.0 * (v_ / first_.acceleration + std::sqrt(v_ / first_.jerk) +
                                  (std::abs(a_) + first_.acceleration) / first_.jerk);
    double p_low = std::max(0.0, -a_), p_high = first_.acceleration, r_low = 0.0, r_high = longest;
    double best = std::numeric_limits<double>::infinity();
    for (int zoom = 0; zoom < 14; ++zoom) {
      constexpr int grid = 40;
      double best_p = (p_low + p_high) / 2, best_r = (r_low + r_high) / 2;
      for (int i = 0; i <= grid; ++i)
        for (int k = 0; k <= grid; ++k) {
          const double p = p_low + (p_high - p_low) * i / grid;
          const double r = r_low + (r_high - r_low) * k / grid;
          const double t = time(p, r);
          if (t < best) best = t, best_p = p, best_r = r;
        }
      const double p_reach = (p_high - p_low) / 5, r_reach = (r_high - r_low) / 5;
      p_low = std::max(std::max(0.0, -a_), best_p - p_reach);
      p_high = std::min(first_.acceleration, best_p + p_reach);
      r_low = std::max(0.0, best_r - r_reach);
      r_high = best_r + r_reach;
    }
    return std::min(best, in_first());
  }

 private:
  struct Point {
    double t, s, v, a;
  };

  // Within one stretch: to a peak, along it if that is the limit, and back to zero.
  static double to_rest(double v, double a, const Limits& limits) {
    const double J = limits.jerk, A = limits.acceleration;
    const double sum = J * v + a * a / 2;  // the peak's square
    if (a < 0.0 && v < a * a / (2 * J)) return std::numeric_limits<double>::infinity();
    if (sum <= A * A) return (2 * std::sqrt(sum) + a) / J;
    return (2 * A + a) / J + (v - (2 * A * A - a * a) / (2 * J)) / A;
  }

  // All of it in the first stretch, if there is room, by steps: distance as it comes.
  [[nodiscard]] double in_first() const {
    const double t = to_rest(v_, a_, first_);
    if (!std::isfinite(t)) return t;
    const double J = first_.jerk;
    const double p = std::min(std::sqrt(J * v_ + a_ * a_ / 2), first_.acceleration);
    Point x{0, 0, v_, a_};
    move(x, (p + a_) / J, -J);
    move(x, t - (2 * p + a_) / J, 0.0);
    move(x, p / J, J);
    return x.s <= room_ ? t : std::numeric_limits<double>::infinity();
  }

  static void move(Point& x, double t, double j) {
    x = {x.t + t, x.s + t * (x.v + t * (x.a / 2 + t * j / 6)), x.v + t * (x.a + t * j / 2), x.a + t * j};
  }

  [[nodiscard]] double time(double p, double r) const {
    constexpr double never = std::numeric_limits<double>::infinity();
    const double J = first_.jerk;
    Point x{0, 0, v_, a_};
    const double ramp = (p + a_) / J;
    const double braking[][2] = {{std::min(ramp, r), -J}, {std::max(r - ramp, 0.0), 0.0}};
    for (const auto& [t, j] : braking)
      if (across(x, t, j)) return x.v < 0.0 ? never : behind(x);
    if (x.a < 0.0 && across(x, -x.a / J, J)) return x.v < 0.0 ? never : behind(x);
    if (!(x.v > 0.0)) return never;
    if (x.a > 0.0) return never;
    move(x, (room_ - x.s) / x.v, 0.0);
    return behind(x);
  }

  [[nodiscard]] double behind(const Point& x) const {
    if (-x.a > second_.acceleration * (1 + 1e-9) || x.a > second_.acceleration)
      return std::numeric_limits<double>::infinity();
    return x.t + to_rest(x.v, x.a, second_);
  }

  // Moves on for t, or to the border if that comes first: then true.
  bool across(Point& x, double t, double j) const {
    Point end = x;
    move(end, t, j);
    if (end.s < room_) return x = end, false;
    double low = 0.0, high = t;
    for (int halving = 0; halving < 60; ++halving) {
      const double middle = (low + high) / 2;
      Point at = x;
      move(at, middle, j);
      (at.s < room_ ? low : high) = middle;
    }
    move(x, high, j);
    return true;
  }

  double v_, a_, room_;
  Limits first_, second_;
};

}  // namespace cncplan::test
