// The search for the least time of a hold against closed forms, and the holds of an executor against the
// search.
#include "optimum/least_hold.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/path/line.hpp"
#include "cncplan/plan_program.hpp"
#include "cncplan/trajectory_executor.hpp"
#include "optimum/hold_beside.hpp"
#include "support/catch.hpp"

using namespace cncplan;
using namespace cncplan::test;

namespace {

constexpr Limits limits{.velocity = 30, .acceleration = 1000, .jerk = 10000};

template <class P>
double found(const P& path, double velocity, double acceleration, const Limits& most, double first,
             int steps = 80) {
  const LeastHold search(path, path.length(), velocity, acceleration, most, steps);
  const auto hold = search.search(first);
  CHECK(hold.beyond < 1e-3);
  return hold.time;
}

}  // namespace

TEST_CASE("least hold: on a line it is the closed form") {
  const path::BasicLine<double, 3> line({0, 0, 0}, {60, 80, 0});
  CHECK(found(line, 30, 0, limits, 0.2) == Approx(2 * std::sqrt(30 / 1e4)).epsilon(1e-4));
  // by 30 / 1000 s of jerk to no acceleration, 34.5 mm/s then; from there with a stretch of 500 mm/s^2
  const Limits soft{.velocity = 30, .acceleration = 500, .jerk = 10000};
  CHECK(found(line, 30, 300, soft, 0.2) == Approx(0.03 + 34.5 / 500 + 0.05).epsilon(2e-3));
  // from a brake that goes on
  CHECK(found(line, 100, -200, {.velocity = 100, .acceleration = 1000, .jerk = 1e5}, 0.2) ==
        Approx(0.008 + (100 - 0.5 * 1000 * 0.01 - 0.008 * 600) / 1000 + 0.01).epsilon(2e-3));
}

TEST_CASE(
    "least hold: on a circle its motion keeps the limits by differences, and finer grids find the same") {
  const auto circle =
      path::arc_from_center(Vector3(0, 0, 0), {100, 0, 0}, {50, 0, 0}, Turn::clockwise, Plane::xy);
  REQUIRE(circle);
  const Limits slow{.velocity = 50, .acceleration = 500, .jerk = 50};
  const double coarse = found(*circle, 24, 0, slow, 2.5, 40), fine = found(*circle, 24, 0, slow, 2.5, 120);
  CHECK(fine == Approx(coarse).epsilon(2e-3));
  const LeastHold search(*circle, circle->length(), 24, 0, slow, 40);
  const auto hold = search.search(2.5);
  constexpr int parts = 25;  // of a step
  const double t = hold.time / static_cast<double>(hold.jerk.size()) / parts;
  std::vector<Vector3> p;
  double s = 0, v = 24, a = 0, most = 0;
  for (const double j : hold.jerk)
    for (int i = 0; i < parts; ++i) {
      p.emplace_back(50 - 50 * std::cos(s / 50), 50 * std::sin(s / 50), 0);
      s += t * (v + t * (a / 2 + t * j / 6)), v += t * (a + t * j / 2), a += t * j;
    }
  for (std::size_t i = 3; i < p.size(); ++i)
    most = std::max(most, (p[i] - 3 * p[i - 1] + 3 * p[i - 2] - p[i - 3]).norm() / (t * t * t));
  CHECK(most == Approx(50).epsilon(0.01));
  CHECK(std::abs(v) < 1e-3);
  const path::BasicLine<double, 3> line({0, 0, 0}, {100, 0, 0});
  CHECK(fine > found(line, 24, 0, slow, 2.5));  // where the bend takes no jerk
}

TEST_CASE("least hold: holds of an executor are no sooner, and little later") {
  const Machine<3> mill{.limits = limits};
  const auto trajectory = plan_text("F1800 G1 X20\nY20\nX25 Y22\nG3 X30 Y10 R12\nG1 X28 Y2\nX0 Y0\n", mill,
                                    {.level = SmoothLevel::good, .hold_factor = 1.5});
  REQUIRE(trajectory);
  std::vector<double> ratios;
  for (double at = 0.1; at < trajectory->duration() - 0.1; at += 0.17) {
    TrajectoryExecutor executor(*trajectory, mill, {.hold_factor = 1.5});
    constexpr double period = 1e-4;
    while (executor.clock().position < at) executor.tick(period);
    const auto [time, least] = hold_beside(executor, *trajectory, limits, period, 60);
    INFO(at << ": " << time << ", least " << least);
    REQUIRE(least > 0);
    ratios.push_back((time - period) / least);
    CHECK(ratios.back() > 0.98);
    CHECK(ratios.back() < 1.7);
  }
  std::ranges::sort(ratios);
  REQUIRE(ratios.size() > 10);
  CHECK(ratios[ratios.size() / 2] < 1.15);
}
