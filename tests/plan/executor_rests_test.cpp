// Rests that last until somebody asks for something else, at every level: what they are called, and what goes
// on from them.
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "cncplan/executor_levels.hpp"
#include "support/catch.hpp"
#include "support/executor_check.hpp"

using namespace cncplan;

namespace {

using Runner = Executor<Machine<3>, 64>;

constexpr double period = 1e-3;  // s

const std::vector<SmoothLevel> levels{SmoothLevel::exact, SmoothLevel::fast, SmoothLevel::good,
                                      SmoothLevel::best};

// Of X, Y and Z without limits of their own.
const Machine<3> bare{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};

template <class E>
void load(E& executor, const std::vector<std::string>& lines, const Machine<3>& machine) {
  for (const auto& block : test::blocks_of(lines, machine)) REQUIRE(executor.push(block));
  executor.end_of_program();
}
template <class E>
SetPoint<3> run(E& executor, double seconds) {
  SetPoint<3> now;
  for (int tick = 0; tick < seconds / period; ++tick) now = executor.tick(period);
  return now;
}

}  // namespace

TEST_CASE("a machine whose tool alone has limits goes to its path, and is jogged, within them",
          "[executor]") {
  for (const SmoothLevel level : levels) {
    CAPTURE(to_text(level));
    Runner executor(bare, LevelExecutorOptions{.level = level});
    const bool exact = level == SmoothLevel::exact;  // begins on the path only
    REQUIRE(executor.restart(0, {0, exact ? 0 : 0.015, 0}));
    load(executor, {"F1200", "G1 X9", "Y9"}, bare);
    CHECK(run(executor, 5).position.isApprox(Vector3(9, 9, 0)));
    CHECK(executor.state() == ExecutorState::finished);
    REQUIRE(executor.jog_to({30, 40, 50}));
    double velocity = 0, acceleration = 0, jerk = 0;
    for (int tick = 0; tick < 5000; ++tick) {
      const auto now = executor.tick(period);
      velocity = std::max(velocity, now.velocity.norm());
      acceleration = std::max(acceleration, now.acceleration.norm());
      jerk = std::max(jerk, now.jerk.norm());
    }
    CHECK(executor.tick(period).position.isApprox(Vector3(30, 40, 50)));
    CHECK((velocity <= 30 * (1 + 1e-9) && velocity > 20));
    CHECK((acceleration <= 1000 * (1 + 1e-9) && jerk <= 10000 * (1 + 1e-9)));
  }
}

TEST_CASE("a rapid or a feed move of no speed is held, can be jogged, and goes on", "[executor]") {
  for (const SmoothLevel level : levels)
    for (const bool rapid : {true, false}) {
      CAPTURE(to_text(level), rapid);
      Runner executor(bare, LevelExecutorOptions{.level = level});
      load(executor, {"F1200", "G1 X20", "G0 Y20", "G1 X0"}, bare);
      run(executor, 0.2);
      const auto ask = [&](double share) {
        rapid ? executor.rapid_override(share) : executor.feed_override(share);
      };
      ask(0);
      const auto rest = run(executor, 4);
      CHECK(rest.velocity.isZero());
      CHECK(executor.state() == ExecutorState::held);
      CHECK(executor.rested() > 2.5);
      CHECK(executor.jog_by({0, 0, 5}));
      run(executor, 2);
      CHECK(executor.state() == ExecutorState::away);
      ask(1);
      executor.resume();
      CHECK(run(executor, 6).position.isApprox(Vector3(0, 20, 0)));
      CHECK(executor.state() == ExecutorState::finished);
    }
}

TEST_CASE("a program that ran back to its start is held there, and goes on forwards", "[executor]") {
  for (const SmoothLevel level : levels) {
    CAPTURE(to_text(level));
    Runner executor(bare, LevelExecutorOptions{.level = level});
    load(executor, {"F1200", "G1 X20", "Y20", "X0"}, bare);
    run(executor, 0.7);
    executor.reverse(true);
    const auto back = run(executor, 6);
    CHECK(back.position.norm() < 1e-6);
    CHECK(executor.state() == ExecutorState::held);
    CHECK(executor.rested() > 4);
    CHECK(executor.jog_by({0, 0, 5}));
    run(executor, 2);
    executor.reverse(false);
    executor.resume();
    CHECK(run(executor, 8).position.isApprox(Vector3(0, 20, 0)));
    CHECK(executor.state() == ExecutorState::finished);
  }
}

TEST_CASE("axes are jogged wherever the program rests as asked, however much of it is to come",
          "[executor]") {
  std::vector<std::string> lines{"F1200"};
  const bool dwells = GENERATE(false, true);
  if (dwells) lines.emplace_back("G4 P0.2");
  for (int i = 1; i <= 50; ++i) lines.push_back("G1 X" + std::to_string(i) + " Y" + std::to_string(i % 2));
  for (const SmoothLevel level : levels) {
    for (const int how : {0, 1, 2}) {
      CAPTURE(to_text(level), how, dwells);
      Executor<Machine<3>, 32> executor(bare, LevelExecutorOptions{.tolerance = 0.05, .level = level});
      load(executor, lines, bare);
      if (how > 0) run(executor, 0.5);
      how == 2 ? executor.reverse(true) : executor.feed_override(0);
      const auto rest = run(executor, 3);
      REQUIRE(executor.rests());
      CHECK(executor.state() == ExecutorState::held);
      REQUIRE(executor.jog_by({0, 0, 5}));
      CHECK(run(executor, 2).position.isApprox(rest.position + Vector3(0, 0, 5)));
      how == 2 ? executor.reverse(false) : executor.feed_override(1);
      executor.resume();
      CHECK(run(executor, 20).position.isApprox(Vector3(50, 0, 0)));
      CHECK(executor.state() == ExecutorState::finished);
    }
  }
}

TEST_CASE("rested counts from when the motion came to rest, at every level", "[executor]") {
  for (const SmoothLevel level : levels) {
    CAPTURE(to_text(level));
    Runner executor(bare, LevelExecutorOptions{.level = level});
    load(executor, {"F1200", "G1 X20"}, bare);
    run(executor, 0.5);
    CHECK(executor.rested() == 0);
    executor.feed_hold();
    double rest = 0;
    for (int tick = 0; tick < 1000; ++tick)
      if (executor.tick(period).velocity.isZero()) rest += period;
    CHECK(executor.rested() == Approx(rest).margin(2 * period));
    CHECK(rest > 0.8);
    executor.resume();
    run(executor, 0.2);
    CHECK(executor.rested() == 0);
    run(executor, 3);
    executor.stop();
    const double before = executor.rested();
    run(executor, 0.5);
    CHECK(executor.rested() == Approx(before + 0.5).margin(2 * period));
  }
}

TEST_CASE("an override that is taken back leaves the programmed feed, whatever limits kept it at",
          "[executor]") {
  Machine<3> machine = bare;
  for (auto& axis : machine.axes) axis.velocity = 25;
  for (const SmoothLevel level : levels) {
    CAPTURE(to_text(level));
    Runner executor(machine, LevelExecutorOptions{.level = level});
    executor.feed_override(2);  // all is planned for it
    load(executor, {"F1200", "G1 X50", "X-50", "X50", "X-50", "X50", "F600", "X-50"}, machine);
    CHECK(run(executor, 6).along.velocity == Approx(25));
    executor.feed_override(1);
    CHECK(run(executor, 1).along.velocity == Approx(20));
    executor.feed_override(0.5);
    CHECK(run(executor, 1).along.velocity == Approx(10));
    executor.feed_override(1.1);
    CHECK(run(executor, 1).along.velocity == Approx(22));
    executor.feed_override(1);
    double fastest = 0;
    SetPoint<3> now;
    while (!executor.finished()) {
      now = executor.tick(period);
      if (now.line == 8 && std::abs(now.position.x()) < 20) fastest = std::max(fastest, now.along.velocity);
    }
    CHECK(fastest == Approx(10));
    CHECK(now.position.isApprox(Vector3(-50, 0, 0)));
  }
}

TEST_CASE("an executor refuses a wait that is none", "[executor]") {
  for (const double wait : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    Runner executor(bare, LevelExecutorOptions{.longest_wait = wait});
    REQUIRE(executor.error());
    CHECK(executor.error()->about.error.field == "longest wait");
  }
}

TEST_CASE("an executor begins anew while it dwells", "[executor]") {
  for (const SmoothLevel level : levels) {
    CAPTURE(to_text(level));
    Runner executor(bare, LevelExecutorOptions{.level = level});
    load(executor, {"F1200", "G1 X5", "G4 P3", "X9"}, bare);
    run(executor, 1.5);
    REQUIRE(executor.state() == ExecutorState::dwelling);
    REQUIRE(executor.restart(0, {5, 0, 0}));
    load(executor, {"F1200", "G1 X9"}, bare);
    CHECK(run(executor, 3).position.isApprox(Vector3(9, 0, 0)));
    CHECK(executor.state() == ExecutorState::finished);
  }
}
