// Jogs before a program, on the way and behind it, and the way back.
#include <algorithm>
#include <cmath>
#include <memory>

#include "cncplan/executor_levels.hpp"
#include "support/catch.hpp"
#include "support/executor_check.hpp"
#include "support/small_mill.hpp"

using namespace cncplan;
using test::Lines, test::load, test::tick_time, test::run, test::SmallRunner;

namespace {

constexpr Machine<3> mill = test::small_mill;

}  // namespace

TEST_CASE("hold, jog away, return, resume", "[executor]") {
  SmallRunner executor(mill);
  load(executor, {"G1 X20 F1200", "Y20"});
  CHECK_FALSE(executor.jog({0, 0, 5}));
  run(executor, 0.5);
  CHECK(executor.jog({0, 0, 5}).error().code == ErrorCode::unfinished);
  executor.feed_hold();
  const Vector3 held = run(executor, 0.5).position;
  REQUIRE(executor.jog({0, 0, 5}));
  auto point = run(executor, 1.0);
  CHECK(point.velocity[2] == Approx(5));
  CHECK(point.tool == point.position);
  REQUIRE(executor.jog({0, 0, 0}));
  run(executor, 1.0);
  REQUIRE(executor.jog_to({held[0] + 3, 4, 7}));
  CHECK(run(executor, 3.0).position == Vector3(held[0] + 3, 4, 7));
  CHECK(executor.jog_to({101, 0, 0}).error().code == ErrorCode::above_limit);
  const bool by_hand = GENERATE(false, true);
  if (by_hand) {
    REQUIRE(executor.return_to_path());
    CHECK((run(executor, 2.0).position - held).norm() < 1e-12);
  }
  executor.resume();
  // continuous, and each axis in its limits all the way
  auto before = executor.tick(tick_time);
  while (!executor.finished()) {
    point = executor.tick(tick_time);
    for (int i = 0; i < 3; ++i) {
      const auto& axis = mill.axes[static_cast<std::size_t>(i)];
      CHECK(std::abs(point.position[i] - before.position[i]) <= axis.velocity * tick_time * (1 + 1e-9));
      if (point.line != before.line) continue;
      CHECK(std::abs(point.velocity[i] - before.velocity[i]) <= axis.acceleration * tick_time * (1 + 1e-9));
    }
    before = point;
  }
  CHECK((point.position - Vector3(20, 20, 0)).norm() < 1e-12);
}

TEST_CASE("axes go back to where the program was left though more words follow than there is room",
          "[executor]") {
  const double tolerance = GENERATE(0.0, 0.01);
  const bool by_hand = GENERATE(false, true);
  const int words = GENERATE(15, 16, 17, 18, 100);
  CAPTURE(tolerance, by_hand, words);
  Lines lines{"G1 X20 F1200"};
  lines.insert(lines.end(), static_cast<std::size_t>(words), "M8");
  lines.emplace_back("Y20");
  const auto blocks = test::blocks_of(lines, mill);
  SmallRunner executor(mill, {.tolerance = tolerance});
  std::size_t pushed = 0;
  SetPoint<3> point;
  const auto run_up_to = [&](std::size_t last, double seconds) {
    for (int tick = 0; tick < seconds / tick_time; ++tick) {
      while (pushed < last && executor.push(blocks[pushed]))
        if (++pushed == blocks.size()) executor.end_of_program();
      point = executor.tick(tick_time);
    }
  };
  run_up_to(blocks.size() - 1, 2.0);
  CHECK(point.position == Vector3(20, 0, 0));
  REQUIRE(executor.jog_to({15, 4, 2}));
  run_up_to(blocks.size() - 1, 2.0);
  CHECK(point.position == Vector3(15, 4, 2));
  by_hand ? void(executor.return_to_path()) : executor.resume();
  run_up_to(blocks.size() - 1, 2.0);
  CHECK((point.position - Vector3(20, 0, 0)).norm() < 1e-12);
  run_up_to(blocks.size(), 3.0);
  CHECK(executor.finished());
  CHECK((point.position - Vector3(20, 20, 0)).norm() < 1e-12);
  // over, and away again: it is not over before the axes are back, whatever is kept of the program
  REQUIRE(executor.jog({5, 0, 0}));
  run_up_to(blocks.size(), 1.0);
  CHECK_FALSE(executor.finished());
  executor.resume();
  run_up_to(blocks.size(), 2.0);
  CHECK(executor.finished());
  CHECK((point.position - Vector3(20, 20, 0)).norm() < 1e-12);
  // a new beginning has no place to go back to
  REQUIRE(executor.restart(0, {1, 1, 1}));
  REQUIRE(executor.jog_to({2, 2, 2}));
  run_up_to(blocks.size(), 2.0);
  REQUIRE(executor.return_to_path());
  run_up_to(blocks.size(), 2.0);
  CHECK(point.position == Vector3(2, 2, 2));
}

TEST_CASE("a program that ends with words is not over while the axes are away", "[executor]") {
  const int words = GENERATE(10, 40);
  CAPTURE(words);
  Lines lines{"G1 X20 F1200"};
  lines.insert(lines.end(), static_cast<std::size_t>(words), "M8");
  const auto blocks = test::blocks_of(lines, mill);
  SmallRunner executor(mill);
  std::size_t pushed = 0;
  for (int tick = 0; tick < 3000; ++tick) {
    while (pushed < blocks.size() && executor.push(blocks[pushed]))
      if (++pushed == blocks.size()) executor.end_of_program();
    executor.tick(tick_time);
  }
  REQUIRE(executor.finished());
  REQUIRE(executor.jog({0, 0, 5}));
  run(executor, 0.5);
  CHECK_FALSE(executor.finished());
  executor.resume();
  CHECK(run(executor, 3.0).position == Vector3(20, 0, 0));
  CHECK(executor.finished());
}

TEST_CASE("axes are jogged from the start of a program that has not begun", "[executor]") {
  const Vector3 start(50, -20, 5);
  PlanOptions options;
  std::copy(start.begin(), start.end(), options.start.begin());
  const auto blocks = test::blocks_of({"G1 X60 F1200", "Y0"}, mill, options);
  SmallRunner executor(mill);
  for (const auto& block : blocks) REQUIRE(executor.push(block));
  REQUIRE(executor.jog({0, 0, 5}));
  CHECK((executor.tick(tick_time).position - start).norm() < 0.01);
  executor.end_of_program();
  run(executor, 0.3);
  executor.resume();
  CHECK(run(executor, 5.0).position == Vector3(60, 0, 5));
  CHECK(executor.finished());
}

TEST_CASE("blocks that wait for others go on soon behind a restart or a jog too", "[executor]") {
  const bool restarts = GENERATE(false, true);
  CAPTURE(restarts);
  const auto blocks = test::blocks_of({"F1200", "G1 X5", "Y5"}, mill);
  SmallRunner executor(mill, {.tolerance = 0.05});
  if (restarts) {
    REQUIRE(executor.restart(0, {0, 0, 0}));
  } else {
    REQUIRE(executor.jog_to({0, 0, 1}));
    run(executor, 0.02);
  }
  for (const auto& block : blocks) REQUIRE(executor.push(block));
  executor.resume();
  CHECK(run(executor, 5.0).position == Vector3(5, 5, 0));
}

TEST_CASE("a jog that goes on for ever is ended by resume, and by every stop", "[executor]") {
  SmallRunner executor(mill, {.quick_stop_share = 3});
  load(executor, {"G1 X20 F1200", "Y20"});
  run(executor, 0.5);
  executor.feed_hold();
  run(executor, 0.5);
  REQUIRE(executor.jog({0, 0, 10}));
  auto before = run(executor, 1.0);
  SECTION("resume takes the axes back while they move") {
    executor.resume();
    CHECK((run(executor).position - Vector3(20, 20, 0)).norm() < 1e-12);
    CHECK(executor.finished());
  }
  SECTION("a hold on the way back rests there, and resume goes on") {
    executor.resume();
    run(executor, 0.3);
    executor.feed_hold();
    const auto held = run(executor, 0.5);
    CHECK(held.velocity.isZero());
    CHECK(held.position[2] > 0.1);
    CHECK(run(executor, 0.5).position == held.position);
    executor.resume();
    CHECK((run(executor).position - Vector3(20, 20, 0)).norm() < 1e-12);
  }
  SECTION("hold, stop and quick stop") {
    const int how = GENERATE(0, 1, 2);
    const double share = how == 2 ? 3 : 1;
    how == 0 ? executor.feed_hold() : how == 1 ? executor.stop() : executor.quick_stop();
    int ticks = 0;
    for (; ticks < 1000 && !before.velocity.isZero(); ++ticks) {
      CHECK_FALSE(executor.finished());
      executor.feed_hold();  // asked again and again: no less for it
      const auto point = executor.tick(tick_time);
      CHECK(std::abs(point.acceleration[2] - before.acceleration[2]) <=
            share * 5000 * tick_time * (1 + 1e-9));
      before = point;
    }
    // from v under J, with an acceleration that peaks at sqrt(v J)
    CHECK(ticks * tick_time == Approx(2 * std::sqrt(10 / (share * 5000))).margin(1.01 * tick_time));
    CHECK(executor.finished() == (how == 1));
  }
}

TEST_CASE("axes are jogged before a program, which waits until they are at its start", "[executor]") {
  SmallRunner executor(mill);
  REQUIRE(executor.jog_to({1, 2, 3}));
  CHECK(run(executor, 3.0).position == Vector3(1, 2, 3));
  load(executor, {"G1 X20 F1200"});
  CHECK(run(executor, 1.0).position == Vector3(1, 2, 3));
  executor.resume();
  CHECK(run(executor).position == Vector3(20, 0, 0));
  CHECK(executor.finished());
}

TEST_CASE("a jog to a place keeps the speeds that it is given, of the tool or of each axis", "[executor]") {
  const bool tool = GENERATE(true, false);
  SmallRunner executor(mill);
  const Vector3 place(12, -9, 4);
  const Vector3 axes(3, 2, 1), way = place.normalized();
  REQUIRE(
      executor.jog_to(place, tool ? SmallRunner::JogSpeed{.tool = 4} : SmallRunner::JogSpeed{.axes = axes}));
  double fastest = 0, off = 0;
  Vector3 most = Vector3::Zero();
  SetPoint<3> point;
  for (int tick = 0; tick < 20'000 && !(tick > 10 && executor.state() != ExecutorState::jogging); ++tick) {
    point = executor.tick(tick_time);
    fastest = std::max(fastest, point.velocity.norm());
    most = most.cwiseMax(point.velocity.cwiseAbs());
    off = std::max(off, (point.position - point.position.dot(way) * way).norm());
  }
  CHECK(point.position == place);
  if (tool) {
    CHECK(fastest == Approx(4).epsilon(1e-9));
    CHECK(off < 1e-9);
  } else {
    for (int i = 0; i < 3; ++i) CHECK(most[i] <= axes[i] * (1 + 1e-12));
    CHECK((most - axes).cwiseAbs().minCoeff() < 1e-9);  // one is as fast as it may be
  }
}

TEST_CASE("increments of a jog add up, however fast they come", "[executor]") {
  SmallRunner executor(mill);
  for (int click = 0; click < 5; ++click) {
    REQUIRE(executor.jog_by({1, 0, -0.5}, {.tool = 3}));
    run(executor, 0.02);
  }
  CHECK((run(executor, 10.0).position - Vector3(5, 0, -2.5)).norm() < 1e-12);
  REQUIRE(executor.jog({0, 2, 0}));
  const double y = run(executor, 1.0).position[1];
  REQUIRE(executor.jog_by({0, 1, 0}));  // from where it is: no target goes on
  CHECK(run(executor, 5.0).position[1] == Approx(y + 1).margin(1e-9));
  CHECK(executor.jog_by({1000, 0, 0}).error().code == ErrorCode::above_limit);
}

TEST_CASE("axes that stand still need no limits for jogs and for the way back", "[executor]") {
  const Machine<6> machine{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  using Runner = Executor<Machine<6>, 40>;
  for (const SmoothLevel level : {SmoothLevel::fast, SmoothLevel::good}) {
    CAPTURE(level);
    const auto executor = std::make_unique<Runner>(machine, LevelExecutorOptions{.level = level});
    Runner::Vector place = Runner::Vector::Zero();
    place[0] = 5;
    const auto run = [&](double seconds) {
      auto point = executor->tick(tick_time);
      for (double time = tick_time; time < seconds; time += tick_time) point = executor->tick(tick_time);
      return point;
    };
    REQUIRE(executor->jog_to(place));
    CHECK(run(2.0).position == place);
    Runner::Vector turn = place;
    turn[3] = 1;
    CHECK(executor->jog_to(turn).error().code == ErrorCode::not_finite);
    // Back to the path, and on.
    const auto blocks = test::blocks_of({"G1 X20 F1200"}, machine);
    const auto load = [&](const Runner::Vector& from) {
      REQUIRE(executor->restart(0, from));
      for (const auto& block : blocks) REQUIRE(executor->push(block));
      executor->end_of_program();
      executor->resume();
      return run(5.0);
    };
    CHECK(load(place).position[0] == 20.0);
    CHECK(executor->state() == ExecutorState::finished);
    CHECK_FALSE(executor->error());
    // An axis without limits is to go back, too: the way is refused, and the operator told.
    CHECK(load(turn).position == turn);
    REQUIRE(executor->error());
    if (level == SmoothLevel::good) CHECK(executor->error()->error().code == ErrorCode::not_finite);
    CHECK(executor->state() == ExecutorState::fault);
  }
}

TEST_CASE("an axis beyond its travel is jogged back", "[executor]") {
  Machine<3> machine = mill;
  machine.axes[0].high = 50;
  SmallRunner executor(machine);
  REQUIRE(executor.restart(0, {60, 0, 0}));
  CHECK(executor.jog_by({1, 0, 0}).error().code == ErrorCode::above_limit);
  REQUIRE(executor.jog_by({0, 5, 0}));
  CHECK(run(executor, 3.0).position == Vector3(60, 5, 0));
  REQUIRE(executor.jog_by({-5, 0, 0}));
  CHECK(run(executor, 3.0).position == Vector3(55, 5, 0));
  REQUIRE(executor.jog({-5, 0, 0}));
  CHECK(run(executor, 3.0).position[0] < 45);
}

TEST_CASE("a jog of no speed is refused", "[executor]") {
  SmallRunner executor(mill);
  CHECK(executor.jog_to({1, 0, 0}, {.tool = 0}).error().code == ErrorCode::not_positive);
  CHECK(executor.jog_to({1, 0, 0}, {.axes = {1, -1, 1}}).error().code == ErrorCode::not_positive);
  CHECK(executor.jog_by({1, 0, 0}, {.tool = std::nan("")}).error().code == ErrorCode::not_finite);
  CHECK(run(executor, 1.0).position == Vector3::Zero());
}

TEST_CASE("what is asked for during a quick stop of a jog begins at rest behind it", "[executor]") {
  constexpr double share = 5;
  const int request = GENERATE(0, 1, 2, 3, 4);
  const int ticks_before = GENERATE(1, 10, 20);
  CAPTURE(request, ticks_before);
  SmallRunner executor(mill, {.quick_stop_share = share});
  load(executor, {"G1 X20 F1200"});
  run(executor, 0.3);
  executor.feed_hold();
  const Vector3 held = run(executor, 0.5).position;
  const Vector3 away = held + Vector3(3, 0, 5);
  REQUIRE(executor.jog({20, 10, 0}));
  const Vector3 from = run(executor, 1.0).position;
  executor.quick_stop();
  const auto braking = run(executor, ticks_before * tick_time);
  REQUIRE(!braking.velocity.isZero());
  if (request == 0) REQUIRE(executor.jog({0, 0, 0}));
  if (request == 1) REQUIRE(executor.jog({-20, -10, 5}));
  if (request == 2) REQUIRE(executor.jog_to(away));
  if (request == 3) REQUIRE(executor.jog_to(from + Vector3(30, 0, 0)));
  if (request == 4) executor.resume();
  bool rested = false;
  auto before = braking;
  for (int tick = 0; tick < 6000; ++tick) {
    const auto point = executor.tick(tick_time);
    const double most = rested ? 1 : share;
    for (int i = 0; i < 3; ++i) {
      const auto& axis = mill.axes[static_cast<std::size_t>(i)];
      CHECK(std::abs(point.velocity[i]) <= axis.velocity * (1 + 1e-9));
      CHECK(std::abs(point.acceleration[i]) <= most * axis.acceleration * (1 + 1e-9));
      CHECK(std::abs(point.acceleration[i] - before.acceleration[i]) <=
            most * axis.jerk * tick_time * (1 + 1e-9));
      if (!rested) CHECK(point.velocity[i] * braking.velocity[i] >= 0);
    }
    rested = rested || point.velocity.isZero();
    before = point;
  }
  CHECK(rested);
  if (request == 0) CHECK(before.velocity.isZero());
  if (request == 1) CHECK(before.velocity.isApprox(Vector3(-20, -10, 5)));
  if (request == 2) CHECK(before.position.isApprox(away));
  if (request == 3) CHECK(before.position.isApprox(from + Vector3(30, 0, 0)));
  if (request == 4) CHECK((before.position.isApprox(Vector3(20, 0, 0)) && executor.finished()));
}

TEST_CASE("a stop takes back what waits for the end of a quick stop of a jog", "[executor]") {
  SmallRunner executor(mill, {.quick_stop_share = 5});
  REQUIRE(executor.jog({20, 0, 0}));
  run(executor, 1.0);
  executor.quick_stop();
  run(executor, 0.01);
  REQUIRE(executor.jog_to({90, 5, 5}));
  run(executor, 0.005);
  executor.feed_hold();
  const auto rest = run(executor, 1.0);
  CHECK(rest.velocity.isZero());
  CHECK(rest.position[1] == 0);
  REQUIRE(executor.jog_by({1, 0, 0}));  // from where it stands, not from where it was to go
  CHECK(run(executor, 2.0).position.isApprox(rest.position + Vector3(1, 0, 0)));
}
