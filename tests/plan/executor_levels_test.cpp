// Executors at the levels good and best: limits by differences, the path by brute force, words, dwells.
#include "cncplan/executor_levels.hpp"

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

#include "cncplan/live_steps.hpp"
#include "cncplan/plan_program.hpp"
#include "plan/at_level.hpp"
#include "plan/level_runner.hpp"
#include "plan/live_run.hpp"
#include "plan/rows_program.hpp"
#include "soak/smooth_program.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"

using namespace cncplan;
using namespace cncplan::test;

namespace {

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
  const MillBlocks blocks =
      blocks_of_text("F1800 G1 X10\nX10.7 Y0.7\nX11.4 Y0\nX20\nX20.5 Y0.5\nX21 Y0\nX30\n");
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
  CHECK(last == Approx(whole->duration()).margin(2 * tick_time));
  const auto best = runner({.level = SmoothLevel::best, .reserve = 0, .hold_factor = 0});
  const auto whole_best = plan_blocks(blocks, with_axes(), at_level(SmoothLevel::best, within));
  CHECK(run_to_end(*best, blocks) == Approx(whole_best->duration()).margin(5 * tick_time));
}

TEST_CASE("executor levels: a part behind a cut that comes up to its feed is no slower for it",
          "[executor-levels]") {
  Machine<3> machine = mill;
  machine.limits = {.velocity = 30, .acceleration = 3000, .jerk = 10000};
  machine.axes[2].acceleration = 300;
  std::string text = "G0 Z5\nF600\nG1 Y4\nG91\n";
  for (int i = 0; i < 3; ++i) text += "G1 X1\nX0.2 Z0.3\n";
  const auto program =
      read_text(text + "G90\nX-1 Y0 Z1\nG0 X10\nG1 X-7 Z-25\nG0 Z1\n", machine, {.tolerance = 0.01});
  REQUIRE_FALSE(program.failed());
  const auto whole = plan_blocks(program.blocks(), machine,
                                 {.tolerance = 0.01, .level = SmoothLevel::good, .hold_factor = 1.5});
  REQUIRE(whole);
  Executor<Machine<3>, 64> executor(machine,
                                    LevelExecutorOptions{.tolerance = 0.01, .level = SmoothLevel::good});
  const MillBlocks blocks(program.blocks().begin(), program.blocks().end());
  CHECK(run_to_end(executor, blocks) < 1.01 * whole->duration());
}

TEST_CASE("executor levels: a long run in parts goes through the cuts, within limits and tolerance",
          "[executor-levels]") {
  const MillBlocks blocks = blocks_of_text(rows(12, 50));
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
  const MillBlocks blocks = blocks_of_text(rows(6, 50));
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
      const auto point = executor->tick(tick_time);
      p = {point.position, p[0], p[1], p[2]};
      CHECK((p[0] - 2 * p[1] + p[2]).norm() <= 1000 * tick_time * tick_time * (1 + 1e-5));
      CHECK((p[0] - 3 * p[1] + 3 * p[2] - p[3]).norm() <=
            10000 * tick_time * tick_time * tick_time * (1 + 1e-3));
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
    CHECK((executor->tick(tick_time).position - blocks.back().path.position_at(blocks.back().path.length()))
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
    const LiveBlocks blocks = live_blocks(text, c.machine, {.tolerance = c.tolerance});
    REQUIRE_FALSE(blocks.empty());
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
  const MillBlocks blocks = blocks_of_text("G21 G90 F1200\nG1 X20\nG4 P0.2\nG1 Y20\nG1 X0\nM30\n");
  const auto executor = runner();
  std::size_t fed = 0;
  feed(*executor, blocks, fed);
  std::vector<std::string_view> states;
  for (int tick = 0; !executor->finished() && tick < 60000; ++tick) {
    if (tick == 1800) executor->feed_hold();
    if (tick == 2400) REQUIRE(executor->jog_to({10, 10, 5}));
    if (tick == 5000) executor->resume();
    executor->tick(tick_time);
    if (const auto now = to_text(executor->state()); states.empty() || states.back() != now)
      states.push_back(now);
  }
  CHECK(states == std::vector<std::string_view>{"moving", "dwelling", "moving", "holding", "held", "jogging",
                                                "away", "jogging", "moving", "finished"});
}

TEST_CASE("executor levels: a block that is refused ends the motion where it begins", "[executor-levels]") {
  MillBlocks blocks = blocks_of_text("F1800 G1 X20\nX30 Y10\n");
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
  CHECK((executor->tick(tick_time).position - Vector3(30, 10, 0)).norm() < 1e-9);
  // It begins anew on a line, and goes to its start first.
  blocks.pop_back();
  REQUIRE(executor->restart(2, Vector3(30, 10, 0)));
  run_to_end(*executor, blocks, 20);
  CHECK(executor->finished());
  CHECK_FALSE(executor->error());
  CHECK((executor->tick(tick_time).position - Vector3(30, 10, 0)).norm() < 1e-9);
}

TEST_CASE("executor levels: a tick allocates nothing where blocks are planned elsewhere",
          "[executor-levels]") {
  const MillBlocks blocks = blocks_of_text(rows(6, 50));
  const auto executor = runner({.level = SmoothLevel::good, .background = true});
  std::size_t fed = 0, allocations = 0;
  for (int tick = 0; !executor->finished() && tick < 100000; ++tick) {
    feed(*executor, blocks, fed);
    executor->plan();
    if (tick == 1000) executor->feed_hold();
    if (tick == 1500) REQUIRE(executor->jog_to({1, 1, 1}));
    if (tick == 2500) executor->resume();
    allocations += heap_allocations_of([&] { executor->tick(tick_time); });
  }
  CHECK(executor->finished());
  CHECK(allocations == 0);
}

TEST_CASE("executor levels: all memory is that of a resource that it is given", "[executor-levels]") {
  const MillBlocks blocks = blocks_of_text(rows(6, 50));
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
  const MillBlocks blocks = blocks_of_text(rows(10, 50));
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
    p = {executor->tick(tick_time).position, p[0], p[1], p[2]};
    jerk = std::max(jerk, (p[0] - 3 * p[1] + 3 * p[2] - p[3]).norm());
    if (executor->state() == ExecutorState::waiting)  // however slow the other thread is
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  over = true;
  planner.join();
  CHECK(executor->finished());
  CHECK(jerk <= 10000 * tick_time * tick_time * tick_time * (1 + 1e-3));
  CHECK((p[0] - blocks.back().path.position_at(blocks.back().path.length())).norm() < 1e-9);
}

TEST_CASE("executor levels: options that are none run nothing, and that is told", "[executor-levels]") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const MillBlocks blocks = blocks_of_text("F1800 G1 X20\n");
  const auto refused = [&](const auto& options, std::string_view field) {
    CAPTURE(field);
    const auto executor = std::make_unique<Runner>(mill, options);
    run_to_end(*executor, blocks, 2);
    REQUIRE(executor->error());
    CHECK(executor->error()->error().field == field);
    CHECK(executor->state() == ExecutorState::fault);
    CHECK(executor->tick(tick_time).position.norm() == 0);
    CHECK(executor->restart(0, Vector3::Zero()));
    run_to_end(*executor, blocks, 2);
    CHECK(executor->error());
    CHECK(executor->tick(tick_time).position.norm() == 0);
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
  const MillBlocks blocks = blocks_of_text(text);
  const auto executor = runner();
  std::size_t fed = 0;
  feed(*executor, blocks, fed);
  executor->tick(10);  // 20 rests on the way
  CHECK(executor->finished());
  CHECK((executor->tick(tick_time).position - Vector3(20, 0, 0)).norm() < 1e-9);
}

TEST_CASE("executor levels: a part comes while the rate changes", "[executor-levels]") {
  // The first part with its way to rest is there; a change of the rate begins, and then the next part comes.
  // Wherever the cut is, one of these changes leads beyond it.
  const MillBlocks blocks = blocks_of_text(rows(10, 50));
  for (const auto& [before, behind] : {std::pair(0.3, 1.0), std::pair(1.0, 0.2)}) {
    CAPTURE(before, behind);
    double acceleration = 0, jerk = 0, latest = 0;
    for (double at = 0.02; at < 2 / before; at += 0.02) {
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
      for (double t = 0; t < at + 0.5; t += tick_time) {
        if (std::abs(t - at) < tick_time / 2) executor->feed_override(behind);
        if (std::abs(t - at - 0.01) < tick_time / 2) {
          if (p[0] != p[1]) latest = at;
          feed(*executor, blocks, fed);
          executor->plan();
        }
        p = {executor->tick(tick_time).position, p[0], p[1], p[2]};
        acceleration = std::max(acceleration, (p[0] - 2 * p[1] + p[2]).norm() / (tick_time * tick_time));
        jerk =
            std::max(jerk, (p[0] - 3 * p[1] + 3 * p[2] - p[3]).norm() / (tick_time * tick_time * tick_time));
      }
    }
    CAPTURE(latest);
    CHECK(latest < 1.9 / before);  // it came to rest: the cut was passed
    CHECK(acceleration <= 1000 * (1 + 1e-4));
    CHECK(jerk <= 10000 * (1 + 1e-3));
  }
}

TEST_CASE("executor levels: step edges are where the axes are, at every tick", "[executor-levels]") {
  const MillBlocks blocks =
      blocks_of_text("F1800\nG1 X10\nX20 Y1\nG4 P0.2\nG3 X30 Y11 J10\nG1 Y20\nX10\nX0 Y0\n");
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
      const auto point = steps.tick(tick_time);
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
