// Holds, quick stops and raised feeds against what every axis bears.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "support/catch.hpp"
#include "support/executor_check.hpp"
#include "support/executor_machines.hpp"

using namespace cncplan;

namespace {

constexpr double period = 1e-3;

// The least time to rest from a speed and an acceleration, by trying every peak p of the brake: at full jerk
// to -p, along it, at full jerk to 0.
long double least_time_to_rest(long double v, long double a, long double most_a, long double j) {
  long double best = std::numeric_limits<long double>::infinity();
  constexpr int peaks = 200'000;
  for (int i = 1; i <= peaks; ++i) {
    const long double p = most_a * i / peaks;
    if (p < -a) continue;
    const long double left = v + (a * a - 2 * p * p) / (2 * j);  // speed that the two ramps leave
    if (left >= 0) best = std::min(best, (a + 2 * p) / j + left / p);
  }
  return best;
}

// Limits along a line, from those of the axes and the tool.
struct LineLimits {
  long double acceleration, jerk;
};
template <MachineModel M, class B>
LineLimits line_limits(const M& machine, const B& block) {
  const VectorN<double, M::axis_count> move = block.path.end() - block.path.start();
  long double tool_sq = 0;
  for (int i = 0; i < 3; ++i) tool_sq += static_cast<long double>(move[i]) * move[i];
  const long double length = std::sqrt(tool_sq);
  LineLimits limits{machine.limits.acceleration, machine.limits.jerk};
  for (int i = 0; i < M::axis_count; ++i) {
    const long double share = std::abs(static_cast<long double>(move[i])) / length;
    if (!(share > 0)) continue;
    const auto& axis = machine.axes[static_cast<std::size_t>(i)];
    limits.acceleration = std::min(limits.acceleration, axis.acceleration / share);
    limits.jerk = std::min(limits.jerk, axis.jerk / share);
  }
  return limits;
}

// A long move of all axes at once.
std::vector<std::string> long_move(test::Random& random) {
  char text[160];
  std::snprintf(text, sizeof text, "G1 X%.3f Y%.3f Z%.3f A%.3f C%.3f U%.3f F%.0f", random.uniform(-90, 90),
                random.uniform(-90, 90), random.uniform(20, 50), random.uniform(-90, 90),
                random.uniform(-90, 90), random.uniform(-50, 50), random.log_uniform(300, 2500));
  return {text};
}

using Runner = Executor<Machine<6>, 16>;

void load(Runner& executor, const std::vector<ProgramBlock<Machine<6>>>& blocks) {
  for (const auto& block : blocks) REQUIRE(executor.push(block));
  executor.end_of_program();
}

// Seconds to rest of a motion of six axes that is stopped at a random instant, over the least there are.
double time_to_rest(test::Random& random, double share) {
  const auto lines = long_move(random);
  CAPTURE(lines.front());
  const auto blocks = test::blocks_of(lines, test::six_axes);
  const auto executor = std::make_unique<Runner>(test::six_axes, Runner::Options{.quick_stop_share = share});
  load(*executor, blocks);
  SetPoint<6> now;
  const int ticks = random.integer(20, 900);
  for (int tick = 0; tick < ticks; ++tick) now = executor->tick(period);
  share > 1 ? executor->quick_stop() : executor->feed_hold();
  double time = 0;
  for (int tick = 0; tick < 20'000 && !(executor->rested() > 0); ++tick, time += period)
    executor->tick(period);
  const auto [acceleration, jerk] = line_limits(test::six_axes, blocks.front());
  const auto least =
      least_time_to_rest(now.along.velocity, now.along.acceleration, share * acceleration, share * jerk);
  return static_cast<double>((time - executor->rested()) / least);
}

}  // namespace

TEST_CASE("a hold of six axes comes to rest in the least time, by search", "[executor]") {
  test::Random random;
  for (int i = 0; i < 60; ++i) CHECK(time_to_rest(random, 1) == Approx(1).epsilon(1e-3));
}

TEST_CASE("a quick stop of six axes takes the least time with its share of the limits", "[executor]") {
  test::Random random;
  for (int i = 0; i < 30; ++i) CHECK(time_to_rest(random, random.uniform(1.5, 5)) == Approx(1).epsilon(1e-3));
}

TEST_CASE("a quick stop keeps its share of every axis' limits on bends", "[executor]") {
  constexpr double share = 3;
  test::Random random;
  Machine<3> strong = test::slow_axes<double>;
  for (auto& axis : strong.axes) axis.acceleration *= share, axis.jerk *= share;
  strong.limits.acceleration *= share, strong.limits.jerk *= share;
  using Executor3 = Executor<Machine<3>, 32>;
  bool harder = false;
  for (int i = 0; i < 40; ++i) {
    const auto lines = test::random_lines(random, 25, {0, 0, 0}, 20, "");
    CAPTURE(test::literal(lines));
    const auto blocks = test::blocks_of(lines, test::slow_axes<double>);
    const auto executor = std::make_unique<Executor3>(
        test::slow_axes<double>,
        Executor3::Options{.tolerance = i % 2 == 0 ? 0.0 : 0.01, .quick_stop_share = share});
    executor->program_stop(false);
    test::TickCheck<Machine<3>, SetPoint<3>, ProgramBlock<Machine<3>>> check(strong, blocks,
                                                                             {1, 1, period, 1e-12});
    for (const auto& block : blocks) REQUIRE(executor->push(block));
    executor->end_of_program();
    const int stop = random.integer(10, 600);
    for (int tick = 0; tick < 100'000 && !executor->finished(); ++tick) {
      if (tick == stop) executor->quick_stop();
      if (tick == stop + 1000) executor->resume();
      const auto point = executor->tick(period);
      check.take(point);
      for (int k = 0; k < 3; ++k)
        harder = harder || std::abs(point.acceleration[k]) >
                               1.5 * test::slow_axes<double>.axes[static_cast<std::size_t>(k)].acceleration;
    }
    CHECK(executor->finished());
    CHECK(check.faults.acceleration < 1e-9);
    CHECK(check.faults.jerk < 1e-9);
    CHECK(check.faults.velocity < 1e-9);
  }
  CHECK(harder);
}

TEST_CASE("arcs keep their limits at the highest override of the feed", "[executor]") {
  // of the tool alone: how much a bend leaves of its limits depends on the speed more than it does for axes
  constexpr Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  test::Random random;
  double fastest = 0;
  for (int i = 0; i < 40; ++i) {
    const double radius = random.log_uniform(1.5, 6), most = i % 2 == 0 ? 2 : 5, feed = 30 / most;
    char text[120];
    std::snprintf(text, sizeof text, "G3 X0 Y0 Z%.3f I%.4f J0 F%.0f", random.uniform(-1, 1), radius,
                  60 * feed);
    const std::vector<std::string> lines(4, text);
    CAPTURE(text, most);
    const auto blocks = test::blocks_of(lines, mill);
    using Executor3 = Executor<Machine<3>, 32>;
    const auto executor = std::make_unique<Executor3>(mill, Executor3::Options{.most_override = most});
    test::TickCheck<Machine<3>, SetPoint<3>, ProgramBlock<Machine<3>>> check(mill, blocks,
                                                                             {1, 1, period, 1e-12});
    for (const auto& block : blocks) REQUIRE(executor->push(block));
    executor->end_of_program();
    executor->feed_override(most);
    for (int tick = 0; tick < 100'000 && !executor->finished(); ++tick) {
      if (tick % 150 == 149) executor->feed_override(random.coin() ? most : random.uniform(0.9, most));
      const auto point = executor->tick(period);
      check.take(point);
      fastest = std::max(fastest, point.along.velocity / (feed * most));
    }
    CHECK(executor->finished());
    CHECK(check.faults.velocity < 1e-9);
    CHECK(check.faults.acceleration < 1e-9);
    CHECK(check.faults.jerk < 1e-9);
    CHECK(check.faults.change < 1e-6);
  }
  CHECK(fastest > 0.95);
}

TEST_CASE("a feed that is raised before an arc and taken back keeps the arc's limits", "[executor]") {
  using Exact = Executor<Machine<3>, 32>;
  const auto blocks =
      test::blocks_of({"F110", "G0 X-0.064010 Y0.073309 Z0.034608", "G0 X0.196560 Y-0.116558 Z0.034608",
                       "G2 X0.255135 Y-0.117841 Z0.034608 I0.000043 J-1.335670", "M30"},
                      test::slow_axes<double>);
  for (int share = 160; share < 180; ++share) {
    CAPTURE(share);
    const auto executor = std::make_unique<Exact>(test::slow_axes<double>, Exact::Options{.tolerance = 0});
    test::TickCheck<Machine<3>, SetPoint<3>, ProgramBlock<Machine<3>>> check(test::slow_axes<double>, blocks,
                                                                             {1, 1, period, 1e-12});
    for (const auto& block : blocks) REQUIRE(executor->push(block));
    executor->end_of_program();
    for (int tick = 0; tick < 1000 && !executor->finished(); ++tick) {
      if (tick == 52) executor->feed_hold();
      if (tick == 60) executor->resume(), executor->feed_override(share / 100.0);
      if (tick == 100) executor->feed_override(1);
      check.take(executor->tick(period));
    }
    CHECK(executor->finished());
    CHECK(check.faults.acceleration < 1e-9);
    CHECK(check.faults.jerk < 1e-9);
  }
}

TEST_CASE("a long bend at a low jerk is driven, and left, at the speed that its ramps leave", "[executor]") {
  const Machine<3> machine{.limits = {.velocity = 50, .acceleration = 500, .jerk = 50}};
  const auto blocks = test::blocks_of({"F3000", "G2 X100 Y0 I50 J0"}, machine);
  const auto rest_after = [&](double seconds) {
    Executor<Machine<3>, 16> executor(machine);
    for (const auto& block : blocks) REQUIRE(executor.push(block));
    executor.end_of_program();
    SetPoint<3> now;
    const auto tick = [&] {
      now = executor.tick(period);
      CHECK(now.jerk.norm() <= 50 * (1 + 1e-9));
    };
    while (!executor.finished() && now.time < seconds) tick();
    executor.feed_hold();
    double lasts = 0;
    for (; !executor.finished() && !(now.along.velocity == 0); lasts += period) tick();
    return seconds < 100 ? lasts : now.time;
  };
  CHECK(rest_after(100) < 6.76);  // 7.92 where speed and acceleration may be highest at once
  CHECK(rest_after(3) < 2.8);     // 4.92
  CHECK(rest_after(4) < 2.8);     // 3.92
}

// The ramps of the bend's own limits would be too hard for its speed where one crosses from the line.
TEST_CASE("a hold or a raised feed next to a bend keeps the tool's jerk on it", "[executor]") {
  const Machine<3> machine{.limits = {.velocity = 50, .acceleration = 500, .jerk = 50}};
  const auto blocks = test::blocks_of({"F3000", "G1 X120", "G3 X120 Y100 I0 J50", "G1 X0"}, machine);
  double jerk = 0;
  for (int i = 0; i < 400; ++i) {
    const bool raises = i % 2 == 1;
    Executor<Machine<3>, 16> executor(machine, {.tolerance = 0});
    for (const auto& block : blocks) REQUIRE(executor.push(block));
    executor.end_of_program();
    if (raises) executor.feed_override(0.3);
    SetPoint<3> now;
    const auto tick = [&] {
      now = executor.tick(5 * period);
      jerk = std::max(jerk, now.jerk.norm());
    };
    while (now.time < i * 0.03) tick();
    raises ? executor.feed_override(1) : executor.feed_hold();
    for (int ticks = 0; ticks < 1200; ++ticks) tick();
  }
  CHECK(jerk <= 50 * (1 + 1e-9));
  CHECK(jerk >= 49);
}

TEST_CASE("holds and feeds on lines and bends of all lengths keep the tool's limits", "[executor]") {
  test::Random random;
  int holds = 0;
  for (int draw = 0; draw < 60; ++draw) {
    const double velocity = random.log_uniform(8, 150), acceleration = velocity * random.log_uniform(3, 50);
    const Machine<3> machine{.limits = {velocity, acceleration, acceleration * random.log_uniform(3, 50)}};
    const double ramp = std::sqrt(velocity / machine.limits.jerk);  // s
    std::vector<std::string> lines{"F" + std::to_string(velocity * 60 * random.uniform(0.3, 1.2))};
    double x = 0, y = 0, way = 0;
    for (int i = 0; i < 8; ++i) {
      const double size = velocity * ramp * random.log_uniform(0.15, 4), turn = random.uniform(0.5, 6);
      const int left = random.integer(0, 1) == 0 ? 1 : -1;
      const bool straight = random.integer(0, 2) == 0;
      const double across = way + left * 1.5707963267948966, to = way + left * turn;
      const double i_word = size * std::cos(across), j_word = size * std::sin(across);
      x += straight ? size * std::cos(way) : i_word + left * size * std::sin(to);
      y += straight ? size * std::sin(way) : j_word - left * size * std::cos(to);
      char text[120];
      std::snprintf(text, sizeof text, "G%d X%.9f Y%.9f", straight ? 1 : left > 0 ? 3 : 2, x, y);
      std::string line = text;
      std::snprintf(text, sizeof text, " I%.9f J%.9f", i_word, j_word);
      lines.push_back(straight ? line : line + text);
      if (!straight) way = to;
    }
    std::string all;
    for (const std::string& line : lines) all += line + "\n";
    INFO("seed " << test::seed() << ", draw " << draw << ", limits " << velocity << ' ' << acceleration << ' '
                 << machine.limits.jerk << '\n'
                 << all);
    Executor<Machine<3>, 16> executor(machine, {.tolerance = random.integer(0, 1) * 0.01});
    for (const auto& block : test::blocks_of(lines, machine)) REQUIRE(executor.push(block));
    executor.end_of_program();
    const double tick = period * random.log_uniform(1, 20), seldom = tick / ramp;
    double jerk = 0, hard = 0;
    bool held = false;
    for (int k = 0; k < 400000 && !executor.finished(); ++k) {
      const double chance = random.uniform(0, 1) / seldom;
      if (chance < 0.02) held = true, executor.feed_hold();
      if (chance > 0.02 && chance < 0.05) executor.feed_override(random.uniform(0, 2));
      const auto now = executor.tick(tick);
      jerk = std::max(jerk, now.jerk.norm());
      hard = std::max(hard, now.acceleration.norm());
      if (!(now.along.velocity == 0)) continue;
      if (held) ++holds;
      held = false;
      executor.feed_override(1);
      executor.resume();
    }
    CHECK(executor.finished());
    CHECK(jerk <= machine.limits.jerk * (1 + 1e-6));
    CHECK(hard <= machine.limits.acceleration * (1 + 1e-6));
  }
  CHECK(holds > 20);
}
