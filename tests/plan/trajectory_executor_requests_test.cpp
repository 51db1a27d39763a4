// A planned trajectory is run with everything that an executor can be asked for: single steps, pauses, jogs
// and the way back, a restart at a line, a quick stop, step edges, states; behind a map too.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "cncplan/live_steps.hpp"
#include "cncplan/plan_program.hpp"
#include "cncplan/trajectory_executor.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace cncplan::test;

namespace {

const Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
constexpr double period = 1e-3;
using Planned = Trajectory<Machine<3>, ProgramBlock<Machine<3>>>;
using Runner = TrajectoryExecutor<Machine<3>, ProgramBlock<Machine<3>>>;

Planned planned(const std::string& text, SmoothLevel level = SmoothLevel::good) {
  auto trajectory = plan_text(text, mill, {.level = level, .hold_factor = 1.5});
  REQUIRE(trajectory);
  return *std::move(trajectory);
}

const char* const corners = "F1800 G1 X20\nY20\nX25 Y22\nG3 X30 Y10 R12\nG1 X0 Y0\n";

// Ticks until it is in a state; the last set point.
template <class E>
auto tick_until(E& executor, ExecutorState state) {
  auto point = executor.tick(period);
  for (int i = 0; executor.state() != state; ++i) {
    REQUIRE(i < 100000);
    point = executor.tick(period);
  }
  return point;
}

}  // namespace

TEST_CASE("trajectory executor: what it is doing, at every change", "[trajectory-executor]") {
  const auto trajectory = planned("F1800 G1 X5\nG4 P0.05\nM0\nX10\n");
  Runner executor(trajectory, mill);
  std::vector<ExecutorState> states;
  const auto run = [&](int ticks) {
    for (int i = 0; i < ticks; ++i) {
      executor.tick(period);
      if (states.empty() || states.back() != executor.state()) states.push_back(executor.state());
    }
  };
  run(150);
  executor.feed_hold();
  run(300);
  executor.resume();
  run(1000);
  executor.resume();
  run(100);
  executor.feed_hold();
  run(200);
  REQUIRE(executor.jog_by({0, 3, 0}));
  run(1000);
  executor.resume();
  run(3000);
  using enum ExecutorState;
  CHECK(states == std::vector{moving, holding, held, moving, dwelling, stopped, moving, holding, held,
                              jogging, away, jogging, moving, finished});
}

TEST_CASE("trajectory executor: single steps and pauses rest at the next block", "[trajectory-executor]") {
  const auto trajectory = planned(corners);
  Runner executor(trajectory, mill);
  executor.single_step(true);
  std::vector<double> places;
  do {
    places.push_back(tick_until(executor, ExecutorState::held).along.position);
    executor.resume();
  } while (places.size() < 4);
  tick_until(executor, ExecutorState::finished);
  for (std::size_t i = 0; i < places.size(); ++i) {
    CAPTURE(i);
    CHECK(std::abs(places[i] - trajectory.start_length(i + 1)) < 1);
  }
  Runner other(trajectory, mill);
  other.pause_at(4);
  const auto point = tick_until(other, ExecutorState::held);
  CHECK(std::abs(point.along.position - trajectory.start_length(3)) < 1);
  other.resume();
  tick_until(other, ExecutorState::finished);
}

TEST_CASE("trajectory executor: a jog in a hold, and back to the path", "[trajectory-executor]") {
  const auto trajectory = planned(corners);
  Runner executor(trajectory, mill);
  for (int i = 0; i < 400; ++i) executor.tick(period);
  const auto refused = executor.jog_to({0, 0, 50});
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == ErrorCode::unfinished);
  executor.feed_hold();
  const Vector3 left = tick_until(executor, ExecutorState::held).position;
  const double shown = executor.clock().position;
  REQUIRE(executor.jog_to(left + Vector3(2, -1, 7)));
  CHECK((tick_until(executor, ExecutorState::away).position - left - Vector3(2, -1, 7)).norm() < 1e-9);
  CHECK(executor.clock().position == shown);
  REQUIRE(executor.return_to_path());
  CHECK((tick_until(executor, ExecutorState::held).position - left).norm() < 1e-9);
  REQUIRE(executor.jog_by({0, 0, 5}));
  tick_until(executor, ExecutorState::away);
  executor.resume();
  const auto end = tick_until(executor, ExecutorState::finished);
  CHECK((end.position - trajectory.at(trajectory.duration()).position).norm() < 1e-9);
  REQUIRE(executor.jog_to({1, 2, 3}));
  tick_until(executor, ExecutorState::away);
}

TEST_CASE("trajectory executor: it begins again at lines before which it rests", "[trajectory-executor]") {
  const auto trajectory = planned("F1800 M3 S1 G1 X5\nX10 Y2\nG4 P0.3\nM8\nX20 Y0\nG61 X30\nG64 Y10\n");
  Runner executor(trajectory, mill);
  tick_until(executor, ExecutorState::finished);
  CHECK_FALSE(executor.restart(2, Vector3(10, 2, 0)));   // it passes there
  CHECK_FALSE(executor.restart(99, Vector3(10, 2, 0)));  // no such line
  REQUIRE(executor.restart(5, Vector3(0, 0, 4)));
  CHECK(executor.state() == ExecutorState::away);
  std::vector<int> words;
  double least = 100;
  Vector3 end;
  for (int i = 0; executor.state() != ExecutorState::finished; ++i) {
    REQUIRE(i < 20000);
    const auto point = executor.tick(period);
    for (const auto& word : point.words) words.push_back(static_cast<int>(word.number));
    if (executor.state() == ExecutorState::moving) least = std::min(least, point.position.x());
    end = point.position;
  }
  CHECK(words == std::vector{8});
  CHECK(least > 10 - 1e-6);
  CHECK((end - Vector3(30, 10, 0)).norm() < 1e-9);
  REQUIRE(executor.restart(5, end));
  executor.single_step(true);
  CHECK((tick_until(executor, ExecutorState::held).position - Vector3(20, 0, 0)).norm() < 1e-3);
  executor.single_step(false);
  REQUIRE(executor.restart(0, Vector3(20, 0, 0)));
  double time = 0;
  while (executor.state() != ExecutorState::finished && time < 100) executor.tick(period), time += period;
  CHECK(time > trajectory.duration());
}

TEST_CASE("trajectory executor: programs without motion are over at once, and tell their words",
          "[trajectory-executor]") {
  for (const bool words : {false, true}) {
    const auto trajectory = planned(words ? "M3 S1\nM8\n" : "");
    Runner executor(trajectory, mill);
    const auto point = executor.tick(period);
    CHECK(point.words.size() == (words ? 3 : 0));
    CHECK(executor.finished());
    CHECK_FALSE(executor.error());
    CHECK_FALSE(executor.worst_hold());
    REQUIRE(executor.restart(0, Vector3(1, 2, 3)));
    executor.tick(period);
  }
}

TEST_CASE("trajectory executor: a quick stop uses its share of the limits", "[trajectory-executor]") {
  const auto trajectory = planned("F1800 G1 X60\n");
  const auto rest = [&](double share) {
    Runner executor(trajectory, mill, {.quick_stop_share = share});
    for (int i = 0; i < 500; ++i) executor.tick(period);
    executor.quick_stop();
    int ticks = 0;
    while (!executor.rests() && ticks < 10000) executor.tick(1e-4), ++ticks;
    return ticks * 1e-4;
  };
  CHECK(rest(1) == Approx(2 * std::sqrt(30.0 / 1e4)).margin(5e-4));
  CHECK(rest(4) == Approx(2 * std::sqrt(30.0 / 4e4)).margin(5e-4));
}

TEST_CASE("trajectory executor: rapids have their own override", "[trajectory-executor]") {
  const auto trajectory = planned("G0 X30\nF900 G1 Y10\n");
  Runner executor(trajectory, mill);
  executor.rapid_override(0.5);
  double rapid = 0, feed = 0;
  while (executor.state() != ExecutorState::finished) {
    const auto point = executor.tick(period);
    double& most = point.line == 1 ? rapid : feed;
    most = std::max(most, point.velocity.norm());
    REQUIRE(executor.time() < 20);
  }
  CHECK(rapid == Approx(15).epsilon(1e-4));
  CHECK(feed == Approx(15).epsilon(1e-4));
}

TEST_CASE("trajectory executor: a block that is pushed is told", "[trajectory-executor]") {
  const auto trajectory = planned(corners);
  Runner executor(trajectory, mill);
  executor.tick(period);
  CHECK(executor.push(trajectory.program()[0]));
  REQUIRE(executor.error());
  CHECK(executor.error()->error().code == ErrorCode::not_supported);
  tick_until(executor, ExecutorState::fault);
  REQUIRE(executor.restart(0, Vector3::Zero()));
  CHECK_FALSE(executor.error());
}

TEST_CASE("trajectory executor: step edges are where the axes are, jogs too", "[trajectory-executor]") {
  Machine<3> machine = mill;
  for (auto& axis : machine.axes) axis.motors = {step::Drive{.steps_per_unit = 400}};
  const auto trajectory = plan_text(corners, machine, {.level = SmoothLevel::good, .hold_factor = 1.5});
  REQUIRE(trajectory);
  TrajectoryExecutor executor(*trajectory, machine);
  LiveSteps steps(executor);
  std::array<long, 3> counts{};
  for (int i = 0; executor.state() != ExecutorState::finished; ++i) {
    REQUIRE(i < 20000);
    if (i == 500) executor.feed_hold();
    if (i == 900) REQUIRE(executor.jog_by({1, 2, 3}));
    if (i == 2000) executor.resume();
    const auto point = steps.tick(period);
    while (const auto edge = steps.next()) counts[static_cast<std::size_t>(edge->axis)] += edge->direction;
    for (int axis = 0; axis < 3; ++axis) {
      CAPTURE(i, axis);
      CHECK(std::abs(static_cast<double>(counts[static_cast<std::size_t>(axis)]) / 400 -
                     point.position[axis]) <= 0.5 / 400 + 1e-6);
    }
  }
}

TEST_CASE("trajectory executor: random requests of all kinds, by differences of positions",
          "[trajectory-executor]") {
  const auto trajectory = planned(
      "F1800 M3 G1 X20\nY20\nX25 Y22\nG4 P0.02\nG3 X30 Y10 R12\nG1 X28.5 Y9.5\nX0 Y0\n", SmoothLevel::best);
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    Runner executor(trajectory, mill);
    std::array<Vector3, 4> p;
    p.fill(Vector3::Zero());
    int words = 0;
    for (int tick = 0; executor.state() != ExecutorState::finished; ++tick) {
      REQUIRE(tick < 200000);
      if (tick < 6000 && random.integer(0, 60) == 0) {
        switch (random.integer(0, 10)) {
          case 0:
          case 1:
            executor.feed_hold();
            break;
          case 2:
            executor.single_step(random.coin());
            break;
          case 3:
            executor.pause_at(random.integer(1, 7));
            break;
          case 4:
            executor.reverse(random.coin());
            break;
          case 5:
            executor.feed_override(random.uniform(0, 2));
            break;
          case 6:
            (void)executor.jog_by({random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2)});
            break;
          case 7:
            executor.quick_stop();
            break;
          default:
            executor.resume();
        }
      }
      if (tick >= 6000) {
        executor.reverse(false), executor.single_step(false), executor.pause_at(0), executor.feed_override(1);
        executor.resume();
      }
      const auto point = executor.tick(period);
      words += static_cast<int>(point.words.size());
      p = {point.position, p[0], p[1], p[2]};
      const Vector3 v = (p[0] - p[1]) / period, a = (p[0] - 2 * p[1] + p[2]) / std::pow(period, 2),
                    j = (p[0] - 3 * p[1] + 3 * p[2] - p[3]) / std::pow(period, 3);
      CAPTURE(tick, executor.state());
      // a jog keeps the limits of each axis, which have their share of the tool's here
      CHECK(v.norm() <= 30 * (1 + 1e-9));
      CHECK(a.norm() <= 1000 * (1 + 1e-6));
      CHECK(j.norm() <= 10000 * (1 + 1e-4));
    }
    CHECK(words == 1);
    CHECK((p[0] - trajectory.at(trajectory.duration()).position).norm() < 1e-9);
  }
}
