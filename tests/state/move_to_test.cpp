// Moves of several axes: the tables of another library's durations, synchronisation, velocities, travel.
#include "cncplan/move_to.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "cncplan/core/error_text.hpp"
#include "state/axis_case.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"
#include "support/random.hpp"
#include "support/shared.hpp"

using namespace cncplan;

namespace {

const Machine<3> mill{.axes = {{{.letter = 'X', .velocity = 100, .acceleration = 1000, .jerk = 20000},
                                {.letter = 'Y', .velocity = 100, .acceleration = 1000, .jerk = 20000},
                                {.letter = 'Z', .velocity = 20, .acceleration = 300, .jerk = 5000}}}};

const Axis slide{.velocity = 30, .acceleration = 300, .jerk = 10000, .low = -10, .high = 100};

// Rows of start p v a, target p v a, limits V A J for each of N axes, then the duration.
template <int N>
void compare(const char* table, int rows) {
  const auto shared = test::shared();
  if (!shared) {
    WARN("SKIPPED: CNCPLAN_SHARED is not set");
    return;
  }
  std::ifstream file(*shared + "/data/" + table);
  std::string line;
  std::getline(file, line);
  int read = 0;
  double slowest = 0, worst = 0, excess = 0;
  while (std::getline(file, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream stream(line);
    std::array<test::AxisCase, N> cases;
    AxisStates<N> from, to;
    Machine<N> machine;
    for (std::size_t i = 0; i < N; ++i) {
      std::array<double, 9> x{};
      for (double& value : x) stream >> value;
      cases[i] = {{x[0], x[1], x[2]}, {x[3], x[4], x[5]}, {x[6], x[6], x[7], x[7], x[8]}};
      from.set(i, cases[i].from), to.set(i, cases[i].to);
      machine.axes[i].velocity = x[6], machine.axes[i].acceleration = x[7], machine.axes[i].jerk = x[8];
    }
    double listed = 0;
    stream >> listed;
    const auto move = move_to(from, to, machine);
    REQUIRE(move);
    slowest = std::max(slowest, move->duration() / listed - 1);
    for (std::size_t i = 0; i < N; ++i) {
      const auto errors = test::examine(cases[i], move->axis(i));
      worst = std::max(worst, errors.target());
      excess = std::max(excess, errors.limits());
      CHECK(move->axis(i).duration() == Approx(move->duration()).epsilon(1e-13));
    }
    ++read;
  }
  CHECK(read == rows);
  CHECK(slowest < 1e-12);
  CHECK(worst < 1e-11);
  CHECK(excess < 1e-12);
}

}  // namespace

TEST_CASE("one axis is no slower than the other library in a thousand cases") {
  compare<1>("states_1axis.csv", 1000);
}

TEST_CASE("three axes together are no slower than the other library in five hundred cases") {
  compare<3>("states_3axes.csv", 500);
}

TEST_CASE("three axes to a target and, in mid-motion, to another") {
  AxisStates<3> now{};
  auto move = move_to(now, {100, 50, -10}, mill);
  REQUIRE(move);
  const AxisStates<3> before = move->at(0.4);
  for (int k = 0; k < 400; ++k) move->advance(0.001);
  CHECK(move->state().position[0] == Approx(before.position[0]).epsilon(1e-12));
  move = move_to(move->state(), {-20, 80, 0}, mill);
  REQUIRE(move);
  CHECK(move->at(0).velocity[0] == Approx(before.velocity[0]).epsilon(1e-12));
  CHECK(move->at(move->duration()).position[1] == Approx(80));
  CHECK_FALSE(move->finished());
  move->advance(move->duration());
  CHECK(move->finished());
}

TEST_CASE("axes arrive at the earliest instant that all can meet") {
  test::Random random;
  int later = 0;
  for (int n = 0; n < 20000; ++n) {
    std::array<test::AxisCase, 3> cases;
    std::array<AxisLimits, 3> limits;
    AxisStates<3> from, to;
    double slowest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      cases[i] = test::draw_axis_case(random, random.integer(0, 9) == 0);
      limits[i] = cases[i].limits;
      from.set(i, cases[i].from), to.set(i, cases[i].to);
      slowest =
          std::max(slowest, state::axis_motions(cases[i].from, cases[i].to, limits[i])->fastest().duration());
    }
    const double least = random.integer(0, 3) == 0 ? slowest * random.uniform(0.5, 3.0) : 0.0;
    std::array<state::Motion, 3> motions;
    REQUIRE(state::make_synchronized<double, 3>(from, to, limits, {.minimum_duration = least}, motions));
    const double duration = motions.front().duration();
    for (std::size_t i = 0; i < 3; ++i) {
      INFO(cases[i].literal() << " in " << duration);
      const auto errors = test::examine(cases[i], motions[i]);
      if (errors.target() > 1e-11 || errors.limits() > 1e-11 ||
          duration < std::max(least, slowest) * (1 - 1e-13)) {
        CHECK(errors.target() < 1e-11);
        CHECK(errors.limits() < 1e-11);
        CHECK(duration >= std::max(least, slowest) * (1 - 1e-13));
      }
      if (std::abs(motions[i].duration() - duration) > 1e-12 * duration)
        CHECK(motions[i].duration() == Approx(duration).epsilon(1e-12));
    }
    if (duration <= std::max(slowest, least) * (1 + 1e-12)) continue;
    ++later;
    // no instant on a grid before it suits all
    for (int k = 0; k < 50; ++k) {
      const double earlier =
          std::max(slowest, least) + (duration * (1 - 1e-9) - std::max(slowest, least)) * k / 50;
      bool all = true;
      for (const auto& c : cases)
        all = all && state::axis_motions(c.from, c.to, c.limits)->duration_from(earlier) == earlier;
      CHECK_FALSE(all);
    }
  }
  CHECK(later > 20);
}

TEST_CASE("without synchronisation each axis arrives as soon as it can") {
  const auto move =
      move_to(AxisStates<3>{}, {100, 50, -10}, mill, {.synchronization = Synchronization::none});
  REQUIRE(move);
  for (std::size_t i = 0; i < 3; ++i) {
    const double target = std::array{100.0, 50.0, -10.0}[i];
    CHECK(move->axis(i).duration() ==
          Approx(move_to(AxisState{}, target, mill.axes[i])->duration()).epsilon(1e-14));
  }
  const auto slow = move_to(AxisStates<3>{}, {100, 50, -10}, mill,
                            {.synchronization = Synchronization::none, .minimum_duration = 1.0});
  CHECK(slow->axis(0).duration() == Approx(100.0 / 100 + 100.0 / 1000 + 1000.0 / 20000).epsilon(1e-13));
  CHECK(slow->axis(1).duration() == Approx(1.0).epsilon(1e-13));
}

TEST_CASE("in phase, rest to rest stays on the line where that costs no time") {
  const auto on_line = [](const auto& move, const std::array<double, 3>& to) {
    double off = 0;
    for (int k = 0; k <= 1000; ++k) {
      const auto p = move.at(move.duration() * k / 1000).position;
      for (std::size_t i = 1; i < 3; ++i) off = std::max(off, std::abs(p[i] - p[0] * to[i] / to[0]));
    }
    return off;
  };
  const MoveOptions phase{.synchronization = Synchronization::phase};
  const std::array<double, 3> to{100, 50, -10};
  const auto straight = move_to(AxisStates<3>{}, to, mill, phase);
  const auto timed = move_to(AxisStates<3>{}, to, mill);
  CHECK(straight->duration() == Approx(timed->duration()).epsilon(1e-13));
  CHECK(on_line(*straight, to) < 1e-12);
  CHECK(on_line(*timed, to) > 1e-3);
  const auto slow =
      move_to(AxisStates<3>{}, to, mill, {.synchronization = Synchronization::phase, .minimum_duration = 5});
  CHECK(slow->duration() == Approx(5).epsilon(1e-13));
  CHECK(on_line(*slow, to) < 1e-12);
  // Z has the least velocity, X the least acceleration for this line: together they would be slower
  const std::array<double, 3> mixed{10, 1, 4};
  const Machine<3> machine{.axes = {{{.velocity = 100, .acceleration = 100, .jerk = 20000},
                                     {.velocity = 100, .acceleration = 1000, .jerk = 20000},
                                     {.velocity = 4, .acceleration = 300, .jerk = 5000}}}};
  const auto apart = move_to(AxisStates<3>{}, mixed, machine, phase);
  CHECK(apart->duration() == move_to(AxisStates<3>{}, mixed, machine)->duration());
}

TEST_CASE("one axis takes plain numbers") {
  auto move = move_to(AxisState{1, 2, 0}, 5.0, slide);
  REQUIRE(move);
  const AxisState start = move->state();
  CHECK(start == AxisState{1, 2, 0});
  CHECK(move->at(move->duration()) == AxisState{5, 0, 0});
  CHECK(move->extrema().highest == 5.0);
  CHECK(*move->time_at(3.0) < move->duration());
  CHECK(move_to(AxisState{1, 2, 0}, {5, 1, 0}, slide)->at(1e9).velocity == 1.0);
  CHECK(move_to(AxisState{}, 5.0, slide, {.minimum_duration = 3})->duration() == Approx(3).epsilon(1e-14));
  CHECK(move_to(BasicAxisState<float>{}, 5.0F,
                BasicAxis<float>{.velocity = 30, .acceleration = 300, .jerk = 10000})
            ->at(1e9F)
            .position == 5.0F);
}

TEST_CASE("a start beyond the limits returns to them") {
  const Axis& axis = slide;
  const auto move = move_to(AxisState{0, 50, 500}, 80.0, axis);
  REQUIRE(move);
  // 500 are let go to 0 at 62.5 mm/s, and braking at 300 goes on from there
  const double high = 50 + 500.0 * 500 / 2 / 10000;
  double before = high + 1;
  bool braking = false;
  for (double t = 0; t < move->duration(); t += 1e-4) {
    const auto now = move->at(t);
    CHECK(now.velocity <= high * (1 + 1e-12));
    if (braking && now.velocity > axis.velocity * (1 + 1e-12)) CHECK(now.velocity <= before);
    braking = now.acceleration < 0;
    before = now.velocity;
  }
}

TEST_CASE("a velocity is reached as soon as possible and kept") {
  const auto jog =
      reach_velocity(AxisState{5, -10, 0}, 20.0, Axis{.velocity = 30, .acceleration = 300, .jerk = 10000});
  REQUIRE(jog);
  CHECK(jog->duration() == Approx(30.0 / 300 + 300.0 / 10000).epsilon(1e-14));
  const auto end = jog->at(jog->duration());
  CHECK(end.velocity == Approx(20.0).epsilon(1e-14));
  CHECK(jog->at(jog->duration() + 1).position == Approx(end.position + 20).epsilon(1e-13));
  const auto stop =
      reach_velocity(jog->at(0.05), 0.0, Axis{.velocity = 30, .acceleration = 300, .jerk = 10000});
  CHECK(stop->at(10).velocity == Approx(0).margin(1e-13));
  CHECK(stop->at(10).acceleration == 0);
}

TEST_CASE("axes reach their velocities at once, or each as soon as it can") {
  test::Random random;
  for (int n = 0; n < 20000; ++n) {
    std::array<test::AxisCase, 3> cases;
    std::array<AxisLimits, 3> limits;
    std::array<double, 3> velocities{};
    AxisStates<3> from;
    for (std::size_t i = 0; i < 3; ++i) {
      cases[i] = test::draw_axis_case(random, random.integer(0, 4) == 0);
      limits[i] = cases[i].limits;
      velocities[i] = cases[i].to.velocity;
      from.set(i, cases[i].from);
    }
    const double least = random.coin() ? random.log_uniform(1e-3, 1e2) : 0.0;
    const auto together =
        state::reach_velocities<double, 3>(from, velocities, limits, {.minimum_duration = least});
    const auto apart =
        state::reach_velocities<double, 3>(from, velocities, limits, {Synchronization::none, 0});
    REQUIRE(together);
    REQUIRE(apart);
    double slowest = least;
    for (const auto& motion : *apart) slowest = std::max(slowest, motion.duration());
    for (std::size_t i = 0; i < 3; ++i)
      for (const auto* motions : {&*together, &*apart}) {
        const auto& motion = (*motions)[i];
        test::AxisCase c = cases[i];
        c.to = {motion.end().position, velocities[i], 0};
        const auto errors = test::examine(c, motion);
        INFO(c.literal() << " in " << motion.duration());
        if (errors.target() > 1e-11 || errors.limits() > 1e-11)
          CHECK(errors.target() + errors.limits() < 1e-11);
        if (motions == &*together && std::abs(motion.duration() - slowest) > 1e-12 * slowest)
          CHECK(motion.duration() == Approx(slowest).epsilon(1e-12));
      }
  }
}

TEST_CASE("a jog comes to rest at the end of travel") {
  const auto jog = reach_velocity(AxisState{50, 0, 0}, 20.0, slide);
  REQUIRE(jog);
  CHECK(jog->at(1e3) == AxisState{100, 0, 0});
  CHECK(jog->extrema().highest <= 100);
  CHECK(jog->at(0.5).velocity == Approx(20).epsilon(1e-13));
  const auto down = reach_velocity(AxisState{50, 10, 0}, -20.0, slide);
  CHECK(down->at(1e3) == AxisState{-10, 0, 0});
  // no room to reach 20 mm/s
  const auto near = reach_velocity(AxisState{99.9, 0, 0}, 20.0, slide);
  REQUIRE(near);
  CHECK(near->at(1e3) == AxisState{100, 0, 0});
  CHECK(near->extrema().highest <= 100);
  // faster than the jog, close to the end: it brakes at once
  const auto fast = reach_velocity(AxisState{97, 29, 0}, 20.0, slide);
  REQUIRE(fast);
  CHECK(fast->at(1e3) == AxisState{100, 0, 0});
  CHECK(fast->extrema().highest <= 100 + 1e-12);
}

TEST_CASE("travel is kept, or refused by name") {
  CHECK(move_to(AxisState{}, 101.0, slide).error() ==
        Error{ErrorCode::above_limit, "target position", 101, 100});
  CHECK(move_to(AxisState{}, -11.0, slide).error() ==
        Error{ErrorCode::below_limit, "target position", -11, -10});
  const auto late = reach_velocity(AxisState{99.5, 29, 0}, 0.0, slide);
  REQUIRE_FALSE(late);
  CHECK(late.error().code == ErrorCode::above_limit);
  CHECK(late.error().field == "stopping position");
  Axis endless = slide;
  endless.high = Axis::infinity;
  CHECK(late.error().value ==
        Approx(reach_velocity(AxisState{99.5, 29, 0}, 0.0, endless)->at(9).position).epsilon(1e-14));
  CHECK(late.error().bound == 100);
  CHECK(to_text(late.error()).substr(0, 25) == "stopping position: 101.33");
  // to go down at 29 mm/s through 99.9 it would have to come from beyond 100
  const auto run_up = move_to(AxisState{}, {99.9, -29, 0}, slide);
  REQUIRE_FALSE(run_up);
  CHECK(run_up.error().field == "position on the way");
  CHECK(move_to(AxisState{}, {99.9, 0, 0}, slide));
}

TEST_CASE("an axis beyond its travel comes back, and goes no further") {
  const AxisState beyond{105, 0, 0};
  const auto back = move_to(beyond, 50.0, slide);
  REQUIRE(back);
  CHECK(back->extrema().highest == Approx(105));
  CHECK(back->at(1e3).position == 50);
  CHECK(move_to(beyond, 103.0, slide));
  CHECK(move_to(beyond, 106.0, slide).error() == Error{ErrorCode::above_limit, "target position", 106, 105});
  const auto inwards = reach_velocity(beyond, -5.0, slide);
  REQUIRE(inwards);
  CHECK(inwards->at(1e3).position == Approx(-10));
  // Outwards it stays where it is.
  const auto outwards = reach_velocity(beyond, 5.0, slide);
  REQUIRE(outwards);
  CHECK(outwards->at(1e3).position == Approx(105));
  CHECK(outwards->extrema().lowest == Approx(105));
  // Moving outwards it has left the place where it could stay.
  CHECK(reach_velocity(AxisState{105, 1, 0}, 0.0, slide).error().field == "stopping position");
}

TEST_CASE("what is wrong with a move is named") {
  const auto error = [](const MoveOptions& options) {
    return move_to(AxisState{}, 1.0, slide, options).error();
  };
  CHECK(error({.minimum_duration = -1}) == Error{ErrorCode::negative, "minimum duration", -1, 0});
  CHECK(error({.minimum_duration = INFINITY}).code == ErrorCode::not_finite);
  CHECK(to_text(move_to(AxisState{}, 1.0, Axis{.letter = 'X'}).error()) ==
        "velocity limit: inf is not a finite number");
  CHECK(to_text(move_to(AxisState{}, {0, 40, 0}, slide).error()) ==
        "target velocity: 40 is above the limit 30");
}

TEST_CASE("moves take nothing off the heap") {
  const AxisStates<3> from{.velocity = {10, -20, 3}};
  CHECK(test::heap_allocations_of([&] {
          auto move = move_to(from, {100, 50, -10}, mill);
          auto jog = reach_velocity(from, {1, 2, 3}, mill);
          move->advance(0.1), jog->advance(0.1);
        }) == 0);
}
