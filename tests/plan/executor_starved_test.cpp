// Executors that get no more blocks, or are told that none will follow: how they come to rest, and who does
// the work.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "cncplan/executor.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

using Mill = Executor<Machine<3>, 256>;
constexpr Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
constexpr double period = 1e-3;

// Lines of equal length along a bend of 20 mm.
std::vector<Block<3>> lines(int count, double length) {
  constexpr double radius = 20;
  const double turn = length / radius;
  const auto corner = [&](int i) -> Vector3 {
    return {radius * std::sin(i * turn), radius * std::cos(i * turn), 0};
  };
  std::vector<Block<3>> blocks;
  for (int i = 0; i < count; ++i)
    blocks.push_back({.path = path::Line<3>(corner(i), corner(i + 1)), .feed = 20, .line = i + 1});
  return blocks;
}

struct Run {
  long ticks = 0;  // until the last block's end is reached
  int rests = 0;   // the one at the end is one
  double jerk{};   // mm/s^3 of an axis, by differences
};

// All blocks pushed as there is room, with `tick` before each tick; until the end of the last one is reached.
template <class E, class Tick>
Run run(E& executor, const std::vector<Block<3>>& blocks, bool ends, Tick&& tick) {
  Run result;
  std::size_t pushed = 0;
  bool moves = false;
  typename E::SetPoint before{};
  const Vector3 end = blocks.back().path.position_at(blocks.back().path.length());
  for (; result.ticks < 100'000; ++result.ticks) {
    tick();
    while (pushed < blocks.size() && executor.push(blocks[pushed]))
      if (++pushed == blocks.size() && ends) executor.end_of_program();
    const auto now = executor.tick(period);
    if (result.ticks > 0)
      result.jerk =
          std::max(result.jerk, ((now.acceleration - before.acceleration) / period).cwiseAbs().maxCoeff());
    before = now;
    const bool rests = now.velocity.isZero() && now.acceleration.isZero();
    if (moves && rests) ++result.rests;
    moves = !rests;
    if (rests && (now.position - end).norm() < 1e-9) break;
  }
  return result;
}

}  // namespace

TEST_CASE("an executor without more blocks runs all that it has, and rests once", "[executor]") {
  for (const bool background : {false, true})
    for (const double length : {0.15, 0.5, 3.0}) {
      const auto blocks = lines(300, length);
      CAPTURE(background, length);
      const auto make = [&] { return std::make_unique<Mill>(mill, Mill::Options{.background = background}); };
      const auto told = make(), starved = make();
      const Run whole = run(*told, blocks, true, [&] { told->plan(3); });
      const Run alone = run(*starved, blocks, false, [&] { starved->plan(3); });
      CHECK(whole.rests == 1);
      CHECK(alone.rests == 1);
      CHECK(alone.ticks <= whole.ticks + 1);
      CHECK(alone.jerk <= mill.limits.jerk * (1 + 1e-6));
    }
}

TEST_CASE("blocks that come in time, one by one, are not let go", "[executor]") {
  const auto blocks = lines(400, 0.15);
  for (const std::size_t every : {1U, 3U, 5U}) {  // a block takes 7.5 ticks
    const auto executor = std::make_unique<Mill>(mill, Mill::Options{.longest_wait = 0.4});
    std::size_t pushed = 0, ticks = 0;
    int rests = 0;
    bool moves = false;
    for (; !executor->finished() && ticks < 100'000; ++ticks) {
      if (pushed < blocks.size() && ticks % every == 0 && executor->push(blocks[pushed]))
        if (++pushed == blocks.size()) executor->end_of_program();
      const auto now = executor->tick(period);
      const bool rest = now.velocity.isZero() && now.acceleration.isZero();
      rests += moves && rest ? 1 : 0;
      moves = !rest;
    }
    CAPTURE(every);
    CHECK(rests == 1);
    CHECK(ticks <= 3105 + 67 * every + 40);  // it begins when the first block's path is known
  }
}

TEST_CASE("who pushes does not do the work of what was held back", "[executor]") {
  const auto blocks = lines(120, 0.15);
  // Steps of planning that a call leaves to the ticks, where 100 blocks wait.
  const auto steps_left = [&](auto&& call) {
    const auto executor = std::make_unique<Mill>(mill);
    for (std::size_t i = 0; i < 100; ++i) CHECK(executor->push(blocks[i]));
    call(*executor);
    std::size_t steps = 0;
    while (executor->plan(1)) ++steps;
    return steps;
  };
  const std::size_t stop = steps_left([&](Mill& executor) {
    auto block = blocks[100];
    block.exact_stop = true;
    CHECK(executor.push(block));
  });
  const std::size_t end = steps_left([](Mill& executor) { executor.end_of_program(); });
  CAPTURE(stop, end);
  CHECK(end >= 66);
  CHECK(stop >= 66);
}

TEST_CASE("an end is marked, and more blocks go on from there", "[executor]") {
  const auto blocks = lines(200, 0.15);
  const auto executor = std::make_unique<Mill>(mill);
  std::size_t pushed = 0;
  long ticks = 0;
  for (; ticks < 100'000 && !(pushed == blocks.size() && executor->finished()); ++ticks) {
    for (; pushed < blocks.size() && (pushed != 80 || ticks > 0) && executor->push(blocks[pushed]);)
      if (++pushed == 80 || pushed == blocks.size()) executor->end_of_program();
    executor->tick(period);
  }
  CHECK(executor->finished());
  CHECK_FALSE(executor->error());
  const Vector3 end = blocks.back().path.position_at(blocks.back().path.length());
  CHECK((executor->tick(period).position - end).norm() < 1e-9);
}
