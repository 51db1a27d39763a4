// How high an override of the feed may be, and how soon it acts, at every level of smoothing.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "cncplan/trajectory_executor.hpp"
#include "plan/level_runner.hpp"
#include "plan/rows_program.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace cncplan::test;

namespace {

constexpr double no_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

Machine<3> fast_machine() {
  Machine<3> machine = with_axes();
  machine.limits.velocity = 80;
  for (auto& axis : machine.axes) axis.velocity = 80;
  return machine;
}

// The highest speed to the end.
template <class E>
double top_speed(E& executor, const MillBlocks& blocks) {
  std::size_t fed = 0;
  double most = 0;
  for (int tick = 0; tick < 60'000 && !executor.finished(); ++tick) {
    feed(executor, blocks, fed);
    most = std::max(most, executor.tick(tick_time).velocity.norm());
  }
  CHECK(executor.finished());
  return most;
}

}  // namespace

TEST_CASE("executor overrides: a share of the feed is cut at the highest, at every door",
          "[executor-overrides]") {
  const Machine<3> machine = fast_machine();
  const MillBlocks blocks = blocks_of_text("F600\nG1 X200\nX400 Y1\n", machine);
  const auto planned = plan_blocks(blocks, machine, {.level = SmoothLevel::good, .hold_factor = 2});
  REQUIRE(planned);
  for (const double most : {1.0, 1.5, 2.0, 5.0}) {
    for (const double asked : {9.0, infinity}) {
      CAPTURE(most, asked);
      for (const SmoothLevel level :
           {SmoothLevel::exact, SmoothLevel::fast, SmoothLevel::good, SmoothLevel::best}) {
        CAPTURE(level);
        const auto executor =
            std::make_unique<Runner>(machine, LevelExecutorOptions{.level = level, .most_override = most});
        executor->feed_override(asked);
        CHECK(top_speed(*executor, blocks) == Approx(10 * most).epsilon(1e-3));
      }
      TrajectoryExecutor<Machine<3>, MillBlock> executor(*planned, machine, {.most_override = most});
      executor.feed_override(asked);
      CHECK(top_speed(executor, {}) == Approx(10 * most).epsilon(1e-3));
    }
  }
}

TEST_CASE("executor overrides: options out of their domain are refused", "[executor-overrides]") {
  const auto refuses = [](const LevelExecutorOptions& options, const std::string& field, ErrorCode code) {
    CAPTURE(field);
    Runner executor(mill, options);
    REQUIRE(executor.error());
    CHECK(executor.error()->error().field == field);
    CHECK(executor.error()->error().code == code);
    CHECK(executor.tick(tick_time).velocity.norm() == 0);
  };
  for (const SmoothLevel level : {SmoothLevel::fast, SmoothLevel::good}) {
    refuses({.level = level, .most_override = 0.9}, "highest override", ErrorCode::below_limit);
    refuses({.level = level, .most_override = no_number}, "highest override", ErrorCode::not_finite);
    refuses({.level = level, .most_override = infinity}, "highest override", ErrorCode::not_finite);
    refuses({.level = level, .horizon = 0}, "horizon", ErrorCode::not_positive);
    refuses({.level = level, .horizon = -1}, "horizon", ErrorCode::not_positive);
    refuses({.level = level, .horizon = no_number}, "horizon", ErrorCode::not_finite);
    refuses({.level = level, .horizon = infinity}, "horizon", ErrorCode::not_finite);
  }
  const auto planned = plan_blocks(blocks_of_text("F600\nG1 X10\n"), mill, {.level = SmoothLevel::good});
  REQUIRE(planned);
  const TrajectoryExecutor<Machine<3>, MillBlock> executor(*planned, mill, {.most_override = 0.5});
  CHECK(executor.error());
}

TEST_CASE("executor overrides: a higher feed is driven soon through bends, and limits are kept",
          "[executor-overrides]") {
  // Bends whose limits leave much room at the feed, but for a clock that only runs faster.
  const Machine<3> machine = fast_machine();
  std::string text = "F600\n";
  for (int i = 1; i < 900; ++i)
    text += "G1 X" + std::to_string(0.3 * i) + " Y" + std::to_string(2 * std::sin(0.12 * i)) + "\n";
  const MillBlocks blocks = blocks_of_text(text, machine);
  Random random;
  const int asked = static_cast<int>(random.integer(1500, 4000));
  CAPTURE(asked);
  // s from the request until the speed over some time is that which is asked for.
  const auto until_effect = [&](SmoothLevel level, double horizon) {
    const auto executor = std::make_unique<Executor<Machine<3>, 300>>(
        machine, LevelExecutorOptions{.level = level, .horizon = horizon});
    std::size_t fed = 0;
    std::array<Vector3, 4> p;
    p.fill(Vector3::Zero());
    double jerk = 0, acceleration = 0;
    int effect = 0, fast = 0;
    int tick = 0;
    for (; tick < 60'000 && !executor->finished(); ++tick) {
      feed(*executor, blocks, fed);
      if (tick == asked) executor->feed_override(2);
      p = {executor->tick(tick_time).position, p[0], p[1], p[2]};
      acceleration = std::max(acceleration, (p[0] - 2 * p[1] + p[2]).cwiseAbs().maxCoeff());
      jerk = std::max(jerk, (p[0] - 3 * p[1] + 3 * p[2] - p[3]).cwiseAbs().maxCoeff());
      fast = (p[0] - p[1]).norm() > 20 * 0.97 * tick_time ? fast + 1 : 0;
      if (effect == 0 && fast >= 200) effect = tick - fast - asked;
    }
    CHECK(executor->finished());
    CHECK_FALSE(executor->error());
    CHECK(acceleration <= 1000 * tick_time * tick_time * (1 + 1e-5));
    CHECK(jerk <= 1e4 * tick_time * tick_time * tick_time * (1 + 1e-4));
    CHECK((p[0] - blocks.back().path.position_at(blocks.back().path.length())).norm() < 1e-9);
    CHECK(effect > 0);
    return effect * tick_time;
  };
  for (const SmoothLevel level : {SmoothLevel::good, SmoothLevel::best})
    for (const double horizon : {0.3, 1.0, 5.0}) {
      CAPTURE(level, horizon);
      const double effect = until_effect(level, horizon);
      INFO("s until it has its effect " << effect);
      CHECK(effect <= horizon + 0.3);
    }
}

namespace {

struct Asked {
  int tick{};
  double feed = 1, rapid = 1;
  bool back = false;
};

// The most by which the speed on a block is above what is asked for it, from half a second behind the last
// request on. One block every other tick goes in, if that is wanted.
template <class Machine>
double excess(const Machine& machine, const LevelExecutorOptions& options, const std::string& text,
              const std::vector<Asked>& asked, bool slowly = false) {
  const MillBlocks blocks = blocks_of_text(text, machine);
  const auto executor = std::make_unique<Runner>(machine, options);
  std::size_t fed = 0;
  double worst = 0;
  int tick = 0;
  for (; tick < 40'000 && !executor->finished(); ++tick) {
    if (!slowly || tick % 2 == 0) {
      if (slowly && fed < blocks.size() && executor->push(blocks[fed])) ++fed;
      if (slowly && fed == blocks.size()) executor->end_of_program();
      if (!slowly) feed(*executor, blocks, fed);
    }
    const Asked* last = nullptr;
    for (const Asked& one : asked) {
      if (one.tick == tick) {
        executor->feed_override(one.feed);
        executor->rapid_override(one.rapid);
        executor->reverse(one.back);
      }
      if (one.tick <= tick) last = &one;
    }
    const auto point = executor->tick(tick_time);
    if (last == nullptr || last != &asked.back() || tick < last->tick + 500) continue;
    const MillBlock& block = blocks[point.block];
    const double share = block.rapid ? last->rapid : last->feed;
    const double most = share * (block.rapid ? machine.limits.velocity
                                             : std::min(block.feed, machine.limits.velocity / share));
    worst = std::max(worst, point.velocity.norm() - most);
    if (executor->rests() && last->back) break;
  }
  CHECK(tick < 40'000);
  CHECK_FALSE(executor->error());
  return worst;
}

}  // namespace

TEST_CASE("executor overrides: a lower feed or rapid behind a lowered override is begun at its own",
          "[executor-overrides]") {
  Machine<3> machine = fast_machine();
  machine.limits = {.velocity = 100, .acceleration = 2000, .jerk = 10000};
  for (auto& axis : machine.axes)
    axis = {.letter = axis.letter, .velocity = 100, .acceleration = 2000, .jerk = 10000};
  for (const SmoothLevel level : {SmoothLevel::fast, SmoothLevel::good, SmoothLevel::best})
    for (const double most : {2.0, 6.0})
      for (const double horizon : {0.3, 5.0})
        for (const bool slowly : {false, true}) {
          CAPTURE(level, most, horizon, slowly);
          const LevelExecutorOptions options{.level = level, .most_override = most, .horizon = horizon};
          CHECK(excess(machine, options, "F6000\nG1 X150\nF1000\nG1 X250\n", {{0, most}, {800, 1}}, slowly) <
                0.02);
          CHECK(excess(machine, options, "F6000\nG1 X300\nF1000\nG1 X350 Y1\n", {{0, most}, {500, 1}},
                       slowly) < 0.02);
          CHECK(excess(mill, options, "F600\nG1 X40\nG4 P0.1\nX80\n", {{0, most}, {300, 1}}, slowly) < 0.01);
          CHECK(excess(mill, options, "F1800\nG1 X60\nG0 X120\n", {{0, most, 0.2}, {800, 1, 0.2}}, slowly) <
                0.01);
          CHECK(excess(mill, options, "F1800\nG1 X60\nG0 X120\n", {{0, most, 0.55}, {800, 1, 0.55}}, slowly) <
                0.02);
        }
}

TEST_CASE("executor overrides: at each level the tool has the share of its feed where lines meet arcs",
          "[executor-overrides]") {
  // At the level fast the tool is up to 1.2 % faster there than along the programmed length.
  const std::string text = "F333\nG1 X3\nG3 X3.318 Y0.318 I0 J0.318\nG1 Y3.318\nG2 X4 Y4 I0.682 J0\nG1 X9\n";
  for (const SmoothLevel level : {SmoothLevel::fast, SmoothLevel::good, SmoothLevel::best})
    for (const double share : {0.3, 0.7, 1.0, 1.7}) {
      CAPTURE(level, share);
      CHECK(excess(mill, {.level = level}, text, {{0, share}}) < 1e-6);
    }
}

TEST_CASE("executor overrides: on the way back a block is come to at its own share", "[executor-overrides]") {
  for (const SmoothLevel level : {SmoothLevel::fast, SmoothLevel::good, SmoothLevel::best})
    for (const std::string end : {"G1 X70 Y5\n", "G1 X70\n"})
      for (const double share : {0.0, 0.1, 0.2, 0.6}) {
        CAPTURE(level, end, share);
        const LevelExecutorOptions options{.level = level};
        CHECK(excess(mill, options, "G0 X30\nF1800\nG1 X60\n" + end,
                     {{1400, 1, share}, {1600, 1, share, true}}) < 0.01);
        CHECK(excess(mill, options, "F1800\nG1 X30\nG0 X60\n" + end,
                     {{1400, share, 1}, {1600, share, 1, true}}) < 0.01);
        CHECK(excess(mill, options, "F600\nG1 X20\nF1800\nX60\n" + end, {{0, 2, 1}, {2600, 1, 1, true}}) <
              0.02);
      }
}

TEST_CASE("executor overrides: a lower feed is planned, and leaves corners and ramps their speed",
          "[executor-overrides]") {
  // Legs of 2 mm with turns of 60 degrees: most of the time goes into ramps.
  std::string legs;
  for (int i = 0; i < 100; ++i)
    legs += "G1 X" + std::to_string(1.7320508 * (i + 1)) + " Y" + std::to_string(i % 2 == 0 ? 1 : 0) + "\n";
  const Machine<3> machine = with_axes();
  const MillBlocks at_30 = blocks_of_text("F1800\n" + legs, machine),
                   at_12 = blocks_of_text("F720\n" + legs, machine);
  // s until the end; from a time on a share of the feed is asked for, from another one on all of it.
  const auto takes = [&](const MillBlocks& blocks, SmoothLevel level, double share = 1, double from = 0,
                         double until = 1e9) {
    const auto executor = std::make_unique<Executor<Machine<3>, 128>>(
        machine, LevelExecutorOptions{.level = level, .horizon = 1});
    std::size_t fed = 0;
    double time = 0, fastest = 0;
    for (; !executor->finished() && time < 300; time += tick_time) {
      executor->feed_override(time >= from && time < until ? share : 1);
      feed(*executor, blocks, fed);
      const double speed = executor->tick(tick_time).velocity.norm();
      if (time > from + 1 && time < until) fastest = std::max(fastest, speed);
    }
    CHECK(executor->finished());
    CHECK(fastest <= share * 30 + 1e-6);
    return time;
  };
  for (const SmoothLevel level : {SmoothLevel::fast, SmoothLevel::good}) {
    CAPTURE(level);
    const double whole = takes(at_30, level), slower = takes(at_12, level);
    INFO("s at the feed " << whole << ", at 0.4 of it by the program " << slower);
    CHECK(slower < 1.7 * whole);  // by the clock alone it takes 2.5 times as long
    CHECK(takes(at_30, level, 0.4) == Approx(slower).epsilon(2e-3));
    // In the middle of the program, and back.
    const double from = whole / 3, until = from + slower / 3;
    CHECK(takes(at_30, level, 0.4, from) <= whole / 3 + 2 * slower / 3 + 2);
    CHECK(takes(at_30, level, 0.4, from, until) <= 2 * whole / 3 + slower / 3 + 2);
  }
}

TEST_CASE(
    "executor overrides: two threads: set points tell the program's feed, while plans are made anew too",
    "[executor-overrides]") {
  Random random;
  const Machine<3> machine = fast_machine();
  std::string text = "F1200\n";
  for (int i = 1; i <= 150; ++i)
    text += "G1 X" + std::to_string(0.1 * i) + " Y" + std::to_string(0.1 * (i % 2)) + "\n";
  const MillBlocks blocks = blocks_of_text(text, machine);
  for (const SmoothLevel level : {SmoothLevel::good, SmoothLevel::best}) {
    CAPTURE(level);
    const auto executor = std::make_unique<Runner>(
        machine, LevelExecutorOptions{.level = level, .background = true, .horizon = 0.2});
    std::atomic<bool> over{false};
    std::thread planner([&] {
      std::size_t fed = 0;
      while (!over.load()) {
        feed(*executor, blocks, fed);
        executor->plan();
      }
    });
    long wrong = 0, moved = 0;
    // As fast as it can: parts come too late, and those before are driven to rest.
    const auto started = std::chrono::steady_clock::now();
    while (!executor->finished() && std::chrono::steady_clock::now() - started < std::chrono::minutes(2)) {
      if (random.integer(0, 50) == 0) executor->feed_override(random.uniform(0.2, 1.8));
      const auto point = executor->tick(tick_time);
      if (point.velocity.isZero()) continue;
      ++moved;
      wrong += std::abs(point.feed - 20) < 1e-9 ? 0 : 1;
    }
    over.store(true);
    planner.join();
    CHECK(executor->finished());
    CHECK(moved > 1000);
    CHECK(wrong == 0);
  }
}
