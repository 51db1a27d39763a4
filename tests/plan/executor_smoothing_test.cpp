// An executor within a tolerance: no jump of velocity or acceleration, whatever is asked.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "cncplan/plan/executor.hpp"
#include "cncplan/plan/plan_blocks.hpp"
#include "support/catch.hpp"
#include "support/executor_check.hpp"
#include "support/executor_machines.hpp"

using namespace cncplan;

namespace {

constexpr Machine<3> mill{.axes = {{{.letter = 'X', .velocity = 50, .acceleration = 800, .jerk = 20000},
                                    {.letter = 'Y', .velocity = 50, .acceleration = 1000, .jerk = 20000},
                                    {.letter = 'Z', .velocity = 20, .acceleration = 300, .jerk = 5000}}},
                          .limits = {.velocity = 40, .acceleration = 1000, .jerk = 10000}};
constexpr double period = 1e-3;

void check_faults(const test::ExecutorFaults& faults) {
  CHECK(faults.finished);
  CHECK_FALSE(faults.failed);
  CHECK_FALSE(faults.words_wrong);
  CHECK(faults.velocity <= 1e-6);
  CHECK(faults.acceleration <= 1e-6);
  CHECK(faults.jerk <= 1e-6);
  CHECK(faults.way <= 0);
  CHECK(faults.rate <= 1e-6);
  CHECK(faults.change <= 1e-6);
  CHECK(faults.place <= 0);
  CHECK(faults.end < 1e-9);
}

}  // namespace

TEST_CASE("within a tolerance random requests break no limit, at joints neither", "[executor]") {
  test::Random random;
  for (int round = 0; round < 60; ++round) {
    const double tolerance = random.log_uniform(1e-3, 0.1), reach = random.log_uniform(0.5, 50);
    const auto lines = test::random_lines(random, 120, {0, 0, 0}, reach, "");
    CAPTURE(round, tolerance, reach);
    const test::Disturbance how{
        .mean_gap = random.integer(3, 60), .restless = 3000, .period = period, .tolerance = tolerance};
    check_faults(test::run<64>(mill, test::blocks_of(lines, mill), random, how));
    check_faults(test::run<16>(mill, test::blocks_of(lines, mill), random, how));
  }
}

TEST_CASE("within a tolerance six axes keep their limits at joints, whatever is asked", "[executor]") {
  test::Random random;
  for (int round = 0; round < 25; ++round) {
    const double tolerance = random.log_uniform(1e-3, 0.1);
    const auto lines = test::random_lines(random, 80, {0, 0, 30}, 20, "ACU");
    CAPTURE(round, tolerance);
    const test::Disturbance how{
        .mean_gap = random.integer(3, 60), .restless = 3000, .period = period, .tolerance = tolerance};
    check_faults(test::run<64>(test::six_axes, test::blocks_of(lines, test::six_axes), random, how));
  }
}

TEST_CASE("blocks that wait for others go on when the machine has rested for long enough", "[executor]") {
  const auto blocks = test::blocks_of({"F1200", "G1 X5", "Y5", "X10"}, mill);
  const auto executor = std::make_unique<Executor<Machine<3>, 64>>(
      mill, Executor<Machine<3>, 64>::Options{.longest_wait = 0.1});
  REQUIRE(executor->push(blocks[0]));
  REQUIRE(executor->push(blocks[1]));
  double began = 0;
  SetPoint<3> point;
  for (int tick = 1; tick <= 2000; ++tick) {
    point = executor->tick(period);
    if (began == 0 && point.along.velocity > 0) began = tick * period;
  }
  CHECK(began == Approx(0.1).margin(2.5 * period));
  CHECK(point.position == Vector3(5, 5, 0));
  CHECK_FALSE(executor->finished());
  REQUIRE(executor->push(blocks[2]));
  executor->end_of_program();
  while (!executor->finished()) point = executor->tick(period);
  CHECK(point.position == Vector3(10, 5, 0));
}

TEST_CASE("a hold on a smoothed corner: stop there, begin anew there", "[executor]") {
  const std::vector<std::string> lines{"F1200", "G1 X10", "Y10", "X0", "Y20"};
  const auto blocks = test::blocks_of(lines, mill);
  using Runner = Executor<Machine<3>, 64>;
  const auto executor = std::make_unique<Runner>(mill, Runner::Options{.tolerance = 0.05});
  const auto load = [&] {
    for (const auto& block : blocks) REQUIRE(executor->push(block));
    executor->end_of_program();
  };
  load();
  SetPoint<3> point;
  // to rest before the corner of X10, on its curve: the corner is 0.01 mm and more from both lines
  bool held = false;
  while (!executor->finished()) {
    point = executor->tick(period);
    if (!held && point.line == 2 && point.position[0] > 9.0) executor->stop(), held = true;
  }
  REQUIRE(held);
  const Vector3 stopped = point.position;
  REQUIRE(executor->restart(point.line, stopped));
  load();
  auto before = executor->tick(period);
  CHECK((before.position - stopped).norm() < 1e-3);
  while (!executor->finished()) {
    point = executor->tick(period);
    for (int i = 0; i < 3; ++i) {
      const auto& axis = mill.axes[static_cast<std::size_t>(i)];
      CHECK(std::abs(point.position[i] - before.position[i]) <= axis.velocity * period * (1 + 1e-9));
      CHECK(std::abs(point.velocity[i] - before.velocity[i]) <= axis.acceleration * period * (1 + 1e-6));
      CHECK(std::abs(point.acceleration[i] - before.acceleration[i]) <= axis.jerk * period * (1 + 1e-6));
    }
    before = point;
  }
  CHECK_FALSE(executor->error());
  CHECK(point.position == Vector3(0, 20, 0));
}
