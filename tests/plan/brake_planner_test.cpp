// Holds that come within the bound which was planned, at any instant.
#include "cncplan/detail/executor/brake_planner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <string>
#include <vector>

#include "cncplan/executor_levels.hpp"
#include "cncplan/plan_program.hpp"
#include "cncplan/trajectory_executor.hpp"
#include "least_brake.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace cncplan::test;

namespace {

constexpr double period = 1e-3;
const Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};

std::string wave(int lines) {
  std::string text = "F1800\n";
  for (int i = 1; i <= lines; ++i)
    text += "G1 X" + std::to_string(0.25 * i) + " Y" + std::to_string(3 * std::sin(0.17 * i)) + " Z" +
            std::to_string(std::sin(0.4 * i)) + "\n";
  return text;
}
std::string circles(int turns) {
  std::string text = "F1800\nG1 X0.5\n";
  for (int i = 0; i < turns; ++i) text += "G2 X0.5 Y0 I1 J0\n";
  return text + "G1 X5\n";
}
const std::string zigzag = "F1800\nG1 X2 Y0.3\nX0 Y0.6\nX2 Y0.9\nX0 Y1.2\nG3 X3 Y4.2 I3 J0\nG1 Y4.9\nX5\n";

auto planned(const std::string& text, const PlanOptions& options) {
  const auto program = read_text(text, mill);
  REQUIRE_FALSE(program.failed());
  auto trajectory = plan_blocks(program.blocks(), mill, options);
  REQUIRE(trajectory);
  return *std::move(trajectory);
}

// The longest of the least brakes in some time from an instant on; one from the feed is among them.
template <class T>
double least_from(const T& trajectory, double from, double time) {
  double most = least_time(30, 0, 1000, 10000);
  for (double t = from; t < from + time; t += period / 2) {
    const auto point = trajectory.at(t);
    const double v = point.along.velocity;
    if (v > 0) most = std::max(most, least_time(v, point.along.acceleration, 1000, 10000));
  }
  return most;
}

}  // namespace

TEST_CASE("brakes: a hold at any instant of a plan is at rest within its bound", "[brakes]") {
  for (const std::string& text : {wave(40), circles(2), zigzag})
    for (const auto level : {SmoothLevel::good, SmoothLevel::best})
      for (const double factor : {1.5, 2.0}) {
        CAPTURE(text.substr(0, 20), level, factor);
        const auto trajectory = planned(text, {.level = level, .hold_factor = factor});
        CHECK(trajectory.fallbacks().empty());
        CHECK(trajectory.longest_hold() > 0);
        Random random;
        for (int i = 0; i < 12; ++i) {
          TrajectoryExecutor executor(trajectory, mill, {.hold_factor = factor});
          REQUIRE_FALSE(executor.error());
          const double at = random.uniform(0.01, trajectory.duration());
          while (executor.clock().position < at) executor.tick(period);
          const double now = executor.clock().position;
          executor.feed_hold();
          double held = 0;
          for (; !executor.rests() && held < 1; held += period) executor.tick(period);
          CAPTURE(at, held);
          CHECK(held <= *executor.worst_hold() + 2 * period);
          CHECK(held <= factor * least_from(trajectory, now, 0.4) + 2 * period);
        }
      }
}

TEST_CASE("brakes: under an override the bound is so many times longer", "[brakes]") {
  for (const double share : {0.995, 0.9, 0.3}) {
    const auto trajectory =
        planned(circles(2), {.level = SmoothLevel::best, .reserve = 0, .hold_factor = 1.5});
    Random random;
    for (int i = 0; i < 12; ++i) {
      TrajectoryExecutor executor(trajectory, mill, {.hold_factor = 1.5});
      executor.feed_override(share);
      const double at = random.uniform(0.3, trajectory.duration() - 0.5);
      while (executor.clock().position < at || executor.clock().acceleration != 0) executor.tick(period);
      CAPTURE(share, at);
      if (executor.clock().velocity != Approx(share)) continue;  // it has not come to it yet
      executor.feed_hold();
      double held = 0;
      std::array<Vector3, 4> p;
      p.fill(executor.tick(0).position);
      double jerk = 0;
      for (int tick = 0; !executor.rests() && held < 3; held += period, ++tick) {
        p = {executor.tick(period).position, p[0], p[1], p[2]};
        if (tick >= 3) jerk = std::max(jerk, (p[0] - 3 * p[1] + 3 * p[2] - p[3]).norm());
      }
      CAPTURE(held);
      CHECK(held <= *executor.worst_hold() / share + 2 * period);
      CHECK(jerk <= 10000 * period * period * period * (1 + 1e-3));
    }
  }
}

TEST_CASE("brakes: one that is planned begins within a tick, however long that is", "[brakes]") {
  // With a small reserve many instants have no brake of their own.
  const auto trajectory = planned(wave(40), {.level = SmoothLevel::best, .reserve = 0.02});
  const double longest = 0.8, tick = 0.25;
  Random random;
  for (int i = 0; i < 60; ++i) {
    TrajectoryExecutor executor(trajectory, mill, {.longest_hold = longest});
    REQUIRE_FALSE(executor.error());
    const double at = random.uniform(0.1, trajectory.duration() - 0.6);
    while (executor.clock().position < at) executor.tick(period);
    executor.feed_hold();
    executor.tick(tick);
    int ticks = 1;
    for (; !executor.rests() && ticks < 100; ++ticks) executor.tick(tick);
    CAPTURE(at, ticks);
    CHECK((ticks - 1) * tick < *executor.worst_hold());
  }
}

TEST_CASE("brakes: of machines that take longer to brake, and less long", "[brakes]") {
  for (const Limits& limits :
       {Limits{100, 2000, 40000}, Limits{50, 100, 500}, Limits{80, 500, 1e6}, Limits{300, 1000, 5000}}) {
    const Machine<3> machine{.limits = limits};
    CAPTURE(limits.velocity, limits.acceleration, limits.jerk);
    const auto program = read_text("F20000\nG1 X60 Y5\nG2 X100 Y45 R40\nG1 X20 Y60\nX300 Y90\n", machine);
    REQUIRE_FALSE(program.failed());
    const auto trajectory =
        plan_blocks(program.blocks(), machine, {.level = SmoothLevel::good, .hold_factor = 1.5});
    REQUIRE(trajectory);
    TrajectoryExecutor executor(*trajectory, machine, {.longest_hold = 10, .hold_factor = 1.5});
    CHECK_FALSE(executor.error());
    CHECK(trajectory->duration() <
          1.05 * plan_blocks(program.blocks(), machine, {.level = SmoothLevel::good})->duration());
  }
}

TEST_CASE("brakes: where only axes have limits, and where nothing limits the jerk", "[brakes]") {
  Machine<3> axes_only;
  for (auto& axis : axes_only.axes) axis.velocity = 50, axis.acceleration = 800, axis.jerk = 8000;
  const Machine<3> no_jerk{.limits = {.velocity = 30, .acceleration = 1000}};
  for (const Machine<3>& machine : {axes_only, no_jerk})
    for (const auto level : {SmoothLevel::exact, SmoothLevel::fast, SmoothLevel::good, SmoothLevel::best}) {
      CAPTURE(machine.limits.velocity, level);
      const auto program =
          read_text("G0 X20 Y5\nG1 F1800 X40\nY20\nG3 X60 Y40 R20\nG0 X0 Y0\nG1 X-30\n", machine);
      REQUIRE_FALSE(program.failed());
      const auto trajectory = plan_blocks(program.blocks(), machine, {.level = level, .hold_factor = 1.5});
      REQUIRE(trajectory);
      TrajectoryExecutor executor(*trajectory, machine, {.longest_hold = 10});
      REQUIRE_FALSE(executor.error());
      while (executor.clock().position < trajectory->duration() - 0.3) executor.tick(period);
      executor.feed_hold();  // on a line
      const double speed = executor.tick(0).velocity.norm();
      double held = 0;
      for (; !executor.rests() && held < 1; held += period) executor.tick(period);
      const double least = machine.limits.velocity < 100 ? speed / 1000 : 2 * std::sqrt(speed / 8000);
      CHECK(held <= 1.05 * least + 2 * period);
    }
}

TEST_CASE("brakes: on a measured curve they are planned in a bounded time", "[brakes]") {
  const std::clock_t begin = std::clock();
  const auto trajectory = planned("G17\nG1 X5 F1200\nG5 X15 Y5 I3 J0 P-3 Q0\nG1 X25\n",
                                  {.level = SmoothLevel::good, .hold_factor = 1.5});
  CHECK(trajectory.longest_hold() < 1);
  CHECK((std::clock() - begin) / CLOCKS_PER_SEC < 12);  // 24 s once, 0.2 s now
}

TEST_CASE("brakes: each tells where it comes to rest, in every run of a program", "[brakes]") {
  const auto trajectory = planned("F1800\nG1 X20 Y1\nX40 Y0\nG4 P0.2\nG1 X20 Y10\nX0 Y9\nM0\nG1 X5\nX20 Y3\n",
                                  {.level = SmoothLevel::good, .hold_factor = 1.5});
  int between_rests = 0;
  for (const auto& brake : trajectory.brakes()) {
    CAPTURE(brake.time, brake.duration, brake.end);
    CHECK(brake.end >= brake.time + 0.2 * brake.duration);  // the rate falls from 1 to 0
    CHECK(brake.end <= brake.time + brake.duration);
    if (brake.duration > 0) ++between_rests;
  }
  CHECK(between_rests > 20);
  CHECK(trajectory.brakes().back().end == Approx(trajectory.duration()));
}

TEST_CASE("brakes: a bound costs time, and one that a plan cannot keep is refused", "[brakes]") {
  const std::string text = circles(3);
  const auto fastest = planned(text, {.level = SmoothLevel::best});
  CHECK(fastest.brakes().empty());
  CHECK(fastest.longest_hold() == 0);
  TrajectoryExecutor refused(fastest, mill, {.longest_hold = 100, .hold_factor = 1.5});
  REQUIRE(refused.error());
  CHECK(refused.error()->error().code == ErrorCode::above_limit);
  CHECK(refused.error()->error().bound == 1.5);
  CHECK(refused.error()->error().value > 1.5);
  double before = fastest.duration();
  for (const double factor : {2.0, 1.5, 1.2}) {
    const auto trajectory = planned(text, {.level = SmoothLevel::best, .hold_factor = factor});
    CAPTURE(factor, before, trajectory.duration());
    CHECK(trajectory.duration() > 0.999 * before);
    CHECK(trajectory.duration() < 1.2 * fastest.duration());
    CHECK_FALSE(TrajectoryExecutor(trajectory, mill, {.hold_factor = factor}).error());
    before = trajectory.duration();
  }
}

TEST_CASE("brakes: a stream of blocks is held within the bound that its executor tells", "[brakes]") {
  for (const auto level : {SmoothLevel::good, SmoothLevel::best}) {
    const auto program = read_text(wave(level == SmoothLevel::good ? 300 : 150), mill);
    REQUIRE_FALSE(program.failed());
    Executor<Machine<3>, 100> executor(mill, LevelExecutorOptions{.level = level});
    CHECK_FALSE(executor.worst_hold());
    Random random;
    std::size_t next = 0;
    double until = 0.3, held = -1, longest = 0;
    SetPoint<3> point;
    for (int tick = 0; !executor.finished() && tick < 400000; ++tick) {
      while (next < program.blocks().size() && executor.push(program.blocks()[next])) ++next;
      if (next == program.blocks().size()) executor.end_of_program();
      if (held < 0 && point.time > until) {
        executor.feed_hold();
        held = point.time;
      } else if (held >= 0 && executor.state() == ExecutorState::held) {
        REQUIRE(executor.worst_hold());
        CAPTURE(level, point.line, held);
        CHECK(point.time - held <= *executor.worst_hold() + 2 * period);
        longest = std::max(longest, point.time - held);
        executor.resume();
        held = -1;
        until = point.time + random.uniform(0.25, 0.8);  // at the planned speed again
      }
      point = executor.tick(period);
    }
    REQUIRE(executor.finished());
    CHECK_FALSE(executor.error());
    CHECK(longest > least_time(30, 0, 1000, 10000) / 2);
    CHECK(*executor.worst_hold() < 1.6 * 1.5 * least_time(30, 0, 1000, 10000));
    CHECK(executor.restart(0, point.position));
    CHECK_FALSE(executor.worst_hold());
  }
  const auto program = read_text(wave(90), mill);
  Executor<Machine<3>, 100> unbounded(mill,
                                      LevelExecutorOptions{.level = SmoothLevel::good, .hold_factor = 0});
  for (std::size_t i = 0; i < program.blocks().size(); ++i) CHECK(unbounded.push(program.blocks()[i]));
  unbounded.end_of_program();
  for (int tick = 0; tick < 300; ++tick) unbounded.tick(period);
  CHECK_FALSE(unbounded.worst_hold());
}

TEST_CASE("brakes: numbers that are none are refused at every door", "[brakes]") {
  const auto program = read_text("F600\nG1 X1\n", mill);
  const double nan = std::nan("");
  for (const double factor : {-1.0, 0.5, 1.0, nan, HUGE_VAL}) {
    CAPTURE(factor);
    const auto trajectory = plan_blocks(program.blocks(), mill, {.hold_factor = factor});
    REQUIRE_FALSE(trajectory);
    CHECK(trajectory.error().about.error.field == "hold factor");
    Executor<Machine<3>, 16> executor(
        mill, LevelExecutorOptions{.level = SmoothLevel::good, .hold_factor = factor});
    REQUIRE(executor.error());
    CHECK(executor.error()->error().field == "hold factor");
  }
  for (const double reserve : {-0.1, 1.0, nan})
    CHECK_FALSE(plan_blocks(program.blocks(), mill, {.reserve = reserve}));
  const auto trajectory = plan_blocks(program.blocks(), mill);
  REQUIRE(trajectory);
  for (const double factor : {0.0, 1.0, nan})
    CHECK(TrajectoryExecutor(*trajectory, mill, {.hold_factor = factor}).error());
}
