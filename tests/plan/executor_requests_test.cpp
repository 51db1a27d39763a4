// What is asked of an executor, one thing at a time.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "cncplan/executor.hpp"
#include "cncplan/plan_program.hpp"
#include "support/catch.hpp"
#include "support/executor_check.hpp"
#include "support/executor_machines.hpp"
#include "support/no_heap.hpp"
#include "support/random_runs.hpp"
#include "support/small_mill.hpp"

using namespace cncplan;
using test::Lines, test::load, test::tick_time, test::run, test::SmallRunner;

namespace {

constexpr Machine<3> mill = test::small_mill;

}  // namespace

TEST_CASE("without a program an executor is over once it is told so", "[executor]") {
  SmallRunner executor(mill);
  CHECK_FALSE(executor.finished());
  executor.end_of_program();
  CHECK(executor.finished());
  CHECK(executor.tick(tick_time).position.isZero());
  CHECK_FALSE(executor.error());
}

TEST_CASE("what was pushed is run to its end though nothing follows", "[executor]") {
  SmallRunner executor(mill);
  for (const auto& block : test::blocks_of({"G1 X5 F600"}, mill)) REQUIRE(executor.push(block));
  const auto point = run(executor, 2.0);
  CHECK(point.position[0] == 5.0);
  CHECK_FALSE(executor.finished());
  executor.end_of_program();
  CHECK(executor.finished());
}

TEST_CASE("a block that cannot be planned ends the motion before it, and is told", "[executor]") {
  SmallRunner executor(mill);
  auto blocks = test::blocks_of({"G1 X5 F600", "Y5", "X50", "Y0"}, mill);
  blocks[2].path = path::Line<3>({5, 5, 0}, {150, 5, 0});
  blocks[2].column = 4;
  for (int tick = 0; tick < 3; ++tick) executor.tick(tick_time);
  for (const auto& block : blocks) REQUIRE(executor.push(block));
  for (int i = 0; i < 100; ++i) REQUIRE(executor.push(blocks[3]));  // dropped: it never is full
  const auto point = run(executor);
  CHECK((point.position - Vector3(5, 5, 0)).norm() < 1e-12);
  REQUIRE(executor.error());
  CHECK(to_text(*executor.error()) == "3:4: error: axis X: 150 is above the limit 100");
  blocks[2].path = path::Line<3>({5, 5, 0}, {5, 6, 0});
  REQUIRE(executor.restart(0, point.position));
  CHECK_FALSE(executor.error());
  REQUIRE(executor.push(blocks[2]));
  executor.end_of_program();
  CHECK(run(executor).position[1] == 6.0);
}

TEST_CASE("a gap in the path, no feed and a bad machine are errors", "[executor]") {
  const auto code = [](const Machine<3>& machine, const Block<3>& block) {
    SmallRunner executor(machine);
    CHECK(executor.push({.path = path::Line<3>({0, 0, 0}, {1, 0, 0})}));
    CHECK(executor.push(block));
    executor.end_of_program();
    while (!executor.finished()) executor.tick(tick_time);
    REQUIRE(executor.error());
    return executor.error()->error().code;
  };
  CHECK(code(mill, {.path = path::Line<3>({2, 0, 0}, {3, 0, 0})}) == ErrorCode::discontinuous);
  CHECK(code(mill, {.path = path::Line<3>({1, 0, 0}, {3, 0, 0}), .feed = 0.0}) == ErrorCode::not_positive);
  const auto line = [](double to) { return path::Line<3>({1, 0, 0}, {to, 0, 0}); };
  CHECK(code(mill, {.path = line(NAN)}) == ErrorCode::not_finite);
  CHECK(code(mill, {.path = line(3), .feed = NAN}) == ErrorCode::not_finite);
  CHECK(code(mill, {.path = line(3), .pause = INFINITY}) == ErrorCode::not_finite);
  CHECK(code(mill, {.path = line(1), .pause = NAN}) == ErrorCode::not_finite);
  CHECK(code(mill, {.path = line(3), .pause = -1}) == ErrorCode::negative);
  auto bad = mill;
  bad.axes[1].jerk = -1;
  CHECK(code(bad, {.path = path::Line<3>({1, 0, 0}, {3, 0, 0})}) == ErrorCode::not_positive);
}

TEST_CASE("words are told where they stand, stops at rest", "[executor]") {
  SmallRunner executor(mill);
  load(executor, {"G1 X5 F1200", "M3 S1000", "X10", "M0", "X12", "T2 M6", "X14 M8", "M30"});
  std::string told;
  bool stops_at_rest = true, in_place = true;
  while (!executor.finished()) {
    const auto point = executor.tick(tick_time);
    if (executor.rested() > 0) executor.resume();  // at M0
    for (const auto& word : point.words) {
      told += word.letter + std::to_string(static_cast<int>(word.number)) + ' ';
      const bool stops =
          word.letter == 'T' || (word.letter == 'M' && (word.number == 0 || word.number == 30));
      if (stops) stops_at_rest = stops_at_rest && point.velocity.norm() < 0.02;
      if (word.letter == 'S')
        in_place = point.position[0] >= 5 && point.position[0] < 5.03 && point.velocity[0] > 19;
    }
  }
  CHECK(told == "S1000 M3 M0 T2 M6 M8 M30 ");
  CHECK(stops_at_rest);
  CHECK(in_place);
}

TEST_CASE("more words than a set point has room for come one after another", "[executor]") {
  Lines lines;
  for (int i = 0; i < 12; ++i) lines.push_back(i % 2 == 0 ? "M7" : "M9");
  SmallRunner executor(mill);
  load(executor, lines);
  int words = 0, ticks = 0;
  for (; !executor.finished() && ticks < 10; ++ticks)
    for (const auto& word : executor.tick(tick_time).words) CHECK(word.number == (words++ % 2 == 0 ? 7 : 9));
  CHECK(words == 12);
  CHECK(ticks == 2);
}

TEST_CASE(
    "M0 holds unless that is switched off, M1 where it is switched on, lines and blocks where it is asked",
    "[executor]") {
  const Lines lines{"G1 X5 F1200", "M0", "X10", "M1", "X15", "M60", "X20", "X25"};
  const auto places = [&](auto ask) {
    SmallRunner executor(mill);
    ask(executor);
    load(executor, lines);
    std::vector<double> held;
    for (int i = 0; i < 20 && !executor.finished(); ++i) {
      held.push_back(run(executor, 2.0).position[0]);
      executor.resume();
    }
    return held;
  };
  CHECK(places([](SmallRunner&) {}) == std::vector{5.0, 15.0, 25.0});
  CHECK(places([](SmallRunner& e) { e.program_stop(false); }) == std::vector{25.0});
  CHECK(places([](SmallRunner& e) { e.optional_stop(true); }) == std::vector{5.0, 10.0, 15.0, 25.0});
  const auto only = [](auto ask) {
    return [ask](SmallRunner& e) {
      e.program_stop(false);
      ask(e);
    };
  };
  CHECK(places(only([](SmallRunner& e) { e.pause_at(8); })) == std::vector{20.0, 25.0});
  const auto steps = places(only([](SmallRunner& e) { e.single_step(true); }));
  for (const double place : {5.0, 10.0, 15.0, 20.0, 25.0})
    CHECK(std::count(steps.begin(), steps.end(), place) >= 1);
}

TEST_CASE("words without end do not stop the blocks behind them", "[executor]") {
  const double tolerance = GENERATE(0.0, 0.01);
  const bool begins_away = GENERATE(false, true);
  INFO("tolerance " << tolerance << ", begins away " << begins_away);
  Lines lines{"G1 X5 F1200", "Y5"};
  for (int i = 0; i < 200; ++i) lines.push_back(i % 2 == 0 ? "M7" : "M9");
  for (const char* line : {"X10", "Y0", "M8", "X0"}) lines.emplace_back(line);
  if (begins_away) std::rotate(lines.begin(), lines.begin() + 2, lines.begin() + 202);
  SmallRunner executor(mill, {.tolerance = tolerance});
  if (begins_away) REQUIRE(executor.restart(0, Vector3::Zero()));
  const auto blocks = test::blocks_of(lines, mill);
  std::size_t pushed = 0, told = 0;
  SetPoint<3> point;
  for (int tick = 0; tick < 20000 && !executor.finished(); ++tick) {
    while (pushed < blocks.size() && executor.push(blocks[pushed]))
      if (++pushed == blocks.size()) executor.end_of_program();
    point = executor.tick(tick_time);
    for (const auto& word : point.words) {
      CHECK(word.number == (told == 200 ? 8 : told % 2 == 0 ? 7 : 9));
      ++told;
    }
  }
  CHECK(executor.finished());
  CHECK(told == 201);
  CHECK(point.position.norm() < 1e-12);
}

TEST_CASE("a single step backwards ends where a block begins", "[executor]") {
  const double tolerance = GENERATE(0.0, 0.05);
  INFO("tolerance " << tolerance);
  SmallRunner executor(mill, {.tolerance = tolerance});
  load(executor, {"G1 X5 F1200", "X10 Y1", "X15", "X20 Y1"});
  run(executor);
  executor.reverse(true);
  executor.single_step(true);
  std::vector<double> steps;
  for (int i = 0; i < 8; ++i) {
    executor.resume();
    for (int tick = 0; tick < 2000; ++tick) executor.tick(tick_time);
    steps.push_back(executor.tick(tick_time).position[0]);
  }
  std::vector<double> wanted{15, 10, 5, 0, 0, 0, 0, 0};
  for (std::size_t i = 0; i < steps.size(); ++i) CHECK(steps[i] == Approx(wanted[i]).margin(tolerance));
}

TEST_CASE("a quick stop is harder than a hold, and goes on when resumed", "[executor]") {
  const auto way = [](auto stop) {
    SmallRunner executor(mill, {.quick_stop_share = 10});
    load(executor, {"G1 X50 F1800"});
    const double from = run(executor, 0.5).position[0];
    stop(executor);
    const double rest = run(executor, 0.5).position[0];
    executor.resume();
    CHECK(run(executor).position[0] == 50.0);
    return rest - from;
  };
  const double held = way([](SmallRunner& e) { e.feed_hold(); });
  CHECK(held == Approx(30 * std::sqrt(30.0 / 10000)).epsilon(0.02));  // v sqrt(v / j)
  CHECK(way([](SmallRunner& e) { e.quick_stop(); }) < held / 3);
}

TEST_CASE("the share of a quick stop is one to a thousand, whatever is asked", "[executor]") {
  const double share = GENERATE(-1.0, 0.0, 0.5, NAN, 1e300, INFINITY);
  SmallRunner executor(mill, {.quick_stop_share = share});
  load(executor, {"G1 X20 F1200"});
  run(executor, 0.5);
  executor.quick_stop();
  const auto held = run(executor, 0.5);
  CHECK(held.velocity.isZero());
  CHECK((held.position[0] > 8 && held.position[0] < 12));
  REQUIRE(executor.jog({0, 5, 0}));
  run(executor, 0.5);
  executor.quick_stop();
  CHECK(run(executor, 0.5).velocity.isZero());
  executor.resume();
  CHECK((run(executor).position - Vector3(20, 0, 0)).norm() < 1e-12);
}

TEST_CASE("the tool keeps the feed limit on smoothed paths too", "[executor]") {
  auto slow = mill;
  slow.feed_limit = 5;
  SmallRunner executor(slow, {.tolerance = 0.05});
  for (const auto& block :
       test::blocks_of({"G17 F3000", "G3 X1 Y1 R0.8", "G3 X0 Y2 R0.8", "G1 Y2.3 X-0.3"}, slow))
    REQUIRE(executor.push(block));
  executor.end_of_program();
  double fastest = 0;
  while (!executor.finished()) fastest = std::max(fastest, executor.tick(tick_time).velocity.norm());
  CHECK(fastest <= 5 * (1 + 1e-9));
  CHECK(fastest > 4.9);
}

TEST_CASE("a program that was stopped begins anew at a line, from a place on it", "[executor]") {
  const Lines lines{"F1200", "G1 X10", "M8", "Y10", "G2 X20 Y20 I10", "G1 X30", "M9"};
  const auto whole = test::blocks_of(lines, mill);
  for (const double share : {0.0, 0.3, 1.0}) {
    SmallRunner executor(mill);
    load(executor, lines);
    run(executor, 0.4);
    executor.stop();
    run(executor);
    CHECK(executor.finished());
    const auto& arc = whole[3].path;
    const Vector3 place = arc.position_at(share * arc.length());
    REQUIRE(executor.restart(5, place));
    load(executor, lines);
    const auto first = executor.tick(tick_time);
    CHECK((first.position - place).norm() < 1e-4);
    CHECK(first.words.empty());
    std::string told;
    while (!executor.finished())
      for (const auto& word : executor.tick(tick_time).words)
        told += std::to_string(static_cast<int>(word.number));
    CHECK(told == "9");
    CHECK(executor.tick(tick_time).position[0] == 30.0);
    CHECK_FALSE(executor.error());
  }
  SmallRunner executor(mill);
  REQUIRE(executor.restart(5, {10, 10, 1}));
  load(executor, lines);
  run(executor);
  REQUIRE(executor.error());
  CHECK(executor.error()->error().code == ErrorCode::discontinuous);
}

TEST_CASE("set points show the start of a program before it begins", "[executor]") {
  const double tolerance = GENERATE(0.0, 0.01);
  const char* first = GENERATE("G1 X60 F1200", "M3 S1000", "G4 P0.2");
  const bool late = GENERATE(false, true);  // the thread that plans is
  CAPTURE(tolerance, first, late);
  const Vector3 start(50, -20, 5);
  PlanOptions options;
  std::copy(start.begin(), start.end(), options.start.begin());
  const auto blocks = test::blocks_of({first, "G1 X60 F1200", "Y0"}, mill, options);
  SmallRunner executor(mill, {.tolerance = tolerance, .background = late});
  CHECK(executor.tick(tick_time).position.isZero());  // nobody has said yet
  bool there = true;
  for (int tick = 0; tick < 30; ++tick) {
    if (tick < 2) REQUIRE(executor.push(blocks[static_cast<std::size_t>(tick)]));
    const auto point = executor.tick(tick_time);
    there = there && (point.position - start).norm() < 1 && point.tool == point.position;
    if (tick == 0 && tolerance > 0) there = there && point.position == start && point.velocity.isZero();
  }
  CHECK(there);
}

TEST_CASE("behind a map set points show the start of a program, and its tool", "[executor]") {
  using Polar = Executor<MappedMachine<test::Polar>, 16>;
  PlanOptions options;
  options.start[0] = 30, options.start[1] = 40;
  const auto blocks = test::blocks_of({"G1 X60 F1200"}, test::polar, options);
  Polar executor(test::polar, {.background = true});
  REQUIRE(executor.push(blocks[0]));
  executor.feed_hold();
  const auto point = executor.tick(tick_time);
  CHECK((point.position - Vector3(50, std::atan2(4, 3), 0)).norm() < 1e-12);
  CHECK((point.tool - Vector3(30, 40, 0)).norm() < 1e-12);
  const auto refused = executor.jog_to({45, 0, 0}, {.tool = 4});  // it would bound no joint
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == ErrorCode::not_supported);
}

TEST_CASE("a program that begins nowhere shows no such place", "[executor]") {
  SmallRunner executor(mill);
  REQUIRE(executor.push({.path = path::Line<3>({NAN, 0, 0}, {3, 0, 0}), .feed = 10}));
  CHECK(executor.tick(tick_time).position.isZero());
}

TEST_CASE("a program is over only behind the last cell of its last block", "[executor]") {
  using Waves = Executor<Machine<3>, 4, test::WaveBlock>;
  const auto executor =
      std::make_unique<Waves>(test::slow_axes<double>, Waves::Options{.tolerance = 0, .background = true});
  const auto wave = path::measured(test::Wave{Vector3::Zero(), {6, 3, 0}, 1});
  REQUIRE(wave);
  REQUIRE(executor->push({.path = *wave, .feed = 30}));
  executor->end_of_program();
  for (int tick = 0; tick < 100'000 && !executor->finished(); ++tick) {
    if (tick % 300 == 299) executor->plan(4);  // the thread that plans is late
    executor->tick(tick_time);
  }
  CHECK(executor->finished());
  CHECK(executor->tick(tick_time).along.position == Approx(wave->length()));
}

TEST_CASE("a push plans in as many steps as it is given, and what is left is planned later", "[executor]") {
  const auto blocks = test::blocks_of({"G1 X60 F1200", "Y20", "X0"}, mill);
  const auto at_once =
      std::make_unique<SmallRunner>(mill, SmallRunner::Options{.tolerance = 0, .background = true});
  const auto later =
      std::make_unique<SmallRunner>(mill, SmallRunner::Options{.tolerance = 0, .background = true});
  for (const auto& block : blocks) {
    REQUIRE(at_once->push(block));
    REQUIRE(later->push(block, 0));
  }
  for (SmallRunner* executor : {at_once.get(), later.get()}) executor->end_of_program();
  CHECK(later->plan(0));
  for (int tick = 0; tick < 10; ++tick) CHECK(later->tick(tick_time).position.isZero());
  while (at_once->plan(1)) {
  }
  while (later->plan(1)) {
  }
  double apart = 0;
  for (int tick = 0; tick < 100'000 && !at_once->finished(); ++tick)
    apart = std::max(apart, (at_once->tick(tick_time).position - later->tick(tick_time).position).norm());
  CHECK(at_once->finished());
  CHECK(later->finished());
  CHECK(apart == 0);
}

TEST_CASE("nothing is allocated once an executor and a reader are made", "[executor]") {
  BlockReader reader(mill);
  const auto executor = std::make_unique<SmallRunner>(mill);
  std::array<std::string, 6> lines{
      "G21 G90 F1200 M3 S100", "G1 X20", "G3 X25 Y5 R5", "G4 P0.05", "G1 X0", "M30"};
  const auto before = test::heap_allocations();
  for (int program = 0; program < 2; ++program) {
    for (const std::string& line : lines) {
      const auto blocks = reader.read_line(line);
      if (!blocks) break;
      for (const auto& block : *blocks)
        while (!executor->push(block)) executor->tick(tick_time);
    }
    executor->end_of_program();
    for (int tick = 0; !executor->finished(); ++tick) {
      if (tick == 100) executor->feed_override(1.7);
      if (tick == 200) executor->feed_hold();
      if (tick == 300) executor->resume();
      executor->tick(tick_time);
    }
    if (!executor->jog_to({1, 1, 1})) break;
    for (int tick = 0; tick < 2000; ++tick) executor->tick(tick_time);
    if (!executor->restart(0, {1, 1, 1})) break;
  }
  CHECK(test::heap_allocations() == before);
}

TEST_CASE("blocks come from another thread", "[executor]") {
  test::Random random;
  const double tolerance = GENERATE(0.0, 0.01);
  CAPTURE(tolerance);
  const auto lines = tolerance > 0 ? test::random_runs(random, 20, "", 20, tolerance)  // some are merged
                                   : test::random_lines(random, 300, {0, 0, 0}, 20, "");
  const auto blocks = test::blocks_of(lines, mill);
  const auto executor =
      std::make_unique<SmallRunner>(mill, SmallRunner::Options{.tolerance = tolerance, .background = true});
  executor->program_stop(false);
  std::atomic<bool> over{false};
  std::thread feeder([&] {
    for (const auto& block : blocks)
      while (!executor->push(block)) {
        executor->plan();
        std::this_thread::yield();
      }
    executor->end_of_program();
    while (!over) {
      executor->plan();
      std::this_thread::yield();
    }
  });
  test::TickCheck<Machine<3>, SetPoint<3>, ProgramBlock<Machine<3>>> check(
      mill, blocks,
      {.restless = 1,
       .period = tick_time,
       .rounding = tolerance > 0 ? 1e-9 : 1e-12,
       .tolerance = tolerance * (1 + 1e-5)});
  for (int tick = 0; tick < 10'000'000 && !executor->finished(); ++tick) {
    const auto point = executor->tick(tick_time);
    if (executor->pushed() > 0) check.take(point);
    if (tick == 300) executor->feed_override(1.5);
    if (tick % 64 == 0) std::this_thread::yield();
  }
  over = true;
  feeder.join();
  check.finish();
  CHECK(executor->finished());
  CHECK(check.faults.acceleration < 1e-9);
  CHECK(check.faults.jerk < 1e-9);
  CHECK(check.faults.way <= 0);
  CHECK(check.faults.place <= 0);
  CHECK(check.faults.end < 1e-9);
  CHECK_FALSE(check.faults.words_wrong);
}
