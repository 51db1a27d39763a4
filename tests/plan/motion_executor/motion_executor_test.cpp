#include "cncplan/detail/executor/motion_executor.hpp"

#include <cmath>
#include <concepts>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "cncplan/profile/from_state.hpp"
#include "support/brake_oracle.hpp"
#include "support/catch.hpp"
#include "support/motion_check.hpp"
#include "support/no_heap.hpp"

using namespace cncplan;

namespace {

constexpr Limits limits{30.0, 1000.0, 10000.0};

template <std::floating_point S>
struct BasicRig {
  explicit BasicRig(std::size_t window, std::int64_t keep = 8)
      : blocks(window + 16),
        ahead(window),
        junctions(window + 1),
        spare(window + 1),
        motion_executor({blocks, ahead, junctions, spare}, keep) {}

  std::vector<detail::BasicMotionBlock<S>> blocks;
  std::vector<detail::BasicSegmentLimits<S>> ahead;
  std::vector<detail::BasicConstrainedJunction<S>> junctions, spare;
  detail::BasicMotionExecutor<S> motion_executor;
};

using Rig = BasicRig<double>;

detail::MotionBlock straight(double length, int line = 0) {
  return {{length, 1e3, limits, 0.0}, 30.0, false, false, line};
}

// Ticks of a millisecond, and what is left.
detail::MotionSetPoint run(detail::MotionExecutor& motion_executor, double seconds) {
  constexpr double period = 1e-3;
  for (; seconds > period; seconds -= period) motion_executor.tick(period);
  return motion_executor.tick(seconds);
}

// Ticks until it rests; the time that took.
double until_rest(detail::MotionExecutor& motion_executor, double period = 1e-4) {
  double time = 0.0;
  do time += period;
  while (!motion_executor.tick(period).at_rest && time < 100.0);
  return time;
}

}  // namespace

TEST_CASE("undisturbed it takes the planned time") {
  Rig rig(8);
  rig.motion_executor.push(straight(10.0));
  rig.motion_executor.push(straight(5.0));
  const double planned = profile::seven_phase(15.0, {0.0, 0.0}, limits)->duration();
  CHECK(until_rest(rig.motion_executor) == Approx(planned).margin(1e-4));
  CHECK(rig.motion_executor.finished());
  const auto end = rig.motion_executor.tick(1e-3);
  CHECK(end.block == 1);
  CHECK(end.along == 5.0);
}

TEST_CASE("a hold comes to rest in the least time, from any instant") {
  for (const double at : {0.01, 0.05, 0.08, 0.1, 0.2, 0.4}) {
    CAPTURE(at);
    Rig rig(8);
    for (int i = 0; i < 8; ++i) rig.motion_executor.push(straight(2.0));
    detail::MotionSetPoint now;
    for (double t = 0.0; t < at - 5e-5; t += 1e-4) now = rig.motion_executor.tick(1e-4);
    rig.motion_executor.hold();
    const auto best = profile::stop({now.velocity, now.acceleration}, limits);
    REQUIRE(best);
    CHECK(until_rest(rig.motion_executor) == Approx(best->duration()).margin(1.1e-4));
    // and goes on to the exact end
    rig.motion_executor.resume();
    until_rest(rig.motion_executor);
    CHECK(rig.motion_executor.finished());
    CHECK(rig.motion_executor.tick(1e-3).along == 2.0);
  }
}

TEST_CASE("a hold takes the least time where limits differ from block to block") {
  // Long straights and tight arcs, whose limits along the path are lower: of a hold that ends in the next
  // block the oracle knows the least time.
  test::Random random;
  int held = 0, slower = 0;
  double worst = 0.0;
  while (held < 60) {
    Limits low = limits;
    low.velocity = random.uniform(10, 20);
    low.acceleration *= random.uniform(0.4, 0.9);
    low.jerk *= random.uniform(0.4, 0.9);
    std::vector<detail::MotionBlock> program;
    for (int i = 0; i < 10; ++i) program.push_back({{3.0, 1e3, i % 2 == 0 ? limits : low, 0.0}, 30.0});
    Rig rig(16);
    for (const auto& block : program) rig.motion_executor.push(block);
    const detail::MotionSetPoint now = run(rig.motion_executor, random.uniform(0.2, 1.2));
    const auto number = static_cast<std::size_t>(now.block);
    const double room = 3.0 - now.along;
    if (number + 1 >= program.size() || now.at_rest) continue;
    rig.motion_executor.hold();
    const detail::MotionSetPoint then = run(rig.motion_executor, 1.0);
    REQUIRE(then.at_rest);
    if (then.block != now.block + 1) continue;
    ++held;
    const double time = 1.0 - rig.motion_executor.rested();
    const double best =
        test::BrakeOracle(now.velocity, now.acceleration, room, program[number].segment_limits.limits,
                          program[number + 1].segment_limits.limits)
            .least_time();
    slower += time > best * 1.001 ? 1 : 0;
    worst = std::max(worst, time / best - 1);
  }
  CAPTURE(slower, worst);
  CHECK(slower == 0);
}

TEST_CASE("a hold rests before a dwell that comes in while it brakes") {
  for (int later = 1; later < 60; ++later) {
    CAPTURE(later);
    Rig rig(16);
    for (const auto& [length, share] : {std::pair{2.81, 0.8}, {0.41, 1.0}, {0.27, 0.9}})
      rig.motion_executor.push({{length, 1e3, {30.0, 1000.0 * share, 10000.0 * share}, 0.0}, 30.0});
    run(rig.motion_executor, 0.098);
    rig.motion_executor.hold();
    run(rig.motion_executor, 1e-3 * later);
    constexpr Limits none{1.0, 1.0, 1.0};  // over no length they play no part
    rig.motion_executor.push({{0.0, 0.0, none, 0.5}, 1.0});
    rig.motion_executor.push(straight(3.0));
    const detail::MotionSetPoint then = run(rig.motion_executor, 0.4);
    CHECK(then.at_rest);
    CHECK(then.block < 3);  // that is where it would rest if nothing had come
  }
}

TEST_CASE("a stop ends the program where it comes to rest") {
  Rig rig(8);
  rig.motion_executor.push(straight(100.0));
  const detail::MotionSetPoint now = run(rig.motion_executor, 0.5);
  rig.motion_executor.stop();
  CHECK_FALSE(rig.motion_executor.stopped());
  const detail::MotionSetPoint end = rig.motion_executor.tick(1.0);
  CHECK(end.at_rest);
  CHECK(rig.motion_executor.stopped());
  const auto best = profile::stop({now.velocity, now.acceleration}, limits);
  CHECK(1.0 - rig.motion_executor.rested() == Approx(best->duration()).epsilon(1e-9));
  rig.motion_executor.resume();
  rig.motion_executor.feed_override(1.5);
  CHECK(rig.motion_executor.tick(1.0) == end);
  CHECK_FALSE(rig.motion_executor.finished());
}

TEST_CASE("a stop cuts a dwell short") {
  Rig rig(8);
  auto block = straight(1.0);
  block.segment_limits.pause = 10.0;
  rig.motion_executor.push(block);
  rig.motion_executor.push(straight(1.0));
  rig.motion_executor.tick(1.0);
  CHECK(rig.motion_executor.rested() == 0.0);  // it has to wait
  rig.motion_executor.stop();
  rig.motion_executor.tick(1.0);
  CHECK(rig.motion_executor.rested() == 1.0);
}

TEST_CASE("it begins at any block, and goes on elsewhere after a stop") {
  Rig rig(4, 2);
  REQUIRE(rig.motion_executor.skip_to(1000));
  CHECK(rig.motion_executor.finished());
  CHECK(rig.motion_executor.tick(1e-3) == detail::MotionSetPoint{-1, 0.0, 0.0, 0.0, 0.0, true});
  auto fast = straight(5.0);  // would be entered at speed
  int pushed = 0;
  while (rig.motion_executor.push(fast)) ++pushed;
  CHECK(pushed == 20);  // all the memory there is
  const detail::MotionSetPoint first = rig.motion_executor.tick(1e-3);
  CHECK(first.block == 1000);
  CHECK(first.velocity == Approx(limits.jerk * 1e-6 / 2));
  CHECK_FALSE(rig.motion_executor.skip_to(7));  // not in motion
  rig.motion_executor.stop();
  rig.motion_executor.tick(1.0);
  CHECK_FALSE(rig.motion_executor.skip_to(-1));
  CHECK(rig.motion_executor.stopped());
  REQUIRE(rig.motion_executor.skip_to(7));
  CHECK_FALSE(rig.motion_executor.stopped());
  rig.motion_executor.push(fast);
  CHECK(rig.motion_executor.tick(1e-3).block == 7);
  run(rig.motion_executor, 1.0);
  CHECK(rig.motion_executor.finished());
}

TEST_CASE("until the next change the jerk is what it was") {
  Rig rig(8);
  for (int i = 0; i < 6; ++i) rig.motion_executor.push(straight(2.0));
  double time = 0.0, worst = 0.0;
  for (int edge = 0; edge < 20 && !rig.motion_executor.finished(); ++edge) {
    const detail::MotionSetPoint start = rig.motion_executor.tick(1e-9);
    const double lasts = rig.motion_executor.until_change();
    if (std::isinf(lasts)) break;
    const detail::MotionSetPoint end = rig.motion_executor.tick(lasts);
    worst = std::max(worst, std::abs(end.acceleration - start.acceleration - start.jerk * lasts));
    time += lasts;
  }
  CHECK(worst < 1e-9);
  CHECK(time == Approx(profile::seven_phase(12.0, {0.0, 0.0}, limits)->duration()).epsilon(1e-6));
  CHECK(std::isinf(rig.motion_executor.until_change()));
}

TEST_CASE("random requests break no limit, and the end stays exact") {
  test::Random random;
  for (int sequence = 0; sequence < 200; ++sequence) {
    const auto program = test::random_motion_program(random, random.integer(1, 60));
    const int gap = random.integer(0, 3) == 0 ? 1 : random.integer(2, 200);
    const auto window = static_cast<std::size_t>(random.integer(4, 64));
    const auto faults = test::run(program, random, gap, window, 20000);
    CAPTURE(sequence, gap, window, program.blocks.size(), faults.ticks);
    CHECK(faults.jerk < 1e-6);
    CHECK(faults.acceleration < 1e-9);
    CHECK(faults.speed < 1e-9);
    CHECK(faults.junction < 1e-9);
    CHECK(faults.travel < 1e-9);
    CHECK(faults.sum_acceleration < 1e-9);
    CHECK(faults.sum_jerk < 1e-6);
    CHECK(faults.dwell < 1e-9);
    CHECK(faults.finished);
    CHECK(faults.end < 1e-9);
  }
}

TEST_CASE("junctions that are too few shorten the look-ahead") {
  std::vector<detail::MotionBlock> blocks(16);
  std::vector<detail::SegmentLimits> ahead(16);
  std::vector<detail::ConstrainedJunction> junctions(20), spare(20);
  for (auto* guarded : {&junctions, &spare})
    for (detail::ConstrainedJunction& junction : *guarded) junction.block = 77;
  detail::MotionExecutor motion_executor(
      {blocks, ahead, std::span(junctions).first(8), std::span(spare).first(3)});
  for (int i = 0; i < 12; ++i)
    REQUIRE(motion_executor.push(
        {.segment_limits = {1.0, i == 0 ? 0.0 : 1e3, limits, 0.0}, .feed = 20.0 + i % 2}));
  int ticks = 0;
  while (!motion_executor.finished() && ticks < 10000) motion_executor.tick(1e-3), ++ticks;
  CHECK(motion_executor.finished());
  CHECK(junctions[8].block == 77);
  CHECK(spare[3].block == 77);
}

TEST_CASE("the same requests at the same ticks give the same samples bit for bit") {
  const auto run = [] {
    test::Random random(7);
    const auto program = test::random_motion_program(random, 40).blocks;
    Rig rig(64);
    for (const auto& block : program) rig.motion_executor.push(block);
    std::vector<detail::MotionSetPoint> samples;
    for (int tick = 0; tick < 3000; ++tick) {
      if (tick % 97 == 0) rig.motion_executor.feed_override(random.uniform(0.1, 2.0));
      if (tick % 500 == 250) rig.motion_executor.hold();
      if (tick % 500 == 400) rig.motion_executor.resume();
      samples.push_back(rig.motion_executor.tick(1e-3));
    }
    return samples;
  };
  CHECK(run() == run());
}

TEST_CASE("half the feed is half the speed, none is a hold") {
  Rig rig(8);
  rig.motion_executor.push(straight(100.0));
  for (int i = 0; i < 1000; ++i) rig.motion_executor.tick(1e-3);
  rig.motion_executor.feed_override(0.5);
  for (int i = 0; i < 500; ++i) rig.motion_executor.tick(1e-3);
  CHECK(rig.motion_executor.tick(1e-3).velocity == Approx(15.0));
  rig.motion_executor.feed_override(0.0);
  for (int i = 0; i < 500; ++i) rig.motion_executor.tick(1e-3);
  CHECK(rig.motion_executor.tick(1e-3).at_rest);
  rig.motion_executor.feed_override(2.0);  // what the block bears is 30
  for (int i = 0; i < 500; ++i) rig.motion_executor.tick(1e-3);
  CHECK(rig.motion_executor.tick(1e-3).velocity == Approx(30.0));
}

TEST_CASE("an override that is not a number is a hold") {
  Rig rig(8);
  rig.motion_executor.push(straight(100.0));
  run(rig.motion_executor, 1.0);
  rig.motion_executor.feed_override(std::numeric_limits<double>::quiet_NaN());
  run(rig.motion_executor, 0.5);
  const auto rest = rig.motion_executor.tick(1e-3);
  CHECK(rest.at_rest);
  CHECK(rest.along < 50.0);
  rig.motion_executor.feed_override(1.0);
  until_rest(rig.motion_executor);
  CHECK(rig.motion_executor.finished());
}

TEST_CASE("blocks go on coming however many are to be kept behind") {
  for (const std::int64_t keep : {std::int64_t{-5}, std::int64_t{24}, std::int64_t{1} << 60}) {
    CAPTURE(keep);
    Rig rig(8, keep);  // memory for 24 blocks
    int pushed = 0;
    for (int tick = 0; tick < 20000 && pushed < 100; ++tick) {
      while (pushed < 100 && rig.motion_executor.push(straight(0.5))) ++pushed;
      rig.motion_executor.tick(1e-3);
    }
    CHECK(pushed == 100);
    until_rest(rig.motion_executor);
    CHECK(rig.motion_executor.finished());
    CHECK(rig.motion_executor.tick(1e-3).block == 99);
  }
}

TEST_CASE("backwards it comes to rest where the oldest block begins, whenever it is told") {
  constexpr double length = 0.02, period = 1e-3;
  for (int told = 20; told < 300; ++told) {
    CAPTURE(told);
    Rig rig(32, 4);
    int pushed = 0;
    const auto go = [&](double seconds) {
      while (pushed < 1000 && rig.motion_executor.push(straight(length))) ++pushed;
      return rig.motion_executor.tick(seconds);
    };
    for (int tick = 0; tick < told; ++tick) go(period);
    rig.motion_executor.backwards(true);
    detail::MotionSetPoint before = go(0.07);  // comes to rest, some blocks further on, and turns
    const auto place_of = [](const detail::MotionSetPoint& now) {
      return length * static_cast<double>(now.block) + now.along;
    };
    double jump = 0;
    for (int tick = 0; tick < 300; ++tick) {
      const auto now = go(period);
      const double way = period * (before.velocity + now.velocity) / 2;
      jump = std::max(jump, std::abs(place_of(now) - place_of(before) - way));
      before = now;
    }
    CHECK(jump < limits.jerk * period * period * period / 4);
    CHECK(before == detail::MotionSetPoint{rig.motion_executor.oldest(), 0.0, 0.0, 0.0, 0.0, true});
  }
}

TEST_CASE("backwards as far as blocks are kept, and forwards again") {
  Rig rig(8, 4);
  for (int i = 0; i < 4; ++i) rig.motion_executor.push(straight(5.0));
  for (int i = 0; i < 500; ++i) rig.motion_executor.tick(1e-3);
  rig.motion_executor.backwards(true);
  double lowest = 0.0;
  detail::MotionSetPoint now;
  for (int i = 0; i < 2000; ++i) lowest = std::min(lowest, (now = rig.motion_executor.tick(1e-3)).velocity);
  CHECK(lowest == Approx(-30.0));
  CHECK(now == detail::MotionSetPoint{0, 0.0, 0.0, 0.0, 0.0, true});
  rig.motion_executor.backwards(false);
  until_rest(rig.motion_executor);
  CHECK(rig.motion_executor.finished());
}

TEST_CASE("single step, optional stops and pauses at a line") {
  Rig rig(8);
  for (int i = 0; i < 4; ++i) {
    auto block = straight(5.0, i + 1);
    block.optional_stop = i == 2;
    rig.motion_executor.push(block);
  }
  rig.motion_executor.single_step(true);
  until_rest(rig.motion_executor);
  CHECK(rig.motion_executor.tick(1e-3) == detail::MotionSetPoint{1, 0.0, 0.0, 0.0, 0.0, true});
  rig.motion_executor.single_step(false);
  rig.motion_executor.pause_at(3);
  rig.motion_executor.resume();
  until_rest(rig.motion_executor);
  CHECK(rig.motion_executor.tick(1e-3).block == 2);
  rig.motion_executor.optional_stop(true);
  rig.motion_executor.resume();
  until_rest(rig.motion_executor);
  CHECK(rig.motion_executor.tick(1e-3).block == 3);
  CHECK_FALSE(rig.motion_executor.finished());
  rig.motion_executor.resume();
  until_rest(rig.motion_executor);
  CHECK(rig.motion_executor.finished());
}

TEST_CASE("a quick stop has limits of its own") {
  Rig rig(8);
  rig.motion_executor.push(straight(100.0));
  for (int i = 0; i < 500; ++i) rig.motion_executor.tick(1e-3);
  rig.motion_executor.quick_stop(5.0);
  const auto best = profile::stop({30.0, 0.0}, Limits{30.0, 5000.0, 5e4});
  CHECK(until_rest(rig.motion_executor) == Approx(best->duration()).margin(1.1e-4));
  rig.motion_executor.resume();
  until_rest(rig.motion_executor);
  CHECK(rig.motion_executor.finished());
}

TEST_CASE("a quick stop with no more than the blocks' limits is a hold") {
  const auto place = [](const detail::MotionSetPoint& now) {
    return 50.0 * static_cast<double>(now.block) + now.along;
  };
  for (const double at : {20.0, 97.9, 98.5, 99.5}) {
    CAPTURE(at);
    Rig rig(8);
    rig.motion_executor.push(straight(50.0));
    auto last = straight(50.0);
    last.segment_limits.limits.acceleration /= 2;
    rig.motion_executor.push(last);
    detail::MotionSetPoint now;
    do now = rig.motion_executor.tick(1e-4);
    while (place(now) < at);
    const auto best =
        profile::stop({now.velocity, now.acceleration}, at < 50.0 ? limits : last.segment_limits.limits);
    REQUIRE(best);
    const double from = place(now);
    double moved = 0.0;
    rig.motion_executor.quick_stop(std::numeric_limits<double>::quiet_NaN());
    while (!now.at_rest) {
      const double before = now.velocity;
      now = rig.motion_executor.tick(1e-4);
      moved += (before + now.velocity) / 2 * 1e-4;
    }
    CHECK(place(now) - from == Approx(moved).margin(1e-3));
    CHECK(moved == Approx(best->length()).margin(1e-3));
    rig.motion_executor.resume();
    until_rest(rig.motion_executor);
    CHECK(rig.motion_executor.finished());
  }
}

TEST_CASE("in float it holds, goes on, waits for dwells once and ends at the end") {
  for (const float shortest : {0.3F, 1.1F, 2.3F, 4.7F, 9.1F}) {
    CAPTURE(shortest);
    BasicRig<float> rig(8);
    const BasicLimits<float> narrow{30.0F, 1000.0F, 10000.0F};
    constexpr int count = 12;
    constexpr float dwell = 0.25F;
    const auto length = [&](int i) { return shortest + 0.7F * static_cast<float>(i % 5); };
    for (int i = 0; i < count; ++i)
      rig.motion_executor.push({{length(i), 1e3F, narrow, i % 4 == 3 ? dwell : 0.0F}, 30.0F});
    int waited = 0;
    float before = 0.0F, fastest = 0.0F, hardest = 0.0F;
    for (int tick = 0; tick < 20000 && !rig.motion_executor.finished(); ++tick) {
      if (tick == 80 || tick == 1000) rig.motion_executor.hold();
      if (tick == 300 || tick == 1200) rig.motion_executor.resume();
      const float speed = rig.motion_executor.tick(1e-3F).velocity;
      waited += speed == 0.0F && !(rig.motion_executor.rested() > 0.0F) ? 1 : 0;
      fastest = std::max(fastest, speed);
      hardest = std::max(hardest, std::abs(speed - before) / 1e-3F);
      before = speed;
    }
    CHECK(waited == Approx(3 * dwell / 1e-3F).margin(8));
    CHECK(fastest < 30.0F * (1 + 1e-5F));
    CHECK(hardest < 1000.0F * (1 + 1e-2F));
    const auto end = rig.motion_executor.tick(1e-3F);
    CHECK(end.block == count - 1);
    CHECK(end.along == length(count - 1));
  }
}

TEST_CASE("in float a hold brakes on where it comes to other limits at next to no speed") {
  constexpr float period = 1e-3F, jerk = 8000.0F;  // the highest
  for (int hold = 1; hold < 30; ++hold) {
    CAPTURE(hold);
    BasicRig<float> rig(8);
    rig.motion_executor.push({{0.011F, 1e3F, {30.0F, 400.0F, 5000.0F}, 0.0F}, 30.0F});
    rig.motion_executor.push({{0.024F, 1e3F, {30.0F, 300.0F, 1000.0F}, 0.0F}, 30.0F});
    rig.motion_executor.push({{0.054F, 1e3F, {30.0F, 500.0F, jerk}, 0.0F}, 30.0F});
    float before = 0.0F;
    for (int tick = 0; tick < 200; ++tick) {
      if (tick == hold) rig.motion_executor.hold();
      const auto now = rig.motion_executor.tick(period);
      CHECK(std::abs(now.acceleration - before) <= jerk * period * 1.001F);
      before = now.acceleration;
      if (now.at_rest) rig.motion_executor.resume();
    }
    CHECK(rig.motion_executor.finished());
  }
}

TEST_CASE("a dwell is waited for") {
  Rig rig(8);
  auto block = straight(1.0);
  block.segment_limits.pause = 0.5;
  rig.motion_executor.push(block);
  auto next = straight(1.0);
  next.segment_limits.entry = 0.0;
  rig.motion_executor.push(next);
  int ticks = 0;
  while (!rig.motion_executor.finished() && ticks < 10000) rig.motion_executor.tick(1e-3), ++ticks;
  const double move = profile::seven_phase(1.0, {0.0, 0.0}, limits)->duration();
  CHECK(ticks * 1e-3 == Approx(2 * move + 0.5).margin(2e-3));
}

TEST_CASE("a hold on the way down to a dwell does not swallow it") {
  for (const double before_end : {0.02, 0.05, 0.08}) {
    CAPTURE(before_end);
    Rig rig(8);
    auto block = straight(10.0);
    block.segment_limits.pause = 0.5;
    rig.motion_executor.push(block);
    rig.motion_executor.push(straight(1.0));
    const double move = profile::seven_phase(10.0, {0.0, 0.0}, limits)->duration();
    run(rig.motion_executor, move - before_end);
    rig.motion_executor.hold();
    run(rig.motion_executor, before_end + 0.4);
    CHECK(rig.motion_executor.rested() == 0.0);
    rig.motion_executor.resume();
    CHECK(run(rig.motion_executor, 0.09).at_rest);
    CHECK_FALSE(run(rig.motion_executor, 0.02).at_rest);
    until_rest(rig.motion_executor);
    CHECK(rig.motion_executor.finished());
  }
}

TEST_CASE("ticks allocate nothing") {
  test::Random random;
  const auto program = test::random_motion_program(random, 50).blocks;
  Rig rig(64);
  const auto allocations = test::heap_allocations_of([&] {
    for (const auto& block : program) rig.motion_executor.push(block);
    for (int tick = 0; tick < 5000; ++tick) {
      if (tick % 10 == 0) rig.motion_executor.feed_override(0.5 + (tick % 7) * 0.1);
      rig.motion_executor.tick(1e-3);
    }
  });
  CHECK(allocations == 0);
}
