// A planned trajectory run with requests: limits by differences of positions, holds against closed forms.
#include "cncplan/trajectory_executor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "cncplan/plan_program.hpp"
#include "cncplan/smooth_stream.hpp"
#include "least_brake.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace cncplan::test;

namespace {

const Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
constexpr double period = 1e-3;

template <int N = 3>
auto planned(const std::string& text, const Machine<N>& machine, SmoothLevel level = SmoothLevel::good) {
  const auto program = read_text(text, machine);
  for (const auto& p : program.problems()) UNSCOPED_INFO(to_text(p));
  REQUIRE_FALSE(program.failed());
  auto trajectory = plan_blocks(program.blocks(), machine, {.tolerance = 0.01, .level = level});
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
    TrajectoryExecutor executor(trajectory, mill, {.longest_hold = 10});
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
    held.feed_override(7);  // 2, but the feed is the limit of the machine
    run(held, 0.2);
    CHECK(held.clock().velocity == 1);
  }
}

TEST_CASE("trajectory executor: an override above 1 is taken where the limits leave room for it",
          "[trajectory-executor]") {
  Machine<3> machine{.limits = {.velocity = 60, .acceleration = 1000, .jerk = 10000}};
  machine.axes[1].velocity = 40;
  machine.axes[1].acceleration = 800;
  machine.axes[1].jerk = 9000;
  const auto trajectory =
      planned("F1800 G1 X40\nY30\nX45 Y33\nG3 X60 Y20 R16\nG0 X0 Y0\nG1 X1 Y1\nX1.5 Y0.4\nX30\nY40\n",
              machine, SmoothLevel::good);
  const auto seed = GENERATE(range(0, 6));
  test::Random random(static_cast<std::uint64_t>(seed));
  const double share = seed < 2 ? 1.3 : random.uniform(1, 2);
  CAPTURE(seed, share);
  TrajectoryExecutor executor(trajectory, machine, {.longest_hold = 10});
  executor.feed_override(share);
  std::array<Vector3, 4> p;
  p.fill(Vector3::Zero());
  double time = 0, feed = 0;
  while (!executor.finished() && time < 100) {
    if (seed > 0 && random.integer(0, 200) == 0) executor.feed_hold();
    if (seed > 0 && random.integer(0, 50) == 0) executor.resume();
    const auto point = executor.tick(period);
    time += period;
    p = {point.position, p[0], p[1], p[2]};
    const Vector3 v = (p[0] - p[1]) / period, a = (p[0] - 2 * p[1] + p[2]) / std::pow(period, 2),
                  j = (p[0] - 3 * p[1] + 3 * p[2] - p[3]) / std::pow(period, 3);
    CHECK(v.norm() <= 60 * (1 + 1e-9));
    CHECK(a.norm() <= 1000 * (1 + 1e-6));
    CHECK(j.norm() <= 10000 * (1 + 1e-4));
    CHECK(std::abs(v.y()) <= 40 * (1 + 1e-9));
    CHECK(std::abs(a.y()) <= 800 * (1 + 1e-6));
    CHECK(std::abs(j.y()) <= 9000 * (1 + 1e-4));
    if (point.line <= 4) feed = std::max(feed, point.velocity.norm());
  }
  CHECK(executor.finished());
  CHECK((p[0] - trajectory.at(trajectory.duration()).position).norm() < 1e-9);
  CHECK(feed <= 30 * share * (1 + 1e-6));
  if (seed > 0) return;
  CHECK(feed == Approx(30 * share).epsilon(1e-3));
  CHECK(time < 0.9 * trajectory.duration());
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

TEST_CASE("trajectory executor: words come once, and stops wait as they are told", "[trajectory-executor]") {
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
  const auto trajectory =
      plan_blocks(program.blocks(), machine, {.tolerance = 0.01, .level = SmoothLevel::fast});
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

TEST_CASE("trajectory executor: a part of a longer motion is refused", "[trajectory-executor]") {
  SmoothStream<Machine<3>, ProgramBlock<Machine<3>>> stream(
      mill, {.tolerance = 0.01, .level = SmoothLevel::good}, 40);
  std::string lines = "F1800 G91\n";
  for (int i = 0; i < 150; ++i) lines += i % 2 == 0 ? "G1 X1\n" : "G1 X1 Y0.2\n";
  const auto program = read_text(lines, mill);
  REQUIRE_FALSE(program.failed());
  using Part = decltype(stream)::Part;
  std::vector<Part> parts;
  const auto take = [&] {
    while (stream.ready()) parts.push_back(stream.take());
  };
  for (const auto& block : program.blocks()) {
    REQUIRE(stream.push(block));
    take();
  }
  REQUIRE(stream.finish());
  take();
  REQUIRE(parts.size() > 2);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    CAPTURE(i);
    const auto first = parts[i].at(0.0), last = parts[i].at(parts[i].duration());
    const bool whole = first.velocity.norm() == 0 && last.velocity.norm() < 1e-6;
    TrajectoryExecutor executor(parts[i], mill);
    CHECK(executor.error().has_value() == !whole);
    if (whole) continue;
    CHECK(executor.error()->error().code == ErrorCode::above_limit);
    CHECK(executor.error()->error().value ==
          Approx((first.velocity.norm() > 0 ? first : last).velocity.norm())
              .epsilon(0.01));  // the tool in a bend
    CHECK(executor.finished());
    executor.resume();
    for (int k = 0; k < 50; ++k) CHECK(executor.tick(period).position == first.position);
    CHECK(executor.tick(period).velocity.norm() == 0);
  }
}

TEST_CASE(
    "trajectory executor: a trajectory that cannot be held in time is refused, and says how long it takes",
    "[trajectory-executor]") {
  const char* const circles = "F1800 G2 I1 P12\n";
  const auto to_the_limit = planned(circles, mill, SmoothLevel::best);
  TrajectoryExecutor refused(to_the_limit, mill);
  REQUIRE(refused.error());
  CHECK(refused.error()->error().code == ErrorCode::above_limit);
  CHECK(refused.error()->error().bound == 1);
  CHECK(refused.error()->error().value == *refused.worst_hold());
  CHECK(*refused.worst_hold() > 1);
  CHECK(refused.finished());
  run(refused, 0.1);
  CHECK(refused.tick(period).position == to_the_limit.at(0.0).position);

  const auto hold = [](const auto& trajectory, double longest) {
    double worst = 0;
    for (double at = 0.05; at < trajectory.duration() - 0.05; at += 0.31) {
      TrajectoryExecutor executor(trajectory, mill, {.longest_hold = longest});
      REQUIRE_FALSE(executor.error());
      run(executor, at);
      executor.feed_hold();
      const double time = ticks_to_rest(executor, period);
      CHECK(time <= *executor.worst_hold() + 2 * period);
      worst = std::max(worst, time);
    }
    return worst;
  };
  TrajectoryExecutor allowed(to_the_limit, mill, {.longest_hold = 60});
  CHECK_FALSE(allowed.error());
  const double longest = hold(to_the_limit, 60);
  CHECK(longest > 1);
  CHECK(*allowed.worst_hold() > longest - 2 * period);

  const auto reserved = planned(circles, with_reserve(mill, 0.05), SmoothLevel::best);
  TrajectoryExecutor executor(reserved, mill);
  CHECK_FALSE(executor.error());
  CHECK(*executor.worst_hold() < 0.6);
  CHECK(hold(reserved, 1) < 0.5);
}

TEST_CASE("trajectory executor: holds on a wave of short lines come soon, within the limits",
          "[trajectory-executor]") {
  CHECK(least_time(30, 0, 1000, 10000) == Approx(2 * std::sqrt(30.0 / 10000)));
  CHECK(least_time(300, 0, 1000, 10000) == Approx(0.3 + 0.1));
  std::string wave = "F1800\n";
  for (int i = 1; i <= 100; ++i)
    wave += "G1 X" + std::to_string(0.25 * i) + " Y" + std::to_string(3 * std::sin(0.17 * i)) + " Z" +
            std::to_string(std::sin(0.4 * i)) + "\n";
  for (const auto level : {SmoothLevel::good, SmoothLevel::best}) {
    const double reserve = level == SmoothLevel::good ? 0.05 : 0.02;
    CAPTURE(level, reserve);
    const auto trajectory = planned(wave, with_reserve(mill, reserve), level);
    TrajectoryExecutor executor(trajectory, mill);
    REQUIRE_FALSE(executor.error());
    std::vector<double> ratios;
    double longest = 0;
    auto before = executor.tick(period);
    const auto tick = [&] {
      const auto now = executor.tick(period);
      CHECK((now.position - before.position).norm() <= 30 * period * (1 + 1e-9));
      CHECK((now.velocity - before.velocity).norm() <= 1000 * period * (1 + 1e-9));
      CHECK((now.acceleration - before.acceleration).norm() <= 10000 * period * (1 + 1e-6));
      CHECK((now.position - trajectory.at(executor.clock().position).position).norm() < 1e-9);
      before = now;
    };
    for (int k = 0; !executor.finished(); ++k) {
      for (int i = 0; i < 97 + k % 23 && !executor.finished(); ++i) tick();
      const double least = least_time(
          before.velocity.norm(),
          before.velocity.dot(before.acceleration) / std::max(before.velocity.norm(), 1e-9), 1000, 10000);
      executor.feed_hold();
      double held = 0;
      for (; !executor.rests(); held += period) tick();
      longest = std::max(longest, held);
      if (least > 0.01) ratios.push_back((held - period) / least);
      executor.resume();
      REQUIRE(k < 1000);
    }
    CHECK((before.position - trajectory.at(trajectory.duration()).position).norm() < 1e-9);
    REQUIRE(ratios.size() > 20);
    std::ranges::sort(ratios);
    CAPTURE(ratios.size(), ratios.back());
    CHECK(ratios.front() > 0.95);
    CHECK(ratios[ratios.size() / 2] < 1.5);
    CHECK(longest < 0.6);  // slowed by the rate alone: 2.5
  }
}

TEST_CASE("trajectory executor: what is no time ends the run within the limits", "[trajectory-executor]") {
  const auto trajectory = planned(corners, with_reserve(mill, 0.05));
  for (const double bad : {std::nan(""), -1.0, -1e-3, std::numeric_limits<double>::infinity()})
    for (const bool again : {false, true}) {
      CAPTURE(bad, again);
      TrajectoryExecutor executor(trajectory, mill);
      run(executor, 0.4);
      CHECK_FALSE(executor.error());
      auto before = executor.tick(period);
      int ticks = 0;
      do {
        const auto now = executor.tick(ticks == 0 || again ? bad : period);
        CHECK(now.time == Approx(before.time + period));
        CHECK((now.velocity - before.velocity).norm() <= 1000 * period);
        CHECK((now.acceleration - before.acceleration).norm() <= 10000 * period * (1 + 1e-6));
        before = now;
      } while (!executor.finished() && ++ticks < 1000);
      CHECK(executor.finished());
      CHECK(before.velocity.norm() == 0);
      REQUIRE(executor.error());
      CHECK(executor.error()->error().code ==
            (std::isfinite(bad) ? ErrorCode::negative : ErrorCode::not_finite));
    }
}

TEST_CASE("trajectory executor: a machine that is none is refused", "[trajectory-executor]") {
  const auto trajectory = planned(corners, mill);
  for (double Limits::*limit : {&Limits::velocity, &Limits::acceleration, &Limits::jerk}) {
    Machine<3> machine = mill;
    machine.limits.*limit = -1;
    TrajectoryExecutor executor(trajectory, machine);
    REQUIRE(executor.error());
    CHECK(executor.error()->error().code == ErrorCode::not_positive);
    CHECK(executor.finished());
  }
  TrajectoryExecutor by_reserve(trajectory, with_reserve(mill, 2));
  CHECK(by_reserve.error());
  TrajectoryExecutor by_bound(trajectory, mill, {.longest_hold = 0});
  CHECK(by_bound.error());
}
