// Rests on the way (dwells, optional stops, single steps, pauses at a line) are made, whatever is asked while
// the machine comes to rest.
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "cncplan/detail/executor/motion_executor.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

constexpr double period = 1e-3;

template <std::floating_point S>
struct BasicRig {
  std::vector<detail::BasicMotionBlock<S>> blocks = std::vector<detail::BasicMotionBlock<S>>(24);
  std::vector<detail::BasicSegmentLimits<S>> ahead = std::vector<detail::BasicSegmentLimits<S>>(8);
  std::vector<detail::BasicConstrainedJunction<S>> junctions =
      std::vector<detail::BasicConstrainedJunction<S>>(9);
  std::vector<detail::BasicConstrainedJunction<S>> spare =
      std::vector<detail::BasicConstrainedJunction<S>>(9);
  detail::BasicMotionExecutor<S> motion_executor{{blocks, ahead, junctions, spare}};
};

detail::MotionBlock straight(double length, double pause, int line, double entry = 1e3) {
  return {{length, entry, {30.0, 1000.0, 10000.0}, pause}, 30.0, false, true, line};
}

enum class Rest { dwell, optional_stop, single_step, pause_at };
enum class Asked { push, faster, slower, hold };

// Two blocks of 5 mm with a rest of 0.3 s between them and a request at a tick; the ticks that it rests
// there.
int ticks_of_rest(Rest rest, Asked asked, int at) {
  BasicRig<double> rig;
  auto& motion_executor = rig.motion_executor;
  motion_executor.push(straight(5.0, rest == Rest::dwell ? 0.3 : 0.0, 1));
  motion_executor.push(straight(5.0, 0.0, 2));
  motion_executor.optional_stop(rest == Rest::optional_stop);
  motion_executor.single_step(rest == Rest::single_step);
  motion_executor.pause_at(rest == Rest::pause_at ? 2 : 0);
  int ticks = 0;
  for (int tick = 0; tick < 2000 && !motion_executor.finished(); ++tick) {
    if (tick == at && asked == Asked::push) motion_executor.push(straight(5.0, 0.0, 3));
    if (tick == at && asked == Asked::faster) motion_executor.feed_override(1.1);
    if (tick == at && asked == Asked::slower) motion_executor.feed_override(0.7);
    if (tick == at && asked == Asked::hold) motion_executor.hold(), motion_executor.resume();
    const detail::MotionSetPoint now = motion_executor.tick(period);
    if (now.at_rest && now.block == 1 && now.along == 0.0 && ++ticks == 300) motion_executor.resume();
  }
  return ticks;
}

}  // namespace

TEST_CASE("a rest on the way is made, whatever is asked on the way to it") {
  for (const Rest rest : {Rest::dwell, Rest::optional_stop, Rest::single_step, Rest::pause_at})
    for (const Asked asked : {Asked::push, Asked::faster, Asked::slower, Asked::hold}) {
      int lost = 0;
      constexpr int braking_ends = 277;  // ticks; behind it a resume would end the rest
      for (int at = 0; at < braking_ends; ++at) lost += ticks_of_rest(rest, asked, at) < 299 ? 1 : 0;
      CAPTURE(static_cast<int>(rest), static_cast<int>(asked));
      CHECK(lost == 0);
    }
}

TEST_CASE("a dwell behind every tenth of many short moves is made, blocks coming as there is room") {
  BasicRig<double> rig;
  constexpr int moves = 2000, every = 10;
  int pushed = 0, ticks = 0, rested = 0;
  while (!(pushed == moves && rig.motion_executor.finished()) && ticks < 200'000) {
    const bool waits = pushed % every == every - 1;
    const double entry = pushed % every == 0 ? 0.0 : 1e3;
    if (pushed < moves && rig.motion_executor.push(straight(0.5, waits ? 0.1 : 0.0, pushed, entry))) {
      ++pushed;
      continue;
    }
    ++ticks;
    rested += rig.motion_executor.tick(period).at_rest ? 1 : 0;
  }
  CHECK(rested * period == Approx(0.1 * moves / every).margin(period * moves / every));
}

TEST_CASE("a block of no length waits where it stands: first, between others, last, several in a row") {
  // each of four blocks is a move, a dwell, or a stop that takes no time
  for (int pattern = 0; pattern < 81; ++pattern) {
    std::vector<detail::MotionBlock> program;
    double dwells = 0.0;
    for (int i = 0, kinds = pattern; i < 4; ++i, kinds /= 3) {
      const int kind = kinds % 3;
      const double entry =
          program.empty() || program.back().segment_limits.length == 0.0 || kind > 0 ? 0.0 : 1e3;
      program.push_back(straight(kind == 0 ? 0.7 : 0.0, kind == 1 ? 0.1 : 0.0, i, entry));
      dwells += program.back().segment_limits.pause;
    }
    for (int at = 0; at < 400; at += 7) {
      BasicRig<double> rig;
      for (const auto& block : program) rig.motion_executor.push(block);
      int ticks = 0, rested = 0;
      for (; ticks < 2000 && !rig.motion_executor.finished(); ++ticks) {
        if (ticks == at) rig.motion_executor.feed_override(1.1);
        rested += rig.motion_executor.tick(period).at_rest ? 1 : 0;
      }
      CAPTURE(pattern, at, ticks);
      CHECK(rig.motion_executor.finished());
      CHECK(rested * period == Approx(dwells).margin(4.1 * period));
      CHECK(rig.motion_executor.tick(period).block == 3);
    }
  }
}

TEST_CASE("in float a long slow move, and a long dwell, take their time") {
  struct Case {
    float length, speed, tick;
  };
  for (const auto& [length, speed, tick] :
       {Case{500.0F, 1.0F, 1e-3F}, {500.0F, 0.1F, 1e-2F}, {2000.0F, 0.05F, 1e-2F}}) {
    BasicRig<float> rig;
    constexpr float dwell = 100.0F;
    rig.motion_executor.push({{length, 0.0F, {speed, 1000.0F, 10000.0F}, dwell}, speed});
    const double expected = static_cast<double>(length) / static_cast<double>(speed) + 100.0;
    double time = 0.0;
    for (; !rig.motion_executor.finished() && time < 1.1 * expected; time += static_cast<double>(tick))
      rig.motion_executor.tick(tick);
    CAPTURE(length, speed);
    CHECK(time == Approx(expected).epsilon(1e-4));
  }
}
