// What is no time and what is no machine: told, and the axes keep their limits.
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "cncplan/block_reader.hpp"
#include "cncplan/executor.hpp"
#include "cncplan/live_steps.hpp"
#include "cncplan/plan_program.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

using Mill = Executor<Machine<3>, 16>;
constexpr double period = 1e-3;

Machine<3> mill() {
  Machine<3> machine{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  for (auto& axis : machine.axes) axis.velocity = 40, axis.acceleration = 1000, axis.jerk = 10000;
  return machine;
}
const std::vector<double> no_times{std::nan(""), -1.0, -1e-9, std::numeric_limits<double>::infinity(),
                                   -std::numeric_limits<double>::infinity()};

Block<3> line(const Vector3& from, const Vector3& to) {
  return {.path = path::Line<3>(from, to), .feed = 30, .line = 1};
}
std::unique_ptr<Mill> running(Mill::Options options = {}) {
  auto executor = std::make_unique<Mill>(mill(), options);
  CHECK(executor->push(line({0, 0, 0}, {10, 0, 0})));
  CHECK(executor->push(line({10, 0, 0}, {10, 10, 0})));
  executor->end_of_program();
  return executor;
}

// Ticks of which the first is no time, or all are: until it is over.
template <class E>
typename Mill::SetPoint end(E& executor, typename Mill::SetPoint before, double bad, bool again) {
  int ticks = 0;
  do {
    const auto now = executor.tick(ticks == 0 || again ? bad : period);
    CHECK(std::isfinite(now.time));
    CHECK(now.position.allFinite());
    CHECK((now.position - before.position).norm() <= 40 * period * std::sqrt(3.0));
    CHECK((now.velocity - before.velocity).norm() <= 1000 * period * std::sqrt(3.0));
    CHECK((now.acceleration - before.acceleration).cwiseAbs().maxCoeff() <= 10000 * period * (1 + 1e-6));
    before = now;
  } while (!executor.finished() && ++ticks < 1000);
  CHECK(executor.finished());
  CHECK(before.velocity.isZero());
  CHECK(before.acceleration.isZero());
  return before;
}

void check_error(const Mill& executor, double bad) {
  REQUIRE(executor.error());
  CHECK(executor.error()->error().code == (std::isfinite(bad) ? ErrorCode::negative : ErrorCode::not_finite));
  CHECK(executor.error()->error().field == "period");
}

}  // namespace

TEST_CASE("a tick that is no time ends the run, and the axes come to rest within their limits",
          "[executor]") {
  for (const double bad : no_times)
    for (const bool again : {false, true})
      for (const int at : {0, 50, 200, 345, 700}) {
        CAPTURE(bad, again, at);
        const auto executor = running();
        Mill::SetPoint before{};
        for (int i = 0; i < at; ++i) before = executor->tick(period);
        CHECK_FALSE(executor->error());
        end(*executor, before, bad, again);
        check_error(*executor, bad);
        CHECK(std::isfinite(executor->time()));
        for (int i = 0; i < 100; ++i) CHECK(executor->push(line({0, 0, 0}, {1, 0, 0})));  // dropped
        executor->resume();
        CHECK(executor->tick(period).velocity.isZero());
        CHECK(executor->finished());

        // begun anew, nothing of it is left
        CHECK(executor->restart(0, {0, 0, 0}));
        CHECK_FALSE(executor->error());
        CHECK(executor->push(line({0, 0, 0}, {1, 0, 0})));
        executor->end_of_program();
        int ticks = 0;
        while (!executor->finished() && ++ticks < 1000) executor->tick(period);
        CHECK(executor->tick(period).position.isApprox(Vector3{1, 0, 0}));
        CHECK_FALSE(executor->error());
      }
}

TEST_CASE("a tick that is no time ends a jog, on its way and on its way back", "[executor]") {
  for (const double bad : no_times)
    for (const bool back : {false, true}) {
      CAPTURE(bad, back);
      Mill executor(mill());
      CHECK(executor.push(line({0, 0, 0}, {10, 0, 0})));
      executor.end_of_program();
      Mill::SetPoint before{};
      for (int i = 0; i < 200; ++i) before = executor.tick(period);
      executor.feed_hold();
      for (int i = 0; i < 300; ++i) before = executor.tick(period);
      REQUIRE(executor.jog({10, 20, 0}));
      for (int i = 0; i < 200; ++i) before = executor.tick(period);
      if (back) {
        executor.resume();
        for (int i = 0; i < 100; ++i) before = executor.tick(period);
      }
      CHECK_FALSE(before.velocity.isZero());
      end(executor, before, bad, false);
      check_error(executor, bad);
    }
}

TEST_CASE("steps of a tick that is no time are those of the axes", "[executor]") {
  auto machine = mill();
  machine.axes[0].motors = {{.steps_per_unit = 1000}};
  Mill executor(machine);
  CHECK(executor.push(line({0, 0, 0}, {10, 0, 0})));
  executor.end_of_program();
  LiveSteps steps(executor);
  Mill::SetPoint last{};
  for (int i = 0; !executor.finished() && i < 1000; ++i) {
    last = steps.tick(i == 150 ? std::nan("") : period);
    while (const auto edge = steps.next()) CHECK(std::isfinite(edge->time));
  }
  CHECK(std::abs(static_cast<double>(steps.count(0)) - 1000 * last.position.x()) <= 1);
}

TEST_CASE("a tick of no time is none, and no error", "[executor]") {
  const auto executor = running();
  for (int i = 0; i < 100; ++i) {
    const auto point = executor->tick(period);
    CHECK(executor->tick(0).position == point.position);
  }
  CHECK_FALSE(executor->error());
  CHECK(executor->time() == Approx(0.1));
}

TEST_CASE("a machine that is none is refused by all that take one", "[executor]") {
  const auto good = mill();
  std::vector<Machine<3>> machines;
  for (double Limits::*limit : {&Limits::velocity, &Limits::acceleration, &Limits::jerk})
    for (const double value : {-1.0, 0.0, std::nan("")}) {
      machines.push_back(good);
      machines.back().limits.*limit = value;
    }
  for (double Axis::*limit : {&Axis::velocity, &Axis::acceleration, &Axis::jerk, &Axis::velocity_down}) {
    machines.push_back(good);
    machines.back().axes[1].*limit = -1;
  }
  for (std::size_t i = 0; i < machines.size(); ++i) {
    const auto& machine = machines[i];
    CAPTURE(i);
    BlockReader reader(machine);
    CHECK_FALSE(reader.read_line("G1 X1 F600"));
    CHECK_FALSE(plan_text("G1 X1 F600\n", machine, {.tolerance = 0}));
    CHECK_FALSE(plan_blocks(std::vector{line({0, 0, 0}, {1, 0, 0})}, machine, {.tolerance = 0}));
    CHECK(read_text("G1 X1 F600\n", machine).failed());
    Mill executor(machine);
    CHECK(executor.error());
    CHECK(executor.push(line({0, 0, 0}, {1, 0, 0})));
    CHECK(executor.tick(period).velocity.isZero());
    CHECK(executor.finished());
    CHECK_FALSE(executor.jog({1, 0, 0}));
    CHECK_FALSE(executor.jog_to({1, 0, 0}));
    CHECK(executor.restart(0, {0, 0, 0}));
    CHECK(executor.error());
  }
}
