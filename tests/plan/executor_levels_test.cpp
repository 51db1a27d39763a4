// Executors at the levels good and best: limits by differences, the path by brute force, words, dwells,
// holds.
#include "cncplan/plan/executor_levels.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <memory_resource>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include "cncplan/plan/live_steps.hpp"
#include "plan/at_level.hpp"
#include "plan/live_run.hpp"
#include "plan/rows_program.hpp"
#include "soak/smooth_program.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"

using namespace cncplan;
using namespace cncplan::test;

namespace {

using Runner = Executor<Machine<3>, 64>;
constexpr double period = 1e-3;

// With limits of axes, which jogs need.
Machine<3> with_axes() {
  Machine<3> machine = mill;
  for (auto& axis : machine.axes) axis.velocity = 50, axis.acceleration = 1000, axis.jerk = 10000;
  return machine;
}

std::unique_ptr<Runner> runner(LevelExecutorOptions options = {.level = SmoothLevel::good}) {
  return std::make_unique<Runner>(with_axes(), options);
}

template <class E>
void feed(E& executor, const MillBlocks& blocks, std::size_t& fed) {
  while (fed < blocks.size() && executor.push(blocks[fed]))
    if (++fed == blocks.size()) executor.end_of_program();
}

// To the end, with as many blocks as it takes; s.
template <class E>
double run_to_end(E& executor, const MillBlocks& blocks, double most = 600) {
  std::size_t fed = 0;
  double time = 0;
  while (!executor.finished() && time < most) {
    feed(executor, blocks, fed);
    executor.tick(period);
    time += period;
  }
  return time;
}

void check(const LiveFaults& faults, double tolerance) {
  CHECK(faults.velocity <= 1 + 1e-6);
  CHECK(faults.acceleration <= 1 + 1e-5);
  CHECK(faults.jerk <= 1 + 1e-4);
  CHECK(faults.place <= tolerance * (1 + 1e-6) + 1e-6);
  CHECK(faults.missed <= 2 * tolerance + 0.02);  // by chords of a tick
  CHECK(faults.dwell <= 2e-3);
  CHECK(faults.end < 1e-6);
  CHECK_FALSE(faults.words_wrong);
  CHECK(faults.finished);
  CHECK_FALSE(faults.failed);
}

}  // namespace

TEST_CASE("executor levels: one option is the level", "[executor-levels]") {
  const MillBlocks blocks = blocks_of("F1800 G1 X10\nX10.7 Y0.7\nX11.4 Y0\nX20\nX20.5 Y0.5\nX21 Y0\nX30\n");
  double last = std::numeric_limits<double>::infinity();
  for (const auto level : {SmoothLevel::fast, SmoothLevel::good}) {
    const auto executor = runner({.level = level, .reserve = 0, .hold_factor = 0});
    const double time = run_to_end(*executor, blocks);
    CAPTURE(static_cast<int>(level), time);
    CHECK(time < last);
    last = time;
  }
  const auto whole = plan_blocks(blocks, with_axes(), at_level(SmoothLevel::good, within));
  REQUIRE(whole);
  CHECK(last == Approx(whole->duration()).margin(2 * period));
  const auto best = runner({.level = SmoothLevel::best, .reserve = 0, .hold_factor = 0});
  const auto whole_best = plan_blocks(blocks, with_axes(), at_level(SmoothLevel::best, within));
  CHECK(run_to_end(*best, blocks) == Approx(whole_best->duration()).margin(5 * period));
}

TEST_CASE("executor levels: a long run in parts goes through the cuts, within limits and tolerance",
          "[executor-levels]") {
  const MillBlocks blocks = blocks_of(rows(12, 50));
  const auto executor = runner({.level = SmoothLevel::good, .reserve = 0, .hold_factor = 0});
  test::Random random;
  const Machine<3> machine = with_axes();
  const LiveFaults faults = LiveRun(*executor, blocks, machine, {.small = 0.0098}, random).run(600);
  check(faults, 0.01);
  const auto whole = plan_blocks(blocks, mill, at_level(SmoothLevel::good, within));
  REQUIRE(whole);
  CHECK(faults.time < 1.02 * whole->duration());
}

TEST_CASE("executor levels: starved, it drives the proven way to rest, and goes on", "[executor-levels]") {
  const MillBlocks blocks = blocks_of(rows(6, 50));
  for (const double wait : {0.05, 100.0}) {  // with the second one only the way to rest is there
    const auto executor = runner({.level = SmoothLevel::good, .longest_wait = wait});
    std::size_t fed = 0;
    test::Random random;
    std::array<Vector3, 4> p;
    p.fill(Vector3::Zero());
    int rests = 0, ticks = 0, pause = 0;
    bool stood = true;
    for (; !executor->finished() && ticks < 200000; ++ticks) {
      // Two thirds of it, then nothing until it has rested for a second.
      const std::size_t most = pause < 1000 ? blocks.size() * 2 / 3 : blocks.size();
      while (fed < most && executor->push(blocks[fed]))
        if (++fed == blocks.size()) executor->end_of_program();
      const auto point = executor->tick(period);
      p = {point.position, p[0], p[1], p[2]};
      CHECK((p[0] - 2 * p[1] + p[2]).norm() <= 1000 * period * period * (1 + 1e-5));
      CHECK((p[0] - 3 * p[1] + 3 * p[2] - p[3]).norm() <= 10000 * period * period * period * (1 + 1e-3));
      const bool stands = point.velocity.norm() == 0;
      rests += stands && !stood ? 1 : 0;
      stood = stands;
      if (stands && fed == most) ++pause;
      if (wait > 1 && pause == 500) {
        CHECK(executor->state() == ExecutorState::waiting);
        pause = 1000;
      }
    }
    CHECK(executor->finished());
    CHECK(rests >= 2);  // one for want of blocks, one at the end
    CHECK((executor->tick(period).position - blocks.back().path.position_at(blocks.back().path.length()))
              .norm() < 1e-9);
  }
}

TEST_CASE("executor levels: random programs, random requests, random feeding", "[executor-levels]") {
  test::Random seeds;
  for (int round = 0; round < 12; ++round) {
    const auto seed = static_cast<std::uint64_t>(seeds.integer(1, 1 << 30));
    const auto c = draw_smooth_case(seed);
    INFO("CNCPLAN_SEED=" << test::seed() << ", case " << seed);
    test::Random random(seed);
    std::string text;
    int lines = 0;
    for (std::size_t at = 0, end; at < c.program.size() && lines < 60; at = end, ++lines) {
      end = c.program.find('\n', at) + 1;
      text += c.program.substr(at, end - at);
      const int more = random.integer(0, 19);
      if (more == 0) text += "G4 P0.0123\n";
      if (more == 1) text += "M8\n";
      if (more == 2) text += "M0\n";
    }
    const auto program = read_text(text, c.machine, {.tolerance = c.tolerance});
    REQUIRE_FALSE(program.failed());
    const LiveBlocks blocks(program.blocks().begin(), program.blocks().end());
    LiveCase how;
    how.pace = round % 3 == 0 ? 0 : random.log_uniform(0.02, 0.5);
    how.starved = random.coin() ? 0 : random.integer(1, 30);
    how.jogs = random.coin();
    how.restless = random.uniform(0.5, 5);
    how.small = 0.98 * c.tolerance;
    const auto executor = std::make_unique<Runner>(
        c.machine, LevelExecutorOptions{.tolerance = c.tolerance, .level = SmoothLevel::good});
    if (how.pace == 0) executor->program_stop(false);
    check(LiveRun(*executor, blocks, c.machine, how, random).run(600), c.tolerance);
  }
}

TEST_CASE("executor levels: what it is doing, at every change", "[executor-levels]") {
  const MillBlocks blocks = blocks_of("G21 G90 F1200\nG1 X20\nG4 P0.2\nG1 Y20\nG1 X0\nM30\n");
  const auto executor = runner();
  std::size_t fed = 0;
  feed(*executor, blocks, fed);
  std::vector<std::string_view> states;
  for (int tick = 0; !executor->finished() && tick < 60000; ++tick) {
    if (tick == 1800) executor->feed_hold();
    if (tick == 2400) REQUIRE(executor->jog_to({10, 10, 5}));
    if (tick == 5000) executor->resume();
    executor->tick(period);
    if (const auto now = to_text(executor->state()); states.empty() || states.back() != now)
      states.push_back(now);
  }
  CHECK(states == std::vector<std::string_view>{"moving", "dwelling", "moving", "holding", "held", "jogging",
                                                "away", "jogging", "moving", "finished"});
}

TEST_CASE("executor levels: a hold comes soon, and the time goes on where it was", "[executor-levels]") {
  const MillBlocks blocks = blocks_of(rows(3, 50));
  const auto undisturbed = runner();
  const double time = run_to_end(*undisturbed, blocks);
  for (double at = 0.1; at < time - 0.3; at += 0.37) {
    const auto executor = runner();
    std::size_t fed = 0;
    for (double t = 0; t < at; t += period) {
      feed(*executor, blocks, fed);
      executor->tick(period);
    }
    executor->feed_hold();
    double hold = 0;
    while (executor->tick(period).velocity.norm() > 0 && hold < 10) hold += period;
    CHECK(hold < 0.4);
    CHECK(executor->state() == ExecutorState::held);
    executor->resume();
    double rest = 0;
    while (!executor->finished() && rest < 100) {
      feed(*executor, blocks, fed);
      executor->tick(period);
      rest += period;
    }
    CHECK(at + hold + rest < time + 1);
  }
}

TEST_CASE("executor levels: a quick stop is no later than a hold, also where one waits for its brake",
          "[executor-levels]") {
  constexpr double share = 2;
  const MillBlocks blocks = blocks_of(rows(2, 50));
  // s from a hold to rest; so many ticks behind it a quick stop is asked for, none if that is below 0.
  const auto hold = [&](double at, int quick) {
    const auto executor = runner({.level = SmoothLevel::good, .quick_stop_share = share});
    std::size_t fed = 0;
    std::array<Vector3, 4> p;
    p.fill(Vector3::Zero());
    double acceleration = 0, jerk = 0;
    int tick = 0, asked = static_cast<int>(at / period);
    for (; tick < asked || executor->state() != ExecutorState::held; ++tick) {
      REQUIRE(tick < asked + 5000);
      feed(*executor, blocks, fed);
      if (tick == asked) executor->feed_hold();
      if (quick >= 0 && tick == asked + quick) executor->quick_stop();
      p = {executor->tick(period).position, p[0], p[1], p[2]};
      acceleration = std::max(acceleration, (p[0] - 2 * p[1] + p[2]).norm());
      jerk = std::max(jerk, (p[0] - 3 * p[1] + 3 * p[2] - p[3]).norm());
    }
    const double most = quick < 0 ? 1 : share;
    CHECK(acceleration <= most * mill.limits.acceleration * period * period * (1 + 1e-5));
    CHECK(jerk <= most * mill.limits.jerk * period * period * period * (1 + 1e-3));
    return (tick - asked) * period;
  };
  for (double at = 0.1; at < 1.2; at += 0.21) {
    INFO("hold at " << at);
    const double held = hold(at, -1);
    for (const int quick : {0, 2, 8}) CHECK(hold(at, quick) <= held + 1.5 * period);
  }
}

TEST_CASE("executor levels: single steps and a pause rest just before the next block", "[executor-levels]") {
  const MillBlocks blocks = blocks_of("F1800 G1 X20\nX30 Y10\nX30 Y30\nX10\n");
  const LevelExecutorOptions good{.level = SmoothLevel::good};
  const auto executor = std::make_unique<Runner>(mill, good);
  std::size_t fed = 0;
  feed(*executor, blocks, fed);
  executor->single_step(true);
  int pauses = 0;
  for (int tick = 0; !executor->finished() && tick < 20000; ++tick) {
    const auto point = executor->tick(period);
    if (executor->state() != ExecutorState::held) continue;
    ++pauses;
    const auto& path = blocks[static_cast<std::size_t>(pauses) - 1].path;
    CHECK((path.position_at(path.length()) - point.position).norm() < 0.3);  // 10 ms at 30 mm/s
    executor->resume();
  }
  CHECK(executor->finished());
  CHECK(pauses == 3);

  const auto paused = std::make_unique<Runner>(mill, good);
  fed = 0;
  feed(*paused, blocks, fed);
  paused->pause_at(3);
  int held = 0;
  for (int tick = 0; !paused->finished() && tick < 20000; ++tick) {
    const auto point = paused->tick(period);
    if (paused->state() != ExecutorState::held) continue;
    ++held;
    CHECK((Vector3(30, 10, 0) - point.position).norm() < 0.3);
    paused->resume();
  }
  CHECK(held == 1);
}

TEST_CASE("executor levels: single steps rest once before every block, however hard braking is there",
          "[executor-levels]") {
  Random random;
  for (int run = 0; run < 6; ++run) {
    std::string text = "F" + std::to_string(random.uniform(600, 3000));
    const int count = random.integer(4, 9);
    double x = 0, y = 0;
    for (int i = 0; i < count; ++i) {
      x += random.uniform(4, 20), y += random.uniform(-15, 15);
      text += (random.integer(0, 2) > 0 ? "G1 X" : "G3 R40 X") + std::to_string(x) + " Y" +
              std::to_string(y) + "\n";
    }
    INFO(text);
    const MillBlocks blocks = blocks_of(text);
    const auto executor = std::make_unique<Runner>(mill, LevelExecutorOptions{.level = SmoothLevel::good});
    std::size_t fed = 0;
    feed(*executor, blocks, fed);
    executor->single_step(true);
    std::size_t pauses = 0;
    for (int tick = 0; !executor->finished() && tick < 60000; ++tick) {
      const auto point = executor->tick(period);
      if (executor->state() != ExecutorState::held) continue;
      REQUIRE(pauses < blocks.size());
      const auto& path = blocks[pauses++].path;
      const double least = 2 * std::sqrt(blocks[0].feed / mill.limits.jerk);  // s, to brake
      CHECK((path.position_at(path.length()) - point.position).norm() < blocks[0].feed * least / 2);
      executor->resume();
    }
    CHECK(executor->finished());
    CHECK(pauses + 1 == blocks.size());
  }
}

TEST_CASE("executor levels: back to the last rest, and on", "[executor-levels]") {
  const MillBlocks blocks = blocks_of("F1800 G1 X20\nG4 P0.1\nX30 Y10\nX30 Y30\nX10\n");
  const auto executor = runner();
  std::size_t fed = 0;
  feed(*executor, blocks, fed);
  for (int tick = 0; tick < 2000; ++tick) executor->tick(period);
  executor->reverse(true);
  for (int tick = 0; tick < 4000; ++tick) executor->tick(period);
  CHECK(executor->tick(period).position.norm() < 1e-9);
  CHECK_FALSE(executor->finished());
  executor->reverse(false);
  for (int tick = 0; tick < 10000 && !executor->finished(); ++tick) executor->tick(period);
  CHECK(executor->finished());
  CHECK((executor->tick(period).position - Vector3(10, 30, 0)).norm() < 1e-9);
}

TEST_CASE("executor levels: a share of the feed acts at once below 1, on blocks that come above it",
          "[executor-levels]") {
  std::string text = "F600\n";  // 10 mm/s
  for (int i = 1; i <= 600; ++i)
    text += "G1 X" + std::to_string(0.5 * i) + " Y" + std::to_string(0.2 * std::sin(0.1 * i)) + "\n";
  text += "G0 X310\n";
  const MillBlocks blocks = blocks_of(text);
  const auto executor = runner();
  std::size_t fed = 0;
  std::vector<Vector3> places;
  const auto drive = [&](double seconds, auto&& look) {
    for (int i = 0; i * period < seconds && !executor->finished(); ++i) {
      feed(*executor, blocks, fed);
      const auto point = executor->tick(period);
      places.push_back(point.position);
      look(point.velocity.norm());
    }
  };
  double most = 0, last = 0;
  const auto watch = [&](double speed) { most = std::max(most, last = speed); };
  drive(2, watch);
  CHECK(most == Approx(10).epsilon(1e-3));
  test::Random random;
  for (int i = 0; i < 1500; ++i) {  // more changes than are kept at once
    executor->feed_override(random.uniform(1.05, 1.3));
    drive(2 * period, watch);
  }
  executor->feed_override(1.5);
  drive(10, watch);
  CHECK(most == Approx(15).epsilon(1e-3));
  CHECK(last == Approx(15).epsilon(0.015));  // a little less where the run is cut
  executor->feed_override(0.8);
  drive(0.3, [](double) {});
  most = 0;
  drive(12, watch);  // through blocks that are planned at 1.5 times the feed, and others
  CHECK(most <= 8 * (1 + 1e-6));
  CHECK(last == Approx(8).epsilon(1e-3));
  executor->feed_override(7);  // as 2
  most = 0;
  drive(600, watch);
  CHECK(executor->finished());
  CHECK(most > 20 * (1 - 1e-3));
  Vector3 jerk = Vector3::Zero();
  for (std::size_t i = 3; i < places.size(); ++i)
    jerk = jerk.cwiseMax((places[i] - 3 * places[i - 1] + 3 * places[i - 2] - places[i - 3]).cwiseAbs());
  CHECK(jerk.maxCoeff() <= 1e4 * period * period * period * (1 + 1e-4));
}

TEST_CASE("executor levels: a share of the feed above 1 acts within seconds, however many blocks are held",
          "[executor-levels]") {
  Machine<3> machine = with_axes();
  machine.limits.velocity = 60;
  for (auto& axis : machine.axes) axis.velocity = 60;
  for (const double length : {2.0, 12.0}) {
    std::string text = "F1200\n";
    for (int i = 1; i <= (length < 5 ? 300 : 60); ++i)
      text += "G1 X" + std::to_string(length * i) + " Y" + std::to_string(0.03 * length * (i % 3)) + "\n";
    const MillBlocks blocks = blocks_of(text, machine);
    const auto executor = std::make_unique<Executor<Machine<3>, 300>>(
        machine, LevelExecutorOptions{.level = SmoothLevel::good});
    std::size_t fed = 0;
    double most = 0;
    const auto drive = [&](double seconds) {
      double last = 0;
      for (int i = 0; i * period < seconds && !executor->finished(); ++i) {
        feed(*executor, blocks, fed);
        const auto point = executor->tick(period);
        last = point.velocity.norm();
        most = std::max(most, last);
        if (last > 0) CHECK(point.feed == Approx(20));
      }
      return last;
    };
    CAPTURE(length);
    drive(1);
    CHECK(most == Approx(20).epsilon(1e-3));
    executor->feed_override(1.5);
    drive(6);
    CHECK(most == Approx(30).epsilon(1e-2));
    executor->feed_override(1.2);  // at once
    drive(0.3);
    CHECK(drive(0.2) < 24 * (1 + 1e-6));
    executor->feed_override(1.8);
    drive(7);
    CHECK(most > 35);
    executor->feed_override(1);
    run_to_end(*executor, {});
    CHECK(executor->finished());
    CHECK_FALSE(executor->error());
    CHECK((executor->tick(period).position - blocks.back().path.position_at(blocks.back().path.length()))
              .norm() < 1e-9);
  }
}

TEST_CASE("executor levels: half of the feed takes twice the time", "[executor-levels]") {
  const MillBlocks blocks = blocks_of("F1800 G1 X20\nX30 Y10\nX30 Y30\nX10\n");
  const auto time_at = [&](double share) {
    const auto executor = runner();
    executor->feed_override(share);
    return run_to_end(*executor, blocks);
  };
  CHECK(time_at(0.5) == Approx(2 * time_at(1)).margin(3 * period));
}

TEST_CASE("executor levels: a block that is refused ends the motion where it begins", "[executor-levels]") {
  MillBlocks blocks = blocks_of("F1800 G1 X20\nX30 Y10\n");
  MillBlock apart = blocks.back();
  apart.path = path::Line<3>(Vector3(5, 5, 5), Vector3(6, 5, 5));
  apart.line = 77;
  blocks.push_back(apart);
  const auto executor = runner();
  run_to_end(*executor, blocks, 20);
  REQUIRE(executor->error());
  CHECK(executor->error()->error().code == ErrorCode::discontinuous);
  CHECK(executor->error()->about.line == 77);
  CHECK(executor->state() == ExecutorState::fault);
  CHECK((executor->tick(period).position - Vector3(30, 10, 0)).norm() < 1e-9);
  // It begins anew on a line, and goes to its start first.
  blocks.pop_back();
  REQUIRE(executor->restart(2, Vector3(30, 10, 0)));
  run_to_end(*executor, blocks, 20);
  CHECK(executor->finished());
  CHECK_FALSE(executor->error());
  CHECK((executor->tick(period).position - Vector3(30, 10, 0)).norm() < 1e-9);
}

TEST_CASE("executor levels: a tick allocates nothing where blocks are planned elsewhere",
          "[executor-levels]") {
  const MillBlocks blocks = blocks_of(rows(6, 50));
  const auto executor = runner({.level = SmoothLevel::good, .background = true});
  std::size_t fed = 0, allocations = 0;
  for (int tick = 0; !executor->finished() && tick < 100000; ++tick) {
    feed(*executor, blocks, fed);
    executor->plan();
    if (tick == 1000) executor->feed_hold();
    if (tick == 1500) REQUIRE(executor->jog_to({1, 1, 1}));
    if (tick == 2500) executor->resume();
    allocations += heap_allocations_of([&] { executor->tick(period); });
  }
  CHECK(executor->finished());
  CHECK(allocations == 0);
}

TEST_CASE("executor levels: all memory is that of a resource that it is given", "[executor-levels]") {
  const MillBlocks blocks = blocks_of(rows(6, 50));
  std::vector<std::byte> room(64 << 20);
  std::pmr::monotonic_buffer_resource all(room.data(), room.size(), std::pmr::null_memory_resource());
  std::pmr::unsynchronized_pool_resource memory({0, 4 << 20}, &all);  // what is given back is used again
  const auto executor =
      std::make_unique<Runner>(mill, LevelExecutorOptions{.level = SmoothLevel::good}, &memory);
  const auto allocations = heap_allocations_of([&] { run_to_end(*executor, blocks); });
  CHECK(executor->finished());
  CHECK_FALSE(executor->error());
  CHECK(allocations == 0);
}

TEST_CASE("executor levels: one thread pushes and plans, another one ticks", "[executor-levels]") {
  const MillBlocks blocks = blocks_of(rows(10, 50));
  const auto executor = runner({.level = SmoothLevel::good, .background = true});
  std::atomic<bool> over = false;
  std::thread planner([&] {
    std::size_t fed = 0;
    while (!over) {
      feed(*executor, blocks, fed);
      executor->plan();
      std::this_thread::yield();
    }
  });
  test::Random random;
  std::array<Vector3, 4> p;
  p.fill(Vector3::Zero());
  double jerk = 0;
  long ticks = 0;
  for (; !executor->finished() && ticks < 400000; ++ticks) {
    if (random.integer(0, 300) == 0) executor->feed_override(random.uniform(0.2, 1));
    if (random.integer(0, 500) == 0) executor->feed_hold();
    if (random.integer(0, 100) == 0) executor->resume();
    p = {executor->tick(period).position, p[0], p[1], p[2]};
    jerk = std::max(jerk, (p[0] - 3 * p[1] + 3 * p[2] - p[3]).norm());
    if (executor->state() == ExecutorState::waiting)  // however slow the other thread is
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  over = true;
  planner.join();
  CHECK(executor->finished());
  CHECK(jerk <= 10000 * period * period * period * (1 + 1e-3));
  CHECK((p[0] - blocks.back().path.position_at(blocks.back().path.length())).norm() < 1e-9);
}

TEST_CASE("executor levels: options that are none run nothing, and that is told", "[executor-levels]") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const MillBlocks blocks = blocks_of("F1800 G1 X20\n");
  const auto refused = [&](const auto& options, std::string_view field) {
    CAPTURE(field);
    const auto executor = std::make_unique<Runner>(mill, options);
    run_to_end(*executor, blocks, 2);
    REQUIRE(executor->error());
    CHECK(executor->error()->error().field == field);
    CHECK(executor->state() == ExecutorState::fault);
    CHECK(executor->tick(period).position.norm() == 0);
    CHECK(executor->restart(0, Vector3::Zero()));
    run_to_end(*executor, blocks, 2);
    CHECK(executor->error());
    CHECK(executor->tick(period).position.norm() == 0);
  };
  for (const SmoothLevel level : {SmoothLevel::fast, SmoothLevel::good}) {
    for (const double reserve : {-0.5, 1.0, 2.0, nan})
      refused(LevelExecutorOptions{.level = level, .reserve = reserve}, "reserve");
    for (const double tolerance : {-1.0, nan})
      refused(LevelExecutorOptions{.tolerance = tolerance, .level = level}, "tolerance");
  }
  refused(ExecutorOptions{.tolerance = nan}, "tolerance");
  refused(ExecutorOptions{.rotary_tolerance = 0}, "rotary tolerance");
  refused(ExecutorOptions{.junction_deviation = -1}, "junction deviation");
}

TEST_CASE("executor levels: no time of a long tick is lost", "[executor-levels]") {
  std::string text = "F1800 G61.1\n";
  for (int i = 1; i <= 20; ++i) text += "G1 X" + std::to_string(i) + "\n";
  const MillBlocks blocks = blocks_of(text);
  const auto executor = runner();
  std::size_t fed = 0;
  feed(*executor, blocks, fed);
  executor->tick(10);  // 20 rests on the way
  CHECK(executor->finished());
  CHECK((executor->tick(period).position - Vector3(20, 0, 0)).norm() < 1e-9);
}

TEST_CASE("executor levels: a part comes while the rate changes", "[executor-levels]") {
  // The first part with its way to rest is there; a change of the rate begins, and then the next part comes.
  // Wherever the cut is, one of these changes leads beyond it.
  const MillBlocks blocks = blocks_of(rows(10, 50));
  for (const auto& [before, behind] : {std::pair(0.3, 1.0), std::pair(1.0, 0.2)}) {
    CAPTURE(before, behind);
    double acceleration = 0, jerk = 0, latest = 0;
    for (double at = 0.02; at < 2 / before; at += 0.01) {
      const auto executor = runner({.level = SmoothLevel::good,
                                    .longest_wait = 1e9,
                                    .background = true,
                                    .reserve = 0,
                                    .hold_factor = 0});
      std::size_t fed = 0;
      while (fed < 65 && executor->push(blocks[fed])) ++fed;  // one more than are held
      executor->feed_override(before);
      std::array<Vector3, 4> p;
      p.fill(Vector3::Zero());
      for (double t = 0; t < at + 0.5; t += period) {
        if (std::abs(t - at) < period / 2) executor->feed_override(behind);
        if (std::abs(t - at - 0.01) < period / 2) {
          if (p[0] != p[1]) latest = at;
          feed(*executor, blocks, fed);
          executor->plan();
        }
        p = {executor->tick(period).position, p[0], p[1], p[2]};
        acceleration = std::max(acceleration, (p[0] - 2 * p[1] + p[2]).norm() / (period * period));
        jerk = std::max(jerk, (p[0] - 3 * p[1] + 3 * p[2] - p[3]).norm() / (period * period * period));
      }
    }
    CAPTURE(latest);
    CHECK(latest < 1.9 / before);  // it came to rest: the cut was passed
    CHECK(acceleration <= 1000 * (1 + 1e-4));
    CHECK(jerk <= 10000 * (1 + 1e-3));
  }
}

TEST_CASE("executor levels: step edges are where the axes are, at every tick", "[executor-levels]") {
  const MillBlocks blocks = blocks_of("F1800\nG1 X10\nX20 Y1\nG4 P0.2\nG3 X30 Y11 J10\nG1 Y20\nX10\nX0 Y0\n");
  Machine<3> machine = with_axes();
  for (auto& axis : machine.axes) axis.motors = {step::Drive{.steps_per_unit = 200}};
  for (const SmoothLevel level : {SmoothLevel::fast, SmoothLevel::good, SmoothLevel::best}) {
    CAPTURE(to_text(level));
    const auto executor = std::make_unique<Runner>(machine, LevelExecutorOptions{.level = level});
    LiveSteps steps(*executor);
    std::array<long, 3> counts{};
    std::size_t fed = 0;
    double last = 0, worst = 0;
    bool in_order = true;
    for (int tick = 0; !executor->finished() && tick < 40000; ++tick) {
      feed(*executor, blocks, fed);
      if (tick % 333 == 100) executor->feed_hold();
      if (tick % 333 == 250) executor->resume();
      const auto point = steps.tick(period);
      while (const auto edge = steps.next()) {
        counts[static_cast<std::size_t>(edge->axis)] += edge->direction;
        in_order = in_order && edge->time >= last;
        last = edge->time;
      }
      for (std::size_t i = 0; i < 3; ++i)
        worst = std::max(worst, std::abs(static_cast<double>(counts[i]) -
                                         200 * point.position[static_cast<Eigen::Index>(i)]));
    }
    CHECK(executor->finished());
    CHECK(in_order);
    CHECK(worst <= 0.5 + 1e-6);
  }
}
