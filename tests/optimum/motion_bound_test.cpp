// The bounds by linear programming against closed forms, and against the figures of an earlier study.
#include "optimum/motion_bound.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "support/catch.hpp"

using namespace cncplan;
using test::MotionBound;

namespace {

constexpr Limits slow{.velocity = 30, .acceleration = 1000, .jerk = 1e4};

// mm. From rest to rest along a line: jerk phases of time / 4; with A in between; with V in between.
double straight(const Limits& limits, double time) {
  const auto& [v, a, j] = limits;
  const double ramp = test::ramp_time(limits);
  if (time >= 2 * ramp) return v * (time - ramp);
  if (time >= 4 * a / j) return a * (time / 2 - a / j) * time / 2;
  return j * std::pow(time, 3) / 32;
}

double straight_bound(const Limits& limits, double time, double direction, int cells) {
  const Eigen::Vector2d along(std::cos(direction), std::sin(direction)), end(0, 0);
  MotionBound bound(limits, 0.01, {{{-2 * limits.velocity * time * along, end}, time, cells}});
  for (const Eigen::Vector2d& axis : {Eigen::Vector2d(1, 0), Eigen::Vector2d(0, 1)}) {
    for (const int node : {0, cells})
      for (const auto what : {MotionBound::Of::velocity, MotionBound::Of::acceleration})
        bound.fix(node, what, axis, 0);
    bound.fix(cells, MotionBound::Of::position, axis, 0);
  }
  return bound.farthest_start(-along);
}

double degrees(double turn) { return turn * std::numbers::pi / 180; }

}  // namespace

TEST_CASE("motion bound: from rest to rest along a line, not below the closed form and near it") {
  const struct {
    Limits limits;
    double time;
  } cases[] = {{slow, 0.15},
               {slow, 0.3},
               {{.velocity = 30, .acceleration = 300, .jerk = 1e4}, 0.2},
               {{.velocity = 30, .acceleration = 300, .jerk = 1e4}, 0.4},
               {{.velocity = 100, .acceleration = 2000, .jerk = 4e4}, 0.17}};
  for (const auto& [limits, time] : cases)
    for (const double direction : {0.0, 0.3}) {
      CAPTURE(limits.acceleration, time, direction);
      const double exact = straight(limits, time), bound = straight_bound(limits, time, direction, 24);
      CHECK(bound >= exact * (1 - 1e-9));
      CHECK(bound <= exact * 1.004);
    }
}

TEST_CASE("motion bound: without a tolerance a corner is a stop") {
  for (const auto& [turn, share] : {std::pair(30.0, 0.98), std::pair(90.0, 0.95)}) {
    CAPTURE(turn);
    const double loss = test::corner_bound(slow, 1e-7, degrees(turn), 20);
    CHECK(loss <= test::ramp_time(slow) + 1e-9);
    CHECK(loss >= test::ramp_time(slow) * share);
  }
}

TEST_CASE("motion bound: no turn loses nothing, and no motion is faster than its limit") {
  CHECK(std::abs(test::corner_bound(slow, 0.01, 0, 16)) < 2 * 0.01 / 30 + 1e-9);
  MotionBound bound(slow, 0.01, {{{{-10, 0}, {0, 0}}, 0.1, 10}});
  bound.stay(10, {{0, 0}, {0, 0}});
  // at full speed all the time, and a tolerance before the end
  CHECK(std::abs(bound.farthest_start({-1, 0}) - (0.1 * 30 + 0.01)) < 1e-6);
}

TEST_CASE("motion bound: what cannot be is said") {
  // from rest to rest 0.5 mm farther in a time in which 0.3125 mm can be done
  MotionBound bound(slow, 0.01, {{{{-10, 0}, {0, 0}}, 0.1, 10}});
  for (const int node : {0, 10})
    for (const auto what : {MotionBound::Of::velocity, MotionBound::Of::acceleration})
      bound.fix(node, what, {1, 0}, 0);
  bound.fix(0, MotionBound::Of::position, {1, 0}, -0.5);
  bound.fix(10, MotionBound::Of::position, {1, 0}, 0);
  CHECK(bound.farthest_start({-1, 0}) < 0);
}

// The study's jerk is constant in its cells, which makes it a little slower, and within a polygon outside the
// circle, which makes it faster by up to 0.9 %.
TEST_CASE("motion bound: corners as an independent program found them") {
  const struct {
    double turn, tolerance, loss;
  } cases[] = {
      {90, 0.01, 0.0700}, {30, 0.01, 0.0567}, {10, 0.01, 0}, {150, 0.01, 0.0509}, {90, 0.05, 0.0386}};
  for (const auto& [turn, tolerance, loss] : cases) {
    CAPTURE(turn, tolerance);
    const double bound = test::corner_bound(slow, tolerance, degrees(turn), 20);
    CHECK(bound <= loss * 1.01 + 1e-5);
    CHECK(bound >= loss * 0.99 - 2e-4);
  }
}
