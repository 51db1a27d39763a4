#include "cncplan/live_steps.hpp"

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "cncplan/executor_levels.hpp"
#include "cncplan/plan_blocks.hpp"
#include "support/catch.hpp"
#include "support/executor_check.hpp"

using namespace cncplan;

namespace {

Machine<3> stepped(double backlash = 0.0) {
  const step::Drive coarse{.steps_per_unit = 160, .backlash = backlash}, fine{.steps_per_unit = 400};
  return {
      .axes = {{{.letter = 'X', .velocity = 40, .acceleration = 800, .jerk = 20000, .motors = {coarse}},
                {.letter = 'Y', .velocity = 25, .acceleration = 400, .jerk = 9000, .motors = {fine, coarse}},
                {.letter = 'Z', .velocity = 8, .acceleration = 150, .jerk = 4000, .motors = {fine}}}},
      .limits = {.velocity = 35, .acceleration = 700, .jerk = 15000}};
}

constexpr std::array steps_per_unit{160.0, 400.0, 160.0, 400.0};

using Runner = Executor<Machine<3>, 32>;

std::unique_ptr<Runner> loaded(const Machine<3>& machine, const std::vector<ProgramBlock<Machine<3>>>& blocks,
                               double tolerance = 0.01) {
  auto executor = std::make_unique<Runner>(machine, Runner::Options{.tolerance = tolerance});
  executor->program_stop(false);
  for (const auto& block : blocks) REQUIRE(executor->push(block));
  executor->end_of_program();
  return executor;
}

// Between two set points inside one block: the polynomial of degree five that has both positions, velocities
// and accelerations.
double between(const SetPoint<3>& a, const SetPoint<3>& b, int axis, double period, double t) {
  const double p0 = a.position[axis], v0 = a.velocity[axis] * period,
               a0 = a.acceleration[axis] * period * period;
  const double p1 = b.position[axis], v1 = b.velocity[axis] * period,
               a1 = b.acceleration[axis] * period * period;
  const double u = t / period, w = 1 - u;
  const double h = 10 * u * u * u - 15 * u * u * u * u + 6 * u * u * u * u * u;
  const double up = u * w * w * w * (1 + 3 * u), down = -w * u * u * u * (1 + 3 * w);
  return p0 + (p1 - p0) * h + v0 * up + v1 * down + a0 * u * u * w * w * w / 2 + a1 * u * u * u * w * w / 2;
}

}  // namespace

TEST_CASE("edges of an executor are those of the plan of the whole", "[live]") {
  test::Random random;
  const auto machine = stepped();
  int the_same = 0;
  for (int sequence = 0; sequence < 20; ++sequence) {
    const auto lines = test::random_lines(random, random.integer(1, 20), {0, 0, 0}, 20, "");
    const auto blocks = test::blocks_of(lines, machine);
    CAPTURE(sequence, test::literal(lines));
    const auto planned = plan_blocks(blocks, machine, {.tolerance = 0});
    REQUIRE(planned);
    std::array<std::vector<MotorEdge>, 4> expected, found;
    for (const MotorEdge& edge : planned->step_edges()) expected[edge.motor].push_back(edge);
    const auto executor = loaded(machine, blocks, 0);
    LiveSteps steps(*executor);
    REQUIRE(steps.motor_count() == 4);
    double end = 0.0;
    while (!executor->finished()) {
      end = steps.tick(1e-3).time;
      while (const auto edge = steps.next()) found[edge->motor].push_back(*edge);
    }
    // The ways that an executor finds anew from where it is can be others: there are no times to compare
    // then.
    end -= executor->rested();
    CHECK(end == Approx(planned->duration()).epsilon(0.06));
    const bool same = std::abs(end - planned->duration()) < 1e-9;
    the_same += same ? 1 : 0;
    for (std::size_t motor = 0; motor < 4; ++motor) {
      CAPTURE(motor);
      REQUIRE(found[motor].size() == expected[motor].size());
      for (std::size_t i = 0; i < found[motor].size(); ++i) {
        CHECK(found[motor][i].direction == expected[motor][i].direction);
        CHECK(found[motor][i].axis == expected[motor][i].axis);
        if (!same) continue;
        // The first edge behind a reversal waits for the hysteresis, or for the end of a piece, and the
        // pieces of an executor are not those of the plan: what is late is so by no more than that way.
        const double late = found[motor][i].time - expected[motor][i].time;
        const int axis = expected[motor][i].axis;
        const double way = planned->at(found[motor][i].time).position[axis] -
                           planned->at(expected[motor][i].time).position[axis];
        CHECK((std::abs(late) < 2e-6 || std::abs(way) * steps_per_unit[motor] < 1e-4 + 1e-6));
      }
    }
  }
  CHECK(the_same >= 15);
}

TEST_CASE("edges come where the axes pass their boundaries, whatever is asked", "[live]") {
  test::Random random;
  const auto machine = stepped();
  constexpr double period = 1e-3;
  for (int sequence = 0; sequence < 20; ++sequence) {
    const auto lines = test::random_lines(random, random.integer(1, 20), {0, 0, 0}, 20, "");
    const auto blocks = test::blocks_of(lines, machine);
    CAPTURE(sequence, test::literal(lines));
    const auto executor = loaded(machine, blocks);
    LiveSteps steps(*executor);
    std::array<std::int64_t, 4> counts{};
    SetPoint<3> before{};
    double worst = 0.0, farthest = 0.0;
    bool ordered = true;
    for (int tick = 0; !executor->finished() && tick < 1'000'000; ++tick) {
      if (tick < 800 && random.integer(0, 19) == 0) test::ask(*executor, random, blocks.back().line);
      if (tick == 800) test::calm(*executor);
      const SetPoint<3> now = steps.tick(period);
      double time = now.time - period;
      while (const auto edge = steps.next()) {
        ordered = ordered && edge->time >= time - 1e-12 && edge->time <= now.time + 1e-12;
        time = edge->time;
        const std::size_t m = edge->motor;
        const double boundary = (static_cast<double>(counts[m]) + edge->direction / 2.0) / steps_per_unit[m];
        counts[m] += edge->direction;
        const bool inside = now.block == before.block && now.along.velocity * before.along.velocity > 0;
        if (inside)
          worst = std::max(worst,
                           std::abs(between(before, now, edge->axis, period, time - before.time) - boundary));
      }
      for (std::size_t m = 0; m < 4; ++m) {
        const int axis = std::array{0, 1, 1, 2}[m];
        const double off = now.position[axis] * steps_per_unit[m] - static_cast<double>(counts[m]);
        farthest = std::max(farthest, std::abs(off));
        CHECK(steps.count(m) == counts[m]);
      }
      before = now;
    }
    CHECK(ordered);
    CHECK(executor->finished());
    CHECK(worst < 2e-6);           // mm; the polynomial is off by the jerk's jumps
    CHECK(farthest < 0.5 + 2e-4);  // steps, with the hysteresis
  }
}

TEST_CASE("backlash is taken up where an axis turns round, by all motors that have some", "[live]") {
  const auto machine = stepped(0.05);  // 8 steps
  const auto blocks = test::blocks_of({"G1 X10 F1200", "X4", "X6"}, machine);
  const auto executor = loaded(machine, blocks);
  LiveSteps steps(*executor);
  int edges = 0, net = 0;
  double last = 0.0;
  while (!executor->finished()) {
    steps.tick(1e-3);
    while (const auto edge = steps.next()) {
      CHECK(edge->time >= last);
      last = edge->time;
      if (edge->motor == 0) ++edges, net += edge->direction;
    }
  }
  CHECK(edges == 1600 + 960 + 320 + 2 * 8);
  CHECK(net == 960);
  CHECK(steps.count(0) == 960);
}

TEST_CASE("a jog steps too", "[live]") {
  const auto machine = stepped();
  Runner executor(machine);
  LiveSteps steps(executor);
  REQUIRE(executor.jog_to({2, -1, 0.5}));
  std::array<int, 4> net{};
  for (int tick = 0; tick < 3000; ++tick) {
    steps.tick(1e-3);
    while (const auto edge = steps.next()) net[edge->motor] += edge->direction;
  }
  CHECK(net == std::array{320, -400, -160, 200});
}

TEST_CASE("edges that a long tick has no room for come in the next one, at rest too", "[live]") {
  const auto machine = stepped();
  std::vector<std::string> lines{"G1 F1200"};
  for (int i = 1; i <= 90; ++i) lines.push_back("X" + std::to_string(0.2 * i) + " Y" + std::to_string(i % 2));
  const auto blocks = test::blocks_of(lines, machine);
  for (const SmoothLevel level :
       {SmoothLevel::exact, SmoothLevel::fast, SmoothLevel::good, SmoothLevel::best}) {
    CAPTURE(to_text(level));
    Executor<Machine<3>, 128> executor(machine, LevelExecutorOptions{.level = level});
    for (const auto& block : blocks) REQUIRE(executor.push(block));
    executor.end_of_program();
    LiveSteps steps(executor);
    std::array<int, 4> net{};
    double last = 0;
    bool ordered = true;
    for (int tick = 0; tick < 1000; ++tick) {
      steps.tick(tick == 0 ? 60 : 0.1);
      while (const auto edge = steps.next()) {
        ordered = ordered && edge->time >= last;
        last = edge->time;
        net[edge->motor] += edge->direction;
      }
    }
    CHECK(executor.finished());
    CHECK(ordered);
    CHECK(net == std::array{18 * 160, 0, 0, 0});
    for (std::size_t motor = 0; motor < 4; ++motor) CHECK(steps.count(motor) == net[motor]);
  }
}

TEST_CASE("a tick over many rests, and edges that nobody asked for at first, lose no step", "[live]") {
  const auto machine = stepped();
  std::vector<std::string> lines{"G1 F1200"};
  for (int i = 1; i <= 20; ++i) {
    lines.push_back("X" + std::to_string(0.5 * i));
    lines.emplace_back("G4 P0.01");
  }
  const auto blocks = test::blocks_of(lines, machine);
  for (const SmoothLevel level : {SmoothLevel::fast, SmoothLevel::good, SmoothLevel::best})
    for (const int unasked : {0, 1, 50}) {
      CAPTURE(to_text(level), unasked);
      Executor<Machine<3>, 128> executor(machine, LevelExecutorOptions{.level = level});
      for (const auto& block : blocks) REQUIRE(executor.push(block));
      executor.end_of_program();
      LiveSteps steps(executor);
      int net = 0;
      for (int tick = 0; tick < 1000; ++tick) {
        steps.tick(unasked == 0 && tick == 0 ? 60 : tick < unasked ? 0.005 : 0.1);
        if (tick < unasked) continue;
        while (const auto edge = steps.next()) net += edge->direction;
      }
      CHECK(executor.finished());
      CHECK(net == 10 * 160);
      CHECK(steps.count(0) == 10 * 160);
    }
}
