// An executor within a tolerance: no jump of velocity or acceleration, whatever is asked.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "cncplan/executor.hpp"
#include "cncplan/plan_blocks.hpp"
#include "support/catch.hpp"
#include "support/executor_check.hpp"
#include "support/executor_machines.hpp"

using namespace cncplan;

namespace {

constexpr double period = 1e-3;

void check(const test::ExecutorFaults& faults, double relative) {
  CHECK(faults.finished);
  CHECK_FALSE(faults.failed);
  CHECK_FALSE(faults.words_wrong);
  CHECK(faults.velocity <= relative);
  CHECK(faults.acceleration <= relative);
  CHECK(faults.jerk <= relative);
  CHECK(faults.way <= 0);
  CHECK(faults.rate <= relative);
  CHECK(faults.change <= relative);
  CHECK(faults.place <= 0);
  CHECK(faults.dwell <= 0);
  CHECK(faults.end < relative);
}

// Programs under requests, with look-ahead starved, and rings of two sizes.
template <MachineModel M>
void disturb(const M& machine, const std::string& letters, int sequences, double relative = 1e-6,
             double rounding = 1e-9) {
  test::Random random;
  for (int sequence = 0; sequence < sequences; ++sequence) {
    const double tolerance = random.log_uniform(1e-3, 0.1), reach = random.log_uniform(0.5, 50);
    const auto lines = test::random_lines(random, random.integer(1, 120), {0, 0, 0}, reach, letters);
    const auto blocks = test::blocks_of(lines, machine);
    CAPTURE(sequence, tolerance, test::literal(lines));
    const test::Disturbance how{.mean_gap = random.integer(0, 3) == 0 ? 1 : random.integer(2, 100),
                                .restless = 2000,
                                .period = period,
                                .rounding = rounding,
                                .tolerance = tolerance};
    check(random.coin() ? test::run<64>(machine, blocks, random, how)
                        : test::run<16>(machine, blocks, random, how),
          relative);
  }
}

// A whole program, held at a tick and resumed at the 200th.
template <std::size_t capacity, class B>
test::ExecutorFaults held_at(int hold, const std::vector<B>& blocks, double tolerance) {
  using Runner = Executor<Machine<3>, capacity, B>;
  const auto& machine = test::slow_axes<double>;
  const test::Disturbance how{.restless = 1, .period = period, .tolerance = tolerance};
  const auto executor = std::make_unique<Runner>(machine, typename Runner::Options{.tolerance = tolerance});
  for (const B& block : blocks) REQUIRE(executor->push(block));
  executor->end_of_program();
  test::TickCheck<Machine<3>, typename Runner::SetPoint, B> ticks(machine, blocks, how);
  for (int tick = 0; tick < 1000 && !executor->finished(); ++tick) {
    if (tick == hold) executor->feed_hold();
    if (tick == 200) executor->resume();
    ticks.take(executor->tick(period));
  }
  ticks.finish();
  ticks.faults.finished = executor->finished();
  return ticks.faults;
}

}  // namespace

TEST_CASE("within a tolerance no request makes three axes jump at a joint", "[executor]") {
  disturb(test::slow_axes<double>, "", 30);
}
TEST_CASE("within a tolerance no request makes six axes jump at a joint", "[executor]") {
  disturb(test::six_axes, "ACU", 8);
}
TEST_CASE("within a tolerance no request makes axes jump at a joint in float", "[executor]") {
  disturb(test::slow_axes<float>, "", 120, 1e-3, 4e-5);
}
TEST_CASE("a hold goes on over a cell that is as short as rounding", "[executor]") {
  const auto blocks = test::blocks_of({"F1095", "G2 X0.004397 Y-0.019868 I-0.408014 J-0.100729",
                                       "G3 X0.043641 Y-0.099759 I0.245737 J0.071124", "M30"},
                                      test::slow_axes<double>);
  for (int hold = 1; hold < 150; ++hold) {
    CAPTURE(hold);
    check(held_at<64>(hold, blocks, 0.060940454288297315), 1e-9);
  }
}
TEST_CASE("all cells of a block are run where the one before it ends in one as short as rounding",
          "[executor]") {
  const auto blocks =
      test::blocks_of({"F275", "G2 X0.015095 Y0.001787 I0.034443 J-0.226272", "G1 X0.024440 Y0.007884",
                       "G2 X0.000539 Y0.027798 I1.267505 J1.545564", "T2 M6", "M30"},
                      test::slow_axes<double>);
  check(held_at<16>(-1, blocks, 0.023955603681622046), 1e-9);
}
TEST_CASE("blocks that wait for others go on when the machine has rested for long enough", "[executor]") {
  const auto blocks = test::blocks_of({"F1200", "G1 X5", "Y5", "X10"}, test::slow_axes<double>);
  const auto executor = std::make_unique<Executor<Machine<3>, 64>>(
      test::slow_axes<double>, Executor<Machine<3>, 64>::Options{.longest_wait = 0.1});
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
  const auto blocks = test::blocks_of(lines, test::slow_axes<double>);
  using Runner = Executor<Machine<3>, 64>;
  const auto executor = std::make_unique<Runner>(test::slow_axes<double>, Runner::Options{.tolerance = 0.05});
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
      const auto& axis = test::slow_axes<double>.axes[static_cast<std::size_t>(i)];
      CHECK(std::abs(point.position[i] - before.position[i]) <= axis.velocity * period * (1 + 1e-9));
      CHECK(std::abs(point.velocity[i] - before.velocity[i]) <= axis.acceleration * period * (1 + 1e-6));
      CHECK(std::abs(point.acceleration[i] - before.acceleration[i]) <= axis.jerk * period * (1 + 1e-6));
    }
    before = point;
  }
  CHECK_FALSE(executor->error());
  CHECK(point.position == Vector3(0, 20, 0));
}

TEST_CASE("held at a new beginning, the axes wait for resume, jogged or not", "[executor]") {
  const auto blocks = test::blocks_of({"F1200", "G1 X10", "Y10"}, test::slow_axes<double>);
  using Runner = Executor<Machine<3>, 64>;
  const bool jogs = GENERATE(false, true);
  const auto executor = std::make_unique<Runner>(test::slow_axes<double>, Runner::Options{.tolerance = 0.05});
  executor->feed_hold();
  const Vector3 beside(5, 0.03, 0);
  REQUIRE(executor->restart(2, beside));
  for (const auto& block : blocks) REQUIRE(executor->push(block));
  executor->end_of_program();
  SetPoint<3> point;
  const auto wait = [&] {
    for (int tick = 0; tick < 1500; ++tick) point = executor->tick(period);
  };
  wait();
  CHECK(point.position == beside);
  if (jogs) {
    REQUIRE(executor->jog_to({5, 3, 2}));
    wait();
    CHECK(point.position == Vector3(5, 3, 2));
  }
  executor->resume();
  while (!executor->finished()) point = executor->tick(period);
  CHECK_FALSE(executor->error());
  CHECK(point.position == Vector3(10, 10, 0));
}

TEST_CASE("a new beginning with words alone tells them and is over", "[executor]") {
  using Runner = Executor<Machine<3>, 64>;
  const auto executor = std::make_unique<Runner>(test::slow_axes<double>);
  REQUIRE(executor->restart(0, {0, 0, 0}));
  for (const auto& block : test::blocks_of({"M8"}, test::slow_axes<double>)) REQUIRE(executor->push(block));
  executor->end_of_program();
  CHECK(executor->tick(period).words.size() == 1);
  CHECK(executor->finished());
}
