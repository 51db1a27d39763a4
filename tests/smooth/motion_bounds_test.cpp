// Bounds of what a phase uses of the limits, against dense samples by the formula of motion.
#include "cncplan/detail/speed/motion_bounds.hpp"

#include <algorithm>
#include <cmath>

#include "cncplan/core/path_point.hpp"
#include "cncplan/detail/speed/speed_law.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

namespace {

using namespace cncplan;
using namespace cncplan::detail;

TEST_CASE("the use of limits by a phase is bounded, and not by much too high") {
  test::Random random;
  double below = 0, above = 0;
  for (int i = 0; i < 2000; ++i) {
    SpeedCell<4> cell;
    cell.length = random.log_uniform(1e-3, 0.3);
    cell.feed = random.log_uniform(1, 100);
    for (int axis = 0; axis < 4; ++axis) {
      cell.first[axis] = random.uniform(-1, 1);
      cell.second[axis] = random.uniform(-0.3, 0.3) / cell.length;
      cell.third[axis] = random.uniform(-0.3, 0.3) / (cell.length * cell.length);
    }
    MotionLimits<4> limits;
    limits.tool = {50, 1000, 1e4};
    limits.tool_axes = {1, 3, -1};
    limits.axes[2] = {40, 300, 3e3};
    const double v = random.log_uniform(0.1, 30), h = cell.length;
    // A part of the cell, with a change of speed of up to a third.
    const double next = v * random.uniform(0.7, 1.3), T = h / std::max(v, next);
    const auto pair =
        phases_between(h, v, random.uniform(-0.2, 0.2) * v / T, next, random.uniform(-0.2, 0.2) * v / T);
    for (const Phase& phase : pair) {
      const Utilisation bound = utilisation_of(phase, cell, limits);
      Utilisation most;
      for (int k = 0; k <= 200; ++k) {
        const State along = phase.at(phase.duration * k / 200);
        const PathPoint<VectorN<double, 4>> at{VectorN<double, 4>::Zero(), cell.first_at(along.position),
                                               cell.second_at(along.position), cell.third};
        const auto axes = motion(at, along);
        const auto tool = [](const VectorN<double, 4>& x) { return std::hypot(x[1], x[3]); };
        most.include({std::max({tool(axes.velocity) / std::min(50.0, cell.feed),
                                std::abs(axes.velocity[2]) / 40, along.velocity / cell.feed}),
                      std::max(tool(axes.acceleration) / 1000, std::abs(axes.acceleration[2]) / 300),
                      std::max(tool(axes.jerk) / 1e4, std::abs(axes.jerk[2]) / 3e3)});
      }
      for (const auto part : {&Utilisation::velocity, &Utilisation::acceleration, &Utilisation::jerk}) {
        below = std::max(below, most.*part / (bound.*part) - 1);
        above = std::max(above, bound.*part / (most.*part) - 1);
      }
    }
  }
  CHECK(below < 1e-12);
  CHECK(above < 0.7);
}

TEST_CASE("two phases of constant jerk meet both of their ends") {
  test::Random random;
  for (int i = 0; i < 1000; ++i) {
    const double v0 = random.log_uniform(0.1, 100), v1 = v0 * random.uniform(0.5, 2),
                 h = random.log_uniform(1e-3, 10);
    const double a0 = random.uniform(-0.3, 0.3) * v0 * v0 / h, a1 = random.uniform(-0.3, 0.3) * v0 * v0 / h;
    const auto [first, second] = phases_between(h, v0, a0, v1, a1);
    const State between = first.at(first.duration), end = second.at(second.duration);
    CHECK(between.position == Approx(second.position));
    CHECK(first.velocity == v0);
    CHECK(first.acceleration == a0);
    CHECK(end.position == Approx(h));
    CHECK(end.velocity == Approx(v1));
    CHECK(end.acceleration == Approx(a1).margin(1e-9 * v0 * v0 / h));
  }
}

// q''' is third + spread sin(k s + phase) for each axis: its integrals by hand.
TEST_CASE("what is not known of the third derivative is in the bounds") {
  test::Random random;
  double below = 0, least_of_spread = 1;
  for (int i = 0; i < 2000; ++i) {
    SpeedCell<2> cell;
    cell.length = random.log_uniform(1e-3, 0.3);
    cell.feed = 1e3;
    const double h = cell.length;
    VectorN<double, 2> wave, shift;
    for (int axis = 0; axis < 2; ++axis) {
      cell.first[axis] = random.uniform(-1, 1);
      cell.second[axis] = random.uniform(-0.3, 0.3) / h;
      cell.third[axis] = random.uniform(-0.3, 0.3) / (h * h);
      cell.spread[axis] = random.uniform(0, 1) / (h * h);
      wave[axis] = random.log_uniform(0.1, 10) / h;
      shift[axis] = random.uniform(-3, 3);
    }
    MotionLimits<2> limits;
    limits.tool = {50, 1000, 1e4};
    limits.axes[1] = {40, 300, 3e3};
    const double v = random.log_uniform(0.1, 30), next = v * random.uniform(0.7, 1.3),
                 T = h / std::max(v, next);
    const auto pair =
        phases_between(h, v, random.uniform(-0.2, 0.2) * v / T, next, random.uniform(-0.2, 0.2) * v / T);
    for (const Phase& phase : pair) {
      const Utilisation bound = utilisation_of(phase, cell, limits);
      SpeedCell<2> known = cell;
      known.spread.setZero();
      least_of_spread = std::min(least_of_spread, utilisation_of(phase, known, limits).jerk / bound.jerk);
      Utilisation most;
      for (int k = 0; k <= 100; ++k) {
        const State along = phase.at(phase.duration * k / 100);
        const double x = along.position;
        PathPoint<VectorN<double, 2>> at{VectorN<double, 2>::Zero(), cell.first_at(x), cell.second_at(x),
                                         cell.third};
        for (int axis = 0; axis < 2; ++axis) {
          const double w = wave[axis], p = shift[axis], d = cell.spread[axis];
          at.third[axis] += d * std::sin(w * x + p);
          at.second[axis] += d * (std::cos(p) - std::cos(w * x + p)) / w;
          at.first[axis] += d * (x * std::cos(p) / w - (std::sin(w * x + p) - std::sin(p)) / (w * w));
        }
        const auto axes = motion(at, along);
        most.include({std::max(axes.velocity.norm() / 50, std::abs(axes.velocity[1]) / 40),
                      std::max(axes.acceleration.norm() / 1000, std::abs(axes.acceleration[1]) / 300),
                      std::max(axes.jerk.norm() / 1e4, std::abs(axes.jerk[1]) / 3e3)});
      }
      for (const auto part : {&Utilisation::velocity, &Utilisation::acceleration, &Utilisation::jerk})
        below = std::max(below, most.*part / (bound.*part) - 1);
    }
  }
  CHECK(below < 1e-9);
  CHECK(least_of_spread < 0.9);
}

}  // namespace
