// Homing and limit switches on a simulated machine that does not know where it stands.
#include "cncplan/homing.hpp"

#include <array>
#include <cmath>
#include <cstdint>

#include "cncplan/executor.hpp"
#include "cncplan/live_steps.hpp"
#include "cncplan/step/backend.hpp"
#include "cncplan/step/switch.hpp"
#include "support/catch.hpp"
#include "support/executor_check.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

constexpr double period = 1e-3, scale = 400, acceleration = 800, jerk = 9000;

constexpr Machine<2> slides() {
  Machine<2> machine{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  for (Axis& axis : machine.axes) {
    axis.velocity = 40;
    axis.acceleration = acceleration;
    axis.jerk = jerk;
    axis.motors = {{.steps_per_unit = scale}};
  }
  return machine;
}

// Two slides, each with a switch that is told of every step.
struct Plant {
  step::SimulatedBackend<double, 2> backend;
  std::array<step::SwitchInput, 2> switches;

  Plant(const std::array<std::int64_t, 2>& counts, const std::array<step::Switch, 2>& contacts)
      : backend({scale, scale}, counts),
        switches{step::SwitchInput(contacts[0], static_cast<double>(counts[0]) / scale),
                 step::SwitchInput(contacts[1], static_cast<double>(counts[1]) / scale)} {}

  template <class Steps>
  void take(Steps& steps) {
    while (const auto edge = steps.next()) {
      REQUIRE(backend.accept({edge->time, edge->axis, edge->direction}));
      switches[static_cast<std::size_t>(edge->axis)].follow(backend.position()(edge->axis), edge->time);
    }
  }
};

// Both axes by their cycles, at most so many seconds; the last set point.
SetPoint<2> home(Plant& plant, std::array<HomingCycle, 2>& cycles, double seconds) {
  Executor<Machine<2>, 4> executor(slides());
  LiveSteps steps(executor);
  auto point = executor.tick(period);
  VectorN<double, 2> wanted(0, 0), before = point.acceleration;
  for (int tick = 0; tick < seconds / period; ++tick) {
    VectorN<double, 2> next;
    for (int axis = 0; axis < 2; ++axis) {
      const auto i = static_cast<std::size_t>(axis);
      next[axis] = cycles[i].update(plant.switches[i].level(executor.time()), point.position[axis],
                                    point.velocity[axis], period);
    }
    if (cycles[0].finished() && cycles[1].finished() && point.velocity.isZero()) break;
    if (next != wanted) REQUIRE(executor.jog(wanted = next));
    point = steps.tick(period);
    plant.take(steps);
    CHECK(point.acceleration.cwiseAbs().maxCoeff() <= acceleration * (1 + 1e-9));
    CHECK((point.acceleration - before).cwiseAbs().maxCoeff() <= jerk * period * (1 + 1e-6));
    before = point.acceleration;
  }
  return point;
}

}  // namespace

TEST_CASE("axes find their switches wherever they stand, bounce or not", "[homing]") {
  test::Random random;
  for (int run = 0; run < 20; ++run) {
    const double bounce = random.uniform(0, 0.008), latch = random.uniform(0.5, 4);
    std::array<step::Switch, 2> contacts;
    std::array<std::int64_t, 2> counts{};
    std::array<Homing, 2> homings;
    for (std::size_t i = 0; i < 2; ++i) {
      const int direction = random.coin() ? 1 : -1;
      contacts[i] = {.position = random.uniform(-3, 3),
                     .direction = direction,
                     .differential = 0.1,
                     .bounce_time = bounce};
      counts[i] = random.integer(-20000, 20000);  // on either side of the switch
      homings[i] = {.direction = direction,
                    .search_speed = random.uniform(5, 30),
                    .latch_speed = latch,
                    .settle_time = 0.01,
                    .travel = 120,
                    .position = contacts[i].position};
    }
    CAPTURE(test::seed(), run, bounce, latch, counts[0], counts[1]);
    Plant plant(counts, contacts);
    std::array cycles{HomingCycle(homings[0]), HomingCycle(homings[1])};
    const auto point = home(plant, cycles, 300);
    for (int axis = 0; axis < 2; ++axis) {
      const HomingCycle& cycle = cycles[static_cast<std::size_t>(axis)];
      REQUIRE(cycle.stage() == HomingStage::done);
      // half a tick, and the bounce, in which a tick may find it open; a step that it closes behind, half a
      // step that the axis is off
      CHECK(std::abs(point.position[axis] + cycle.correction() - plant.backend.position()[axis]) <=
            latch * (period / 2 + bounce) + 1.6 / scale);
    }
  }
}

TEST_CASE("a switch that is not there, and one that never opens, are told", "[homing]") {
  const Homing homing{.search_speed = 30, .latch_speed = 1, .settle_time = 0.01, .travel = 20};
  Plant plant({0, 0}, {step::Switch{.position = -1e9, .direction = -1}, {.position = 1e9, .direction = -1}});
  std::array cycles{HomingCycle(homing), HomingCycle(homing)};
  const auto point = home(plant, cycles, 300);
  CHECK(cycles[0].stage() == HomingStage::not_found);
  CHECK(cycles[1].stage() == HomingStage::not_found);
  CHECK(point.velocity.isZero());
  // 20 mm, and the way to rest from 30 mm/s
  CHECK(point.position[0] == Approx(-21.7).margin(0.2));
  CHECK(point.position[1] == Approx(21.7).margin(0.2));
}

TEST_CASE("a switch beyond the end of the axis' travel is not found", "[homing]") {
  Machine<2> machine = slides();
  machine.axes[0].low = -20;
  Executor<Machine<2>, 4> executor(machine);
  HomingCycle cycle({.direction = -1, .search_speed = 10, .latch_speed = 1, .travel = 200});
  auto point = executor.tick(period);
  double wanted = 0;
  for (int tick = 0; tick < 5000 && !cycle.finished(); ++tick) {
    const double next = cycle.update(false, point.position[0], point.velocity[0], period);
    if (next != wanted) REQUIRE(executor.jog({wanted = next, 0}));
    point = executor.tick(period);
  }
  CHECK(cycle.stage() == HomingStage::not_found);
  CHECK(point.position[0] == Approx(-20));
}

TEST_CASE("at a limit switch a program stops within the limits, and the position is kept", "[homing]") {
  Plant plant({0, 0}, {step::Switch{.position = 12.3, .bounce_time = 0.003}, {.position = 1e9}});
  const Machine<2> machine = slides();
  Executor<Machine<2>, 16> executor(machine);
  for (const auto& block : test::blocks_of({"G1 X10 F1800", "G3 X15 Y5 R5", "G1 Y40"}, machine))
    REQUIRE(executor.push(block));
  executor.end_of_program();
  LiveSteps steps(executor);
  double tripped = -1, braked = 0;
  SetPoint<2> point;
  for (int tick = 0; tick < 5000 && !executor.finished(); ++tick) {
    if (tripped < 0 && plant.switches[0].level(executor.time())) {
      tripped = executor.time();
      CHECK(point.position[0] == Approx(12.3).margin(0.04));  // a tick at 30 mm/s
      CHECK(point.along.velocity > 20);
      executor.stop();
    }
    point = steps.tick(period);
    plant.take(steps);
    CHECK(point.acceleration.norm() <= 1000 * (1 + 1e-9));
    if (!point.velocity.isZero()) braked = executor.time();
  }
  REQUIRE(tripped > 0);
  CHECK(executor.finished());
  CHECK(braked - tripped < 0.25);  // 2 sqrt(V/J) = 0.11 s on a line; the bend takes its share
  CHECK((point.position - plant.backend.position()).cwiseAbs().maxCoeff() * scale <= 0.5 + 1e-3);
  REQUIRE(executor.jog_to({5, 0}));
  for (int tick = 0; tick < 5000; ++tick) {
    point = steps.tick(period);
    plant.take(steps);
    if (point.velocity.isZero()) break;
  }
  CHECK((point.position - VectorN<double, 2>(5, 0)).norm() < 1e-12);
  CHECK((point.position - plant.backend.position()).cwiseAbs().maxCoeff() * scale <= 0.5 + 1e-3);
  CHECK_FALSE(plant.switches[0].level(executor.time()));
}
