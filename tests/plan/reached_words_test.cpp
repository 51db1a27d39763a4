// Where in a tick a word is reached, and what feed a set point tells, at every door that ticks.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "cncplan/executor_levels.hpp"
#include "cncplan/plan_program.hpp"
#include "cncplan/trajectory_executor.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

constexpr Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
using Runner = Executor<Machine<3>, 64>;

Block<3> line(double from, double to, double feed) {
  return {.path = path::Line<3>({from, 0, 0}, {to, 0, 0}), .feed = feed};
}
Block<3> word(double at, double number) {
  Block<3> block = line(at, at, 20);
  block.word = {.letter = 'M', .number = number};
  return block;
}

// Words at 3.7 mm while it moves, at 8 mm behind a rest of 12.3 ms, and at the end, 12.2 mm.
std::vector<Block<3>> program() {
  std::vector<Block<3>> blocks{line(0, 3.7, 20), word(3.7, 62), line(3.7, 8, 20)};
  Block<3> rest = line(8, 8, 20);
  rest.exact_stop = true;
  rest.pause = 0.0123;
  blocks.push_back(rest);
  blocks.push_back(word(8, 63));
  blocks.push_back(line(8, 12.2, 11));
  blocks.back().exact_stop = true;
  blocks.push_back(word(12.2, 64));
  return blocks;
}

struct Told {
  double number{}, time{};
};

// Whole ticks of one executor, and the words that it tells.
template <class E>
std::vector<Told> told(E& executor, double period) {
  std::vector<Told> words;
  double start = 0;
  for (int tick = 0; tick < 1'000'000 && !executor.finished(); ++tick, start += period)
    for (const auto& reached : executor.tick(period).words) {
      REQUIRE(reached.in_tick >= 0);
      REQUIRE(reached.in_tick <= period);
      words.push_back({reached.number, start + reached.in_tick});
    }
  REQUIRE(executor.finished());
  return words;
}

// s, when it passes 3.7 mm, goes on from 8 mm, and comes to 12.2 mm.
struct Passed {
  double middle{}, leaves{}, end{};
};

// By the parts of the ticks of another executor that does the same.
Passed passed(Runner& executor, double period) {
  Passed result;
  double start = 0;
  for (int tick = 0; tick < 1'000'000 && !executor.finished(); ++tick, start += period)
    (void)executor.tick(period, [&](const Runner::Core::Part& part) {
      const double length = part.length();
      const auto x = [&](double seconds) { return part.position(seconds).x(); };
      if (x(0) < 3.7 && x(length) >= 3.7) {
        double low = 0, high = length;
        for (int i = 0; i < 60; ++i) (x((low + high) / 2) < 3.7 ? low : high) = (low + high) / 2;
        result.middle = start + part.start() + high;
      }
      if (x(0) <= 8 + 1e-9 && x(length) > 8 + 1e-9) result.leaves = start + part.start();
      result.end = start + part.start() + length;
    });
  return result;
}
// By many short ticks.
Passed passed(TrajectoryExecutor<Machine<3>, Block<3>>& executor, double) {
  constexpr double tick = 1e-6;
  Passed result;
  double before = 0;
  for (long i = 0; i < 10'000'000 && !executor.finished(); ++i) {
    const double x = executor.tick(tick).position.x(), start = static_cast<double>(i) * tick;
    if (before < 3.7 && x >= 3.7) result.middle = start + tick * (3.7 - before) / (x - before);
    if (before <= 8 && x > 8) result.leaves = start;
    if (x > before) result.end = start + tick;
    before = x;
  }
  return result;
}

template <class Make>
void check(double rounding, Make&& make) {
  for (const double period : {1e-3, 7.3e-3, 0.05}) {
    CAPTURE(period);
    const std::vector<Told> words = told(*make(), period);
    const Passed at = passed(*make(), period);
    REQUIRE(words.size() == 3);
    CHECK(words[0].number == 62);
    CHECK(words[0].time == Approx(at.middle).margin(2e-6));
    CHECK(words[1].number == 63);
    CHECK(words[1].time == Approx(at.leaves).margin(rounding));
    CHECK(words[2].number == 64);
    CHECK(words[2].time == Approx(at.end).margin(rounding));
  }
}

std::unique_ptr<Runner> executor(SmoothLevel level, double tolerance, double share) {
  auto result = std::make_unique<Runner>(mill, LevelExecutorOptions{.tolerance = tolerance, .level = level});
  for (const auto& block : program()) REQUIRE(result->push(block));
  result->end_of_program();
  result->feed_override(share);
  return result;
}

}  // namespace

TEST_CASE("a word is told with the instant in the tick at which it is reached") {
  for (const double share : {1.0, 0.7}) {
    CAPTURE(share);
    SECTION("exact") {
      check(1e-9, [&] { return executor(SmoothLevel::exact, 0, share); });
    }
    SECTION("fast") {
      check(1e-9, [&] { return executor(SmoothLevel::fast, 0.01, share); });
    }
    SECTION("good") {
      check(1e-9, [&] { return executor(SmoothLevel::good, 0.01, share); });
    }
    SECTION("best") {
      check(1e-9, [&] { return executor(SmoothLevel::best, 0.01, share); });
    }
    SECTION("a planned trajectory") {
      const auto planned = plan_blocks(program(), mill, {.level = SmoothLevel::good});
      REQUIRE(planned);
      check(2e-4, [&] {  // it leaves, and comes to rest, as t^3
        auto result = std::make_unique<TrajectoryExecutor<Machine<3>, Block<3>>>(*planned, mill);
        result->feed_override(share);
        return result;
      });
    }
  }
}

TEST_CASE("the feed of a set point is the program's, whatever the override, and infinite for a rapid") {
  for (const SmoothLevel level : {SmoothLevel::fast, SmoothLevel::good}) {
    CAPTURE(level);
    const auto runner = std::make_unique<Runner>(mill, LevelExecutorOptions{.level = level});
    runner->feed_override(1.5);
    REQUIRE(runner->push(line(0, 10, 12)));
    Block<3> rapid = line(10, 20, 12);
    rapid.rapid = true;
    REQUIRE(runner->push(rapid));
    runner->end_of_program();
    double fastest = 0;
    for (int tick = 0; tick < 10'000 && !runner->finished(); ++tick) {
      const auto point = runner->tick(1e-3);
      if (!(point.velocity.x() > 0)) continue;
      if (point.block == 0) {
        REQUIRE(point.feed == Approx(12).epsilon(1e-12));
        fastest = std::max(fastest, point.along.velocity);
      } else {
        REQUIRE(point.feed == std::numeric_limits<double>::infinity());
      }
    }
    CHECK(fastest > 17);
  }
}
