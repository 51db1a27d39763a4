// A planned trajectory run with requests: limits by differences of positions, holds against closed forms.
#include "cncplan/plan/trajectory_executor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "cncplan/gcode/lines.hpp"
#include "cncplan/plan/plan_program.hpp"
#include "cncplan/plan/smooth_blocks.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"

using namespace cncplan;
using namespace cncplan::test;

namespace {

const Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
constexpr double period = 1e-3;

template <int N = 3>
auto planned(const std::string& text, const Machine<N>& machine, SmoothLevel level = SmoothLevel::good) {
  const auto program = read_text(text, machine);
  REQUIRE_FALSE(program.failed());
  auto trajectory = plan_smooth(program.blocks(), machine, {.tolerance = 0.01}, level);
  REQUIRE(trajectory);
  trajectory->set_words(timed_words(program, *trajectory));
  return *std::move(trajectory);
}

const char* const corners = "F1800 G1 X20\nY20\nX25 Y22\nG3 X30 Y10 R12\nG1 X0 Y0\n";

// Ticks until it is at rest; how long that took.
template <class E>
double ticks_to_rest(E& executor, double step = 1e-4) {
  int ticks = 0;
  do executor.tick(step);
  while (!executor.rests() && ++ticks < 100000);
  return ticks * step;
}
template <class E>
void run(E& executor, double seconds) {
  for (int i = 0; i < static_cast<int>(std::lround(seconds / period)); ++i) executor.tick(period);
}

}  // namespace

TEST_CASE("trajectory executor: without requests it gives the set points of the trajectory",
          "[trajectory-executor]") {
  for (const auto level : {SmoothLevel::good, SmoothLevel::best}) {
    const auto trajectory = planned(corners, mill, level);
    TrajectoryExecutor executor(trajectory, mill);
    int k = 0;
    while (!executor.finished()) {
      const auto point = executor.tick(period);
      const auto wanted = trajectory.at(++k * period);
      CHECK(point.time == Approx(k * period));
      CHECK((point.position - wanted.position).norm() < 1e-10);
      CHECK((point.velocity - wanted.velocity).norm() < 1e-7);
      CHECK((point.acceleration - wanted.acceleration).norm() < 1e-5);
      CHECK(point.line == wanted.line);
      REQUIRE(k < 10000);
    }
    CHECK(k == static_cast<int>(std::ceil(trajectory.duration() / period)));
  }
}

TEST_CASE("trajectory executor: a hold on a line takes the least time, and goes on to the end",
          "[trajectory-executor]") {
  const auto trajectory = planned("F1800 G1 X60\nY1\n", with_reserve(mill, 0.05));
  TrajectoryExecutor executor(trajectory, mill);
  run(executor, 0.5);
  executor.feed_hold();
  CHECK(ticks_to_rest(executor) == Approx(2 * std::sqrt(30.0 / 10000)).margin(5e-4));
  const auto held = executor.tick(period);
  CHECK(held.velocity.norm() == 0);
  CHECK(held.acceleration.norm() == 0);
  run(executor, 1);
  CHECK(executor.tick(period).position == held.position);
  CHECK_FALSE(executor.finished());
  executor.resume();
  int ticks = 0;
  while (!executor.finished() && ++ticks < 10000) executor.tick(period);
  CHECK(executor.tick(period).position == trajectory.at(trajectory.duration()).position);
}

TEST_CASE("trajectory executor: holds come to rest wherever they begin", "[trajectory-executor]") {
  const auto trajectory = planned(corners, with_reserve(mill, 0.05));
  for (double at = 0.01; at < trajectory.duration() - 0.01; at += 0.0173) {
    TrajectoryExecutor executor(trajectory, mill);
    run(executor, at);
    INFO("a hold at " << at);
    executor.feed_hold();
    CHECK(ticks_to_rest(executor) < 0.4);  // from the feed on a line it is 0.11
  }
}

TEST_CASE("trajectory executor: an override stretches the motion, but no dwell", "[trajectory-executor]") {
  const auto trajectory = planned("F1800 G1 X20\nY5\nG4 P0.5\nX0\n", mill);
  TrajectoryExecutor executor(trajectory, mill);
  executor.feed_override(0.5);
  double time = 0, rested = 0;
  Vector3 last = Vector3::Constant(-1);
  while (!executor.finished() && time < 100) {
    const auto point = executor.tick(period);
    time += period;
    CHECK(point.velocity.norm() <= 15 + 1e-9);
    if (point.position == last) rested += period;
    last = point.position;
  }
  CHECK(time == Approx(0.5 + 2 * (trajectory.duration() - 0.5)).margin(2 * period));
  CHECK(rested == Approx(0.5).margin(2 * period));
  for (const double share : {0.0, -1.0, std::nan("")}) {
    TrajectoryExecutor held(trajectory, mill);
    held.feed_override(share);
    run(held, 0.1);
    CHECK(held.rests());
    held.feed_override(7);  // no faster than planned
    run(held, 0.2);
    CHECK(held.clock().velocity == 1);
  }
}

TEST_CASE("trajectory executor: back to the start, over dwells without waiting, and forwards again",
          "[trajectory-executor]") {
  const auto trajectory = planned("F1800 G1 X20\nY5\nG4 P50\nX0\n", with_reserve(mill, 0.05));
  TrajectoryExecutor executor(trajectory, mill);
  run(executor, trajectory.duration() - 0.2);
  CHECK(executor.tick(period).line == 4);
  executor.reverse(true);
  double time = 0;
  while (executor.clock().position > 0 && (time += period) < 20) executor.tick(period);
  CHECK(time < trajectory.duration() - 49);
  run(executor, 0.1);
  CHECK(executor.rests());
  CHECK_FALSE(executor.finished());
  CHECK(executor.tick(period).position == trajectory.at(0.0).position);
  executor.reverse(false);
  time = 0;
  while (!executor.finished() && (time += period) < 200) executor.tick(period);
  CHECK(time == Approx(trajectory.duration()).margin(0.01));
}

TEST_CASE("trajectory executor: a way back that is asked for while it brakes, and taken back",
          "[trajectory-executor]") {
  const auto trajectory = planned(corners, with_reserve(mill, 0.05));
  TrajectoryExecutor executor(trajectory, mill);
  run(executor, 1);
  executor.feed_hold();
  run(executor, 0.03);
  executor.reverse(true);
  executor.resume();
  run(executor, 0.4);
  CHECK(executor.clock().velocity == Approx(-1));
  executor.reverse(false);
  run(executor, 0.5);
  CHECK(executor.clock().velocity == Approx(1));
}

TEST_CASE("trajectory executor: a stop ends the program where it comes to rest", "[trajectory-executor]") {
  const auto trajectory = planned(corners, mill);
  TrajectoryExecutor executor(trajectory, mill);
  run(executor, 0.4);
  executor.stop();
  int ticks = 0;
  while (!executor.finished() && ++ticks < 1000) executor.tick(period);
  CHECK(ticks < 1000);
  executor.resume();
  run(executor, 0.2);
  CHECK(executor.finished());
  CHECK(executor.clock().position < 1);
}

TEST_CASE("trajectory executor: words come once, and stops wait as they are told",
          "[trajectory-executor]") {
  const auto trajectory = planned("F1800 M3 G1 X5\nM8\nY5\nM0\nX0\nM1\nY0\nM9\n", mill);
  for (const bool waits : {false, true}) {
    TrajectoryExecutor executor(trajectory, mill);
    if (!waits) executor.program_stop(false);
    executor.optional_stop(waits);
    std::vector<int> words;
    std::vector<int> stops;
    double time = 0;
    while (!executor.finished() && (time += period) < 100) {
      const auto point = executor.tick(period);
      for (const auto& word : point.words) words.push_back(static_cast<int>(word.number));
      if (executor.rests() && !executor.finished() && (stops.empty() || stops.back() != words.back())) {
        stops.push_back(words.back());
        run(executor, 0.1);
        CHECK(executor.rests());
        executor.resume();
      }
    }
    CHECK(words == std::vector<int>{3, 8, 0, 1, 9});
    if (waits) CHECK(stops == std::vector<int>{0, 1});
    CHECK(time < 100);
  }
}

TEST_CASE(
    "trajectory executor: more words than a set point holds are told before a stop is left, and at the end",
    "[trajectory-executor]") {
  const std::string many = "M3 S1\nM8\nM9\nM8\nM9\nM8\nM9\nM8\nM9\n";
  const auto trajectory = planned("F1800 G1 X5\n" + many + "M0\nX0\n" + many, mill);
  TrajectoryExecutor executor(trajectory, mill);
  std::size_t told = 0;
  double time = 0;
  const auto go_on = [&] {
    told += executor.tick(period).words.size();
    return !executor.finished() && (time += period) < 2;
  };
  while (go_on()) {
  }
  CHECK(executor.clock().position == Approx(trajectory.duration() / 2));
  CHECK(told == 11);
  executor.resume();
  time = 0;
  while (go_on()) {
  }
  CHECK(executor.finished());
  CHECK(told == 21);
}

TEST_CASE("trajectory executor: a level that an executor has, and axes that turn", "[trajectory-executor]") {
  Machine<4> machine{.limits = mill.limits};
  machine.axes[3].velocity = 2;
  machine.axes[3].acceleration = 20;
  machine.axes[3].jerk = 200;
  const auto program = read_text("F1800 G1 X20 A30\nY5 A0\nA90\nG2 X30 I5\n", machine);
  REQUIRE_FALSE(program.failed());
  const auto trajectory = plan_blocks(program.blocks(), machine, {.tolerance = 0.01});
  REQUIRE(trajectory);
  TrajectoryExecutor executor(*trajectory, machine);
  int ticks = 0;
  std::array<VectorN<double, 4>, 4> p;
  p.fill(VectorN<double, 4>::Zero());
  constexpr double step = 1e-4;
  while (!executor.finished() && ++ticks < 200000) {
    if (ticks % 4000 == 1000) executor.feed_hold();
    if (ticks % 4000 == 3000) executor.resume();
    p = {executor.tick(step).position, p[0], p[1], p[2]};
    if (ticks < 4) continue;
    const VectorN<double, 4> jerk = (p[0] - 3 * p[1] + 3 * p[2] - p[3]) / (step * step * step);
    CHECK(jerk.head<3>().norm() < 10000 * (1 + 1e-3));
    CHECK(std::abs(jerk[3]) < 200 * (1 + 1e-3));
  }
  CHECK(executor.finished());
}

TEST_CASE("trajectory executor: nothing to do", "[trajectory-executor]") {
  const auto trajectory = planned("G4 P0.1\n", mill);
  TrajectoryExecutor executor(trajectory, mill);
  run(executor, 0.05);
  CHECK_FALSE(executor.finished());
  run(executor, 0.06);
  CHECK(executor.finished());
}

TEST_CASE("trajectory executor: a tick allocates nothing", "[trajectory-executor]") {
  const auto trajectory = planned(corners, with_reserve(mill, 0.05));
  TrajectoryExecutor executor(trajectory, mill);
  const auto count = heap_allocations_of([&] {
    run(executor, 0.6);
    executor.feed_hold();
    run(executor, 0.3);
    executor.reverse(true);
    executor.resume();
    run(executor, 0.3);
  });
  CHECK(count == 0);
}

TEST_CASE("a machine with a reserve", "[trajectory-executor]") {
  Machine<3> machine = mill;
  machine.axes[1].acceleration = 400;
  machine.axes[1].acceleration_down = 300;
  const auto lower = with_reserve(machine, 0.25);
  CHECK(lower.limits.velocity == 30);
  CHECK(lower.limits.acceleration == 750);
  CHECK(lower.limits.jerk == 7500);
  CHECK(lower.axes[1].acceleration == 300);
  CHECK(lower.axes[1].acceleration_down == 225);
  CHECK(lower.axes[0].jerk == machine.axes[0].jerk);
}
