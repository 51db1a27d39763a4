// The level fast beside ends of travel: what smoothing could take beyond them is left out, in plans and live.
#include <algorithm>
#include <limits>
#include <memory>
#include <string>

#include "cncplan/executor.hpp"
#include "cncplan/plan_program.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

// The wall is Y0; the room is on one side of it: 1 or -1.
Machine<3> at_wall(int side) {
  Machine<3> machine{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  (side > 0 ? machine.axes[1].low : machine.axes[1].high) = 0;
  return machine;
}

// Lines of one jump of direction next to another, and arcs, all of them from the wall inwards.
std::string along_wall(test::Random& random, int side) {
  std::string text = "F1800\n";
  double x = 0, y = 0;
  for (int i = 0; i < 40; ++i) {
    const double step = random.log_uniform(0.02, 5);
    x += step;
    const bool arc = random.integer(0, 3) == 0;
    if (!arc) y = random.coin() ? 0 : random.log_uniform(1e-4, 1);
    text += arc ? (side > 0 ? "G2 R" : "G3 R") + std::to_string(step) : "G1";
    text += " X" + std::to_string(x) + " Y" + std::to_string(side * y) + "\n";
  }
  return text;
}

struct Live {
  double lowest = std::numeric_limits<double>::infinity();  // mm into the room
  double seconds = 0;
};

Live run(const Machine<3>& machine, const Program<Machine<3>>& program, int side) {
  const auto executor = std::make_unique<Executor<Machine<3>, 128>>(machine);
  for (const auto& block : program.blocks()) REQUIRE(executor->push(block));
  executor->end_of_program();
  Live live;
  for (; !executor->finished() && live.seconds < 100; live.seconds += 1e-3)
    live.lowest = std::min(live.lowest, side * executor->tick(1e-3).position[1]);
  CAPTURE(executor->error() ? to_text(*executor->error()) : std::string());
  CHECK_FALSE(executor->error());
  CHECK(executor->finished());
  return live;
}

}  // namespace

TEST_CASE("at the level fast corners beside an end of travel rest where smoothing has no room", "[levels]") {
  test::Random random;
  std::size_t rests = 0;
  for (int i = 0; i < 60; ++i) {
    const int side = i % 2 == 0 ? 1 : -1;
    const Machine<3> machine = at_wall(side);
    const std::string text = along_wall(random, side);
    const auto program = read_text(text, machine);
    REQUIRE_FALSE(program.failed());
    const auto planned = plan_program(program, machine, {.level = SmoothLevel::fast});
    INFO((planned ? "" : to_text(planned.error())) << "\n" << text);
    REQUIRE(planned);
    double lowest = 0;
    for (const auto& point : planned->samples(1e-3)) lowest = std::min(lowest, side * point.position[1]);
    CHECK(lowest > -1e-9);
    for (const Fallback& fallback : planned->fallbacks()) {
      CHECK(fallback.level == SmoothLevel::exact);
      CHECK(fallback.reason == FallbackReason::travel);
      ++rests;
    }
    const Live live = run(machine, program, side);
    CHECK(live.lowest > -1e-9);
    CHECK(live.seconds == Approx(planned->duration()).epsilon(0.05));  // live it sees less ahead
  }
  CHECK(rests > 60);
}

TEST_CASE("at the level fast corners into the room beside an end of travel are smoothed", "[levels]") {
  Machine<3> machine = at_wall(1);
  machine.axes[0].low = machine.axes[2].low = machine.axes[2].high = 0;
  // The arc ends 0.3 mm from the wall, and turns on towards it.
  const std::string text =
      "F1800\nG1 X20 Y0\nY10\nX0\nY0.02\nX1\nG0 X22.9289 Y3.2289\nG3 X30 Y0.3 R10\nG1 X32 Y0.1\n";
  Machine<3> free = machine;
  for (auto& axis : free.axes) axis.low = -1, axis.high = 100;
  const auto planned = plan_text(text, machine, {.level = SmoothLevel::fast});
  const auto wanted = plan_text(text, free, {.level = SmoothLevel::fast});
  REQUIRE(planned);
  REQUIRE(wanted);
  CHECK(planned->fallbacks().empty());
  CHECK(planned->duration() == wanted->duration());
}
