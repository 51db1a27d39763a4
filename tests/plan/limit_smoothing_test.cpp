#include "cncplan/detail/speed/limit_smoothing.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <sstream>
#include <vector>

#include "cncplan/executor.hpp"
#include "cncplan/path/line.hpp"
#include "cncplan/plan_blocks.hpp"
#include "planned.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

using Smoothing = detail::BasicLimitSmoothing<double>;

constexpr Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 1e4}};

// Rings of short lines one above the other, as ball.nc has them.
std::vector<Block<3>> rings(double radius, int count, double side) {
  std::vector<Block<3>> blocks;
  Vector3 at(radius, 0, 0);
  for (int ring = 0; ring < count; ++ring) {
    const double r = radius - 0.2 * ring;
    const int sides = static_cast<int>(std::ceil(2 * std::numbers::pi * r / side));
    for (int i = 0; i <= sides; ++i) {
      const double angle = 2 * std::numbers::pi * i / sides;
      const Vector3 next(r * std::cos(angle), r * std::sin(angle), -0.1 * ring);
      if ((next - at).norm() > 1e-9) blocks.push_back({.path = path::BasicLine<double, 3>(at, next)});
      at = next;
    }
  }
  return blocks;
}

}  // namespace

TEST_CASE("limits made alike are no higher, and lose no more than is said") {
  test::Random random;
  for (int run = 0; run < 200; ++run) {
    Smoothing level;
    Limits before{};
    Limits center{random.log_uniform(1, 100), random.log_uniform(10, 1e4), random.log_uniform(1e3, 1e6)};
    const double spread = random.log_uniform(1.001, 3.0);
    double lost = 0;
    for (int cell = 0; cell < 300; ++cell) {
      if (random.integer(0, 50) == 0) center.velocity *= random.log_uniform(0.2, 5);
      const auto near = [&](double x) { return x * random.log_uniform(1 / spread, spread); };
      const Limits own{near(center.velocity), near(center.acceleration), near(center.jerk)};
      const double length = random.log_uniform(1e-4, 1);
      const Limits limits = level.next(own, length);
      CAPTURE(run, cell, spread);
      REQUIRE(limits.velocity <= own.velocity);
      REQUIRE(limits.acceleration <= own.acceleration);
      REQUIRE(limits.jerk <= own.jerk);
      REQUIRE(2 * limits.acceleration >= own.acceleration);
      REQUIRE(2 * limits.jerk >= own.jerk);
      if (limits.velocity < own.velocity) {
        REQUIRE(limits.velocity == before.velocity);
        lost += length / limits.velocity - length / own.velocity;
        REQUIRE(lost <= Smoothing::loss * std::sqrt(own.velocity / own.jerk) * (1 + 1e-12));
      } else {
        lost = 0;
      }
      before = limits;
    }
  }
}

TEST_CASE("limits stay the same while those that come serve them, until a motion begins") {
  Smoothing level;
  const Limits low{20, 400, 5000};
  CHECK(level.next(low, 0.1) == low);
  CHECK(level.next({20.001, 700, 9000}, 0.1) == low);
  CHECK(level.next({20, 790, 5000}, 0.1) == low);
  CHECK(level.next({30, 450, 6000}, 0.2) == Limits{30, 400, 5000});  // worth it
  CHECK(level.next({30, 801, 6000}, 0.1) == Limits{30, 801, 6000});  // too far apart
  CHECK(level.next({31, 810, 6100}, 0.1, true) == Limits{31, 810, 6100});
}

TEST_CASE("rings of short lines have about a cell a block, and few junctions") {
  for (const double side : {0.3, 0.8, 1.5}) {
    CAPTURE(side);
    const std::vector<Block<3>> blocks = rings(20, 6, side);
    const auto smoothing = detail::smoothing(std::span(blocks), mill, {0.01, 1e-3, false});
    const junction::Deviation policy{0.01};
    const detail::JunctionRules rules{policy, 0.01, 1e-3};
    const auto cells = detail::make_cells(std::span(blocks), mill, rules, smoothing).value();
    CHECK(10 * cells.segment_limits.size() < 11 * blocks.size());
    std::vector<detail::ConstrainedJunction> junctions(cells.segment_limits.size() + 1);
    CHECK(detail::make_junctions(std::span<const detail::SegmentLimits>(cells.segment_limits), 0.0,
                                 std::span(junctions)) < blocks.size() / 4);
    double length = 0;
    for (const detail::SegmentLimits& cell : cells.segment_limits) length += cell.length;
    double programmed = 0;
    for (const Block<3>& block : blocks) programmed += block.path.length();
    CHECK_THAT(length, Catch::Matchers::WithinRel(programmed, 1e-12));
  }
}

TEST_CASE("an executor that looks ahead over 64 cells takes the time of the plan within a tolerance") {
  const std::vector<Block<3>> blocks = rings(20, 4, 0.8);
  const auto executor = std::make_unique<Executor<Machine<3>, 64, Block<3>>>(mill);
  std::size_t pushed = 0;
  int ticks = 0;
  for (; !executor->finished() && ticks < 100000; ++ticks) {
    while (pushed < blocks.size() && executor->push(blocks[pushed]))
      if (++pushed == blocks.size()) executor->end_of_program();
    executor->tick(1e-3);
  }
  const double planned =
      plan_blocks(blocks, mill, {.tolerance = 0.01, .level = SmoothLevel::fast})->duration();
  CHECK_THAT(ticks * 1e-3, Catch::Matchers::WithinRel(planned, 1e-3));
}
