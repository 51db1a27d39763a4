// Stops of the program: what is told before them, what waits behind them, and what is held there, at every
// level and for a plan.
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "cncplan/executor_levels.hpp"
#include "cncplan/gcode/word.hpp"
#include "cncplan/plan_program.hpp"
#include "cncplan/trajectory_executor.hpp"
#include "support/catch.hpp"
#include "support/executor_check.hpp"

using namespace cncplan;

namespace {

using Runner = Executor<Machine<3>, 64>;
using Lines = std::vector<std::string>;

constexpr double period = 1e-3;  // s

const Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};

// Calls run(executor) with an executor of each level, and with one of a plan.
template <class Run>
void at_every_door(const Lines& lines, Run&& run) {
  for (const SmoothLevel level :
       {SmoothLevel::exact, SmoothLevel::fast, SmoothLevel::good, SmoothLevel::best}) {
    CAPTURE(to_text(level));
    Runner executor(mill, LevelExecutorOptions{.level = level});
    for (const auto& block : test::blocks_of(lines, mill)) REQUIRE(executor.push(block));
    executor.end_of_program();
    run(executor);
  }
  std::string text;
  for (const auto& line : lines) text += line + "\n";
  const auto program = read_text(text, mill);
  REQUIRE_FALSE(program.failed());
  auto trajectory = plan_blocks(program.blocks(), mill, {.level = SmoothLevel::good});
  REQUIRE(trajectory);
  if (trajectory->phases().empty()) return;
  trajectory->set_words(timed_words(program, *trajectory));
  INFO("a plan");
  TrajectoryExecutor executor(*trajectory, mill, {.longest_hold = 10});
  run(executor);
}

// What it tells and that it dwells, with a bar where it rests in a state and is resumed, and where it ended.
template <class E>
std::string told(E& executor, double seconds = 20, ExecutorState resumed = ExecutorState::stopped) {
  std::string log;
  double stopped = 0, dwells = 0;
  for (int tick = 0; tick < seconds / period; ++tick) {
    const auto point = executor.tick(period);
    const ExecutorState state = executor.state();
    if (state != ExecutorState::dwelling && dwells > 0.2) log += "dwell ";
    dwells = state == ExecutorState::dwelling ? dwells + period : 0;
    for (const auto& word : point.words)
      log += word.letter + std::to_string(static_cast<int>(word.number)) + " ";
    if (state == ExecutorState::finished) return log + "end";
    stopped = state == resumed ? stopped + period : 0;
    if (stopped > 0.3) log += "| ", executor.resume(), stopped = 0;
  }
  return log + to_text(executor.state()).data();
}
template <class E>
void run(E& executor, double seconds) {
  for (int tick = 0; tick < seconds / period; ++tick) executor.tick(period);
}

}  // namespace

TEST_CASE("stops: what follows a stop of the program waits until it is resumed", "[executor]") {
  const auto check = [](const Lines& lines, const std::string& expected) {
    std::string program;
    for (const auto& line : lines) program += line + " / ";
    CAPTURE(program);
    at_every_door(lines, [&](auto& executor) {
      executor.optional_stop(true);
      CHECK(told(executor) == expected);
    });
  };
  check({"G1 X5 F1200", "M0", "X9"}, "M0 | end");
  check({"G1 X5 F1200", "M5", "M0", "M3 S200", "M8", "Y5"}, "M5 M0 | S200 M3 M8 end");
  check({"G1 X5 F1200", "M5", "M1", "M3 S200", "M8", "Y5"}, "M5 M1 | S200 M3 M8 end");
  check({"G1 X5 F1200", "M5", "M60", "M3 S200", "M8", "Y5"}, "M5 M60 | S200 M3 M8 end");
  check({"G1 X5 F1200", "M0", "T2 M6", "M0", "X0"}, "M0 | T2 M6 M0 | end");
  check({"G1 X5 F1200", "M0", "M0", "X0"}, "M0 | M0 | end");
  check({"G1 X5 F1200", "M0", "M1", "M8", "X0"}, "M0 | M1 | M8 end");
  check({"G1 X5 F1200", "M0", "G4 P0.5", "X0"}, "M0 | dwell end");
  check({"G1 X5 F1200", "G4 P0.5", "M0", "X0"}, "dwell M0 | end");
  check({"G1 X5 F1200", "M0", "G4 P0.5", "M8", "M0", "G4 P0.3", "X0"}, "M0 | dwell M8 M0 | dwell end");
  check({"G1 X5 F1200", "M0"}, "M0 | end");
  check({"G1 X5 F1200", "M60"}, "M60 | end");
  check({"G1 X5 F1200", "M0", "M9", "M5"}, "M0 | M9 M5 end");
  check({"G1 X5 F1200", "M0", "M9", "M30"}, "M0 | M9 M30 end");
  check({"M3 S100", "M0", "M8", "G1 X5 F1200", "X9"}, "S100 M3 M0 | M8 end");
  check({"M0", "M3 S100"}, "M0 | S100 M3 end");
}

TEST_CASE("stops: nothing is told at rest that lies behind a hold or a stop", "[executor]") {
  const Lines lines{"M3 S200", "G1 X5 F1200", "M8", "Y5"};
  at_every_door(lines, [](auto& executor) {
    SECTION("a hold before the first tick") {
      executor.feed_hold();
      CHECK(told(executor, 0.3) == "held");
      executor.resume();
      CHECK(told(executor) == "S200 M3 M8 end");
    }
    SECTION("a stop before the first tick") {
      executor.stop();
      CHECK(told(executor) == "end");
    }
    SECTION("single blocks") {
      executor.single_step(true);
      CHECK(told(executor, 2) == "S200 M3 held");
      executor.resume();
      CHECK(told(executor, 2) == "M8 end");
    }
    SECTION("a pause at a line") {
      executor.pause_at(4);
      CHECK(told(executor, 2) == "S200 M3 held");
      executor.resume();
      CHECK(told(executor, 2) == "M8 end");
    }
    SECTION("a quick stop on the way") {
      run(executor, 0.2);
      executor.quick_stop();
      CHECK(told(executor, 1) == "held");
      executor.resume();
      CHECK(told(executor) == "M8 end");
    }
  });
}

TEST_CASE("stops: at a rest of the program words and dwells wait, too", "[executor]") {
  const auto at_rest = [](const Lines& lines, auto&& ask, const std::string& held, const std::string& then) {
    std::string program;
    for (const auto& line : lines) program += line + " / ";
    CAPTURE(program);
    at_every_door(lines, [&](auto& executor) {
      ask(executor);
      CHECK(told(executor, 3) == held);
      executor.resume();
      CHECK(told(executor) == then);
    });
  };
  const auto hold = [](auto& executor) { executor.feed_hold(); };
  const auto stop = [](auto& executor) { executor.stop(); };
  const auto step = [](auto& executor) { executor.single_step(true); };
  at_rest({"M3 S200", "G4 P0.5", "G1 X5 F1200"}, hold, "held", "S200 M3 dwell end");
  at_rest({"M3 S200", "G4 P0.5", "G1 X5 F1200"}, stop, "end", "end");
  at_rest({"G4 P0.5", "G1 X5 F1200"}, hold, "held", "dwell end");
  at_rest({"G1 X5 F1200", "G61.1", "M8", "X0"}, step, "held", "M8 end");
  at_rest({"G1 X5 F1200", "T2 M6", "X0"}, step, "held", "T2 M6 end");
  // A hold that comes where the motion comes to a rest anyway.
  for (const int ticks : {300, 320, 330, 335, 338}) {
    CAPTURE(ticks);
    const auto late = [&](auto& executor) {
      run(executor, ticks * period);
      REQUIRE(executor.state() == ExecutorState::moving);
      executor.feed_hold();
    };
    at_rest({"G1 X5 F1200", "M3 S200", "G4 P0.5", "X0"}, late, "held", "S200 M3 dwell end");
    const auto late_stop = [&](auto& executor) {
      run(executor, ticks * period);
      executor.stop();
    };
    at_rest({"G1 X5 F1200", "M3 S200", "G4 P0.5", "X0"}, late_stop, "end", "end");
  }
}

TEST_CASE("stops: a stop ends a dwell, and a hold lets one that has begun go on", "[executor]") {
  at_every_door({"G1 X5 F1200", "G4 P2", "M8", "X0"}, [](auto& executor) {
    run(executor, 1);
    REQUIRE(executor.state() == ExecutorState::dwelling);
    SECTION("hold") {
      executor.feed_hold();
      CHECK(told(executor, 4) == "dwell held");
      executor.resume();
      CHECK(told(executor) == "M8 end");
    }
    SECTION("stop") {
      executor.stop();
      run(executor, 0.01);
      CHECK(executor.state() == ExecutorState::finished);
      CHECK(executor.jog_by({0, 1, 0}));
      run(executor, 2);
      CHECK(executor.tick(period).position.isApprox(Vector3(5, 1, 0)));
    }
  });
}

TEST_CASE("stops: the way back leads through them, and forwards they stop again", "[executor]") {
  at_every_door({"G1 X5 F1200", "M0", "M8", "X20", "Y9"}, [](auto& executor) {
    run(executor, 2);
    REQUIRE(executor.state() == ExecutorState::stopped);
    executor.reverse(true);
    executor.resume();
    CHECK(told(executor, 2) == "held");  // nothing is told on the way back
    CHECK(executor.tick(period).position.norm() < 1e-6);
    executor.reverse(false);
    executor.resume();
    CHECK(told(executor, 0.2) == "moving");
    run(executor, 2);
    REQUIRE(executor.state() == ExecutorState::stopped);
    executor.resume();
    run(executor, 0.5);
    executor.reverse(true);
    run(executor, 4);
    CHECK(executor.tick(period).position.norm() < 1e-6);
    CHECK(executor.state() == ExecutorState::held);
    executor.reverse(false);
    run(executor, 3);
    CHECK(executor.tick(period).position.isApprox(Vector3(5, 0, 0)));
    CHECK(executor.state() == ExecutorState::stopped);
    executor.resume();
    run(executor, 6);
    CHECK(executor.tick(period).position.isApprox(Vector3(20, 9, 0)));
    CHECK(executor.state() == ExecutorState::finished);
  });
}

TEST_CASE("stops: a hold in a dwell waits before the next one", "[executor]") {
  const Lines more = GENERATE(Lines{"G4 P0.7", "X0"}, Lines{"G4 P0.7"}, Lines{"M8", "G4 P0.7", "X0"});
  Lines lines{"G1 X5 F1200", "G4 P0.5"};
  lines.insert(lines.end(), more.begin(), more.end());
  CAPTURE(lines.size());
  at_every_door(lines, [](auto& executor) {
    while (executor.state() != ExecutorState::dwelling) executor.tick(period);
    executor.feed_hold();
    CHECK(told(executor, 3) == "dwell held");
    executor.resume();
    double dwelled = 0;
    while (!executor.finished()) {
      executor.tick(period);
      dwelled += executor.state() == ExecutorState::dwelling ? period : 0;
    }
    CHECK(dwelled == Approx(0.7).margin(2.5 * period));
  });
}

TEST_CASE("stops: single steps rest before each motion and each dwell", "[executor]") {
  const auto check = [](const Lines& lines, const std::string& expected) {
    CAPTURE(lines.size(), expected);
    at_every_door(lines, [&](auto& executor) {
      executor.single_step(true);
      CHECK(told(executor, 20, ExecutorState::held) == expected);
    });
  };
  check({"G1 X5 F1200", "G4 P0.5", "X0"}, "| dwell | end");
  check({"G1 X5 F1200", "G4 P0.5", "G4 P0.7", "X0"}, "| dwell | dwell | end");
  check({"G4 P0.5", "G4 P0.7", "G1 X5 F1200"}, "dwell | dwell | end");
  check({"G1 X5 F1200", "G4 P0.5", "G4 P0.7"}, "| dwell | dwell end");
  check({"G1 X5 F1200", "G4 P0.5", "M8", "G4 P0.7", "T2 M6", "X0"}, "| dwell | M8 dwell | T2 M6 end");
}

TEST_CASE("stops: what is asked for in a dwell holds behind it", "[executor]") {
  const Lines lines{"G4 P0.5", "G1 X5 F1200"};
  at_every_door(lines, [](auto& executor) {
    SECTION("single blocks") {
      run(executor, 0.1);
      executor.single_step(true);
      CHECK(told(executor, 2) == "dwell held");
    }
    SECTION("a pause, and a resume before it") {
      executor.pause_at(2);
      run(executor, 0.1);
      executor.resume();
      CHECK(told(executor, 2) == "dwell held");
    }
    SECTION("nothing any more") {
      executor.single_step(true);
      executor.pause_at(2);
      run(executor, 0.1);
      executor.single_step(false);
      executor.pause_at(0);
      CHECK(told(executor, 2) == "dwell end");
    }
    SECTION("a resume goes on to the end of the step, where it is held before that") {
      executor.feed_hold();
      run(executor, 0.5);
      executor.single_step(true);
      CHECK(told(executor, 4, ExecutorState::held) == "| dwell | end");
    }
  });
  at_every_door({"G1 X5 F1200"}, [](auto& executor) {
    executor.single_step(true);
    executor.pause_at(1);
    CHECK(told(executor, 1) == "held");
    executor.resume();
    CHECK(told(executor, 2) == "end");
  });
}

TEST_CASE("stops: no dwell begins without speed or on the way back", "[executor]") {
  const auto dwells = [](auto& executor, double seconds) {
    double time = 0;
    for (int tick = 0; tick < seconds / period; ++tick) {
      executor.tick(period);
      time += executor.state() == ExecutorState::dwelling ? period : 0;
    }
    return time;
  };
  at_every_door({"G4 P0.5", "G61.1 G1 X2 F1200", "G4 P0.7"}, [&](auto& executor) {
    executor.feed_override(0);
    CHECK(dwells(executor, 1) == 0);
    CHECK(executor.state() == ExecutorState::held);
    executor.feed_override(1);
    CHECK(dwells(executor, 0.52) == Approx(0.5).margin(2.5 * period));
    executor.feed_override(0);
    CHECK(dwells(executor, 2) == 0);
    executor.feed_override(1);
    CHECK(dwells(executor, 3) == Approx(0.7).margin(2.5 * period));
    CHECK(executor.finished());
  });
  at_every_door({"G1 X5 F1200", "G61.1 X7", "G4 P0.7"}, [&](auto& executor) {
    run(executor, 0.3);
    executor.reverse(true);
    CHECK(dwells(executor, 2) == 0);
    executor.reverse(false);
    CHECK(dwells(executor, 3) == Approx(0.7).margin(2.5 * period));
    CHECK(executor.finished());
  });
}

TEST_CASE("stops: words behind a stop of the program wait there behind a way back, too", "[executor]") {
  at_every_door({"G1 X5 F1200", "M0", "M7", "X8"}, [](auto& executor) {
    CHECK(told(executor, 1, ExecutorState::away) == "M0 stopped");
    executor.reverse(true);
    executor.resume();
    CHECK(told(executor, 2) == "held");
    executor.reverse(false);
    CHECK(told(executor, 1, ExecutorState::away) == "stopped");
    executor.resume();
    CHECK(told(executor, 2) == "M7 end");
  });
}

TEST_CASE("stops: a pause at a line of several motions is one", "[executor]") {
  at_every_door({"G1 X5 F1200", "G81 X6 Z-1 R1", "G80", "G1 X20"}, [](auto& executor) {
    executor.pause_at(2);
    CHECK(told(executor, 20, ExecutorState::held) == "| end");
  });
}

TEST_CASE("stops: single steps and pauses are made behind a way back, too", "[executor]") {
  const auto held_at = [](auto& executor) {
    double place = -1;
    for (int tick = 0; tick < 3 / period; ++tick) place = executor.tick(period).position.x();
    CHECK(executor.state() == ExecutorState::held);
    executor.resume();
    return place;
  };
  at_every_door({"G1 X5 F1200", "X10", "X15", "X20"}, [&](auto& executor) {
    executor.pause_at(4);
    CHECK(held_at(executor) == Approx(15).margin(0.03));
    executor.reverse(true);
    CHECK(held_at(executor) == Approx(0).margin(1e-9));
    executor.reverse(false);
    SECTION("another line") {
      executor.pause_at(2);
      CHECK(held_at(executor) == Approx(5).margin(0.03));
      CHECK(told(executor, 5) == "end");
    }
    SECTION("the line of the pause is passed") { CHECK(told(executor, 5) == "end"); }
    SECTION("single steps") {
      executor.single_step(true);
      for (const double place : {5, 10, 15}) CHECK(held_at(executor) == Approx(place).margin(0.03));
      CHECK(told(executor, 5) == "end");
    }
  });
}

TEST_CASE("stops: nothing is told where the motion turns round at a rest", "[executor]") {
  at_every_door({"G61.1 G1 X5 F1200", "M0", "M8", "X8"}, [](auto& executor) {
    run(executor, 0.3);  // the way down to the rest has begun
    executor.reverse(true);
    const std::string log = told(executor, 2);
    CHECK(log.find('M') == std::string::npos);
    executor.reverse(false);
    CHECK(told(executor, 5) == "M0 | M8 end");
  });
}

TEST_CASE("stops: turning round is no hold", "[executor]") {
  at_every_door({"G1 X20 F1200", "Y9"}, [](auto& executor) {
    run(executor, 0.5);
    bool held = false;
    for (const bool back : {true, false, true, false}) {
      executor.reverse(back);
      for (int tick = 0; tick < 200; ++tick) {
        executor.tick(period);
        held = held || executor.state() == ExecutorState::held;
      }
    }
    CHECK_FALSE(held);
  });
}

TEST_CASE("stops: a pause is made before a line that moves, not before a dwell or words alone",
          "[executor]") {
  const auto paused = [](const Lines& lines, const std::string& log, const std::string& then) {
    CAPTURE(lines[1]);
    at_every_door(lines, [&](auto& executor) {
      executor.pause_at(2);
      CHECK(told(executor, 3) == log);
      executor.resume();
      CHECK(told(executor, 3) == then);
    });
  };
  paused({"G1 X5 F1200", "G4 P0.5", "X0"}, "dwell end", "end");
  paused({"G1 X5 F1200", "T2 M6", "X0"}, "T2 M6 end", "end");
  paused({"G1 X5 F1200", "G4 P0.5"}, "dwell end", "end");
  paused({"G1 X5 F1200", "M30"}, "M30 end", "end");
  paused({"G1 X5 F1200", "T2 M6 X0", "X1"}, "held", "T2 M6 end");
}

TEST_CASE("stops: a pause is made before a motion that comes when the words of its line are over",
          "[executor]") {
  Executor<Machine<3>, 64> executor(mill);
  executor.pause_at(2);
  const auto blocks = test::blocks_of({"G1 X5 F1200", "T2 M6 X0"}, mill);
  REQUIRE(blocks.size() == 4);
  for (std::size_t i = 0; i < 3; ++i) REQUIRE(executor.push(blocks[i]));
  CHECK(told(executor, 3) == "T2 M6 waiting");
  REQUIRE(executor.push(blocks[3]));
  executor.end_of_program();
  CHECK(told(executor, 3) == "held");
  executor.resume();
  CHECK(told(executor, 3) == "end");
}
