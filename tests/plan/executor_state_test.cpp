// What an executor says that it is doing.
#include "cncplan/executor_state.hpp"

#include <string>
#include <vector>

#include "cncplan/executor.hpp"
#include "support/catch.hpp"
#include "support/executor_check.hpp"
#include "support/small_mill.hpp"

using namespace cncplan;
using test::Lines, test::load, test::tick_time, test::SmallRunner;

namespace {

constexpr Machine<3> mill = test::small_mill;

// The states of a run, each once while it lasts; `ask` is called at each change.
template <class Ask>
std::string states(SmallRunner& executor, Ask&& ask) {
  std::string all;
  ExecutorState before = executor.state();
  for (int tick = 0; tick < 20000; ++tick) {
    executor.tick(tick_time);
    const ExecutorState now = executor.state();
    if (now != before) {
      all += std::string(to_text(now)) + ' ';
      ask(now);
    }
    before = now;
    if (now == ExecutorState::finished || now == ExecutorState::fault) break;
  }
  return all;
}

}  // namespace

TEST_CASE("an executor tells what it is doing", "[executor]") {
  SmallRunner executor(mill);
  CHECK(executor.state() == ExecutorState::waiting);
  load(executor, {"G1 X10 F1200", "G4 P0.05", "Y10", "M0", "X0", "M1", "Y0", "M30"});
  int moves = 0, rests = 0;
  const auto told = states(executor, [&](ExecutorState now) {
    if (now == ExecutorState::moving && ++moves == 2) executor.feed_hold();
    if (now == ExecutorState::held) CHECK(executor.jog_to({5, 5, 5}));
    if (now == ExecutorState::away) executor.resume();
    if (now == ExecutorState::stopped && ++rests > 0) executor.resume();
  });
  CHECK(told == "moving dwelling moving holding held jogging away jogging moving stopped moving finished ");
  CHECK(rests == 1);
}

TEST_CASE("an executor tells M1, a want of blocks, a stop and a fault", "[executor]") {
  SmallRunner optional(mill);
  optional.optional_stop(true);
  load(optional, {"G1 X1 F1200", "M1", "X2"});
  CHECK(states(optional, [&](ExecutorState now) {
          if (now == ExecutorState::stopped) optional.resume();
        }) == "moving stopped moving finished ");
  SmallRunner single(mill);
  single.single_step(true);
  load(single, {"G1 X1 F1200", "X2"});
  CHECK(states(single, [&](ExecutorState now) {
          if (now == ExecutorState::held) single.resume();
        }).starts_with("moving held moving "));
  SmallRunner starved(mill);
  for (const auto& block : test::blocks_of({"G1 X5 F600"}, mill)) REQUIRE(starved.push(block));
  for (int tick = 0; tick < 2000; ++tick) starved.tick(tick_time);
  CHECK(starved.state() == ExecutorState::waiting);
  starved.end_of_program();
  CHECK(starved.state() == ExecutorState::finished);
  SmallRunner stopped(mill);
  load(stopped, {"G1 X10 F1200"});
  CHECK(states(stopped, [&](ExecutorState) { stopped.stop(); }) == "moving holding finished ");
  SmallRunner faulty(mill);
  auto blocks = test::blocks_of({"G1 X5 F600", "X50"}, mill);
  blocks[1].path = path::Line<3>({5, 0, 0}, {500, 0, 0});
  for (const auto& block : blocks) REQUIRE(faulty.push(block));
  CHECK(states(faulty, [](ExecutorState) {}) == "moving fault ");
  CHECK(faulty.error());
  CHECK(faulty.push(blocks[0]));  // dropped
}
