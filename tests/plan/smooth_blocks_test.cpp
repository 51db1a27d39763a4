// Programs planned at the levels good and best: limits by differences of positions, distances by brute force.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iomanip>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "cncplan/gcode/lines.hpp"
#include "cncplan/junction_jumps.hpp"
#include "cncplan/peaks.hpp"
#include "cncplan/plan_program.hpp"
#include "cncplan/step_edges.hpp"
#include "plan/at_level.hpp"
#include "plan/smoothed_motion.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"
#include "support/shared.hpp"

using namespace cncplan;
using namespace cncplan::test;

namespace {

const Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};

std::vector<ProgramBlock<Machine<3>>> blocks_of(const std::string& text, const Machine<3>& machine = mill,
                                                const PlanOptions& options = {}) {
  auto program = read_text(text, machine, options);
  REQUIRE_FALSE(program.failed());
  return std::move(program).take_blocks();
}

template <class T>
std::ptrdiff_t curves(const T& trajectory) {
  const auto pieces = trajectory.pieces();
  return std::count_if(pieces.begin(), pieces.end(),
                       [](const auto& piece) { return piece.curve.has_value(); });
}

void check_at(SmoothLevel level, const std::vector<ProgramBlock<Machine<3>>>& blocks, double tolerance,
              const Machine<3>& machine) {
  INFO("level " << (level == SmoothLevel::good ? "good" : "best"));
  const PlanOptions options{.tolerance = tolerance};
  const auto smooth = plan_blocks(blocks, machine, at_level(level, options));
  REQUIRE(smooth);
  const Used most = used(*smooth, machine);
  CHECK(most.velocity <= 1 + 1e-6);
  CHECK(most.acceleration <= 1 + 1e-5);
  CHECK(most.jerk <= 1 + 1e-4);
  CHECK(corner_velocity_step(*smooth) < 1e-6);
  const Polyline path = programmed(blocks), curve = driven(*smooth, 8);
  CHECK(farthest(curve, path) <= tolerance * (1 + 1e-6));
  CHECK(farthest(path, curve) <= tolerance * (1 + 1e-6));
  CHECK((smooth->at(smooth->duration()).position - path.back()).norm() < 1e-9);
  CHECK((smooth->at(0).position - path.front()).norm() < 1e-9);
  CHECK(smooth->completed());
  double length = 0;
  for (const auto& block : blocks) length += block.path.length();
  CHECK(smooth->length() == Approx(length).epsilon(1e-9));
  // Phases follow each other, and so do blocks, of the program too.
  double time = 0;
  std::size_t before = 0;
  for (const auto& [phase, block] : smooth->phases()) {
    CHECK(phase.time == Approx(time).margin(1e-9));
    CHECK(block >= before);
    time = phase.time + phase.duration;
    before = block;
  }
  CHECK(smooth->duration() == Approx(time));
  REQUIRE(smooth->program().size() == blocks.size());
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    CHECK(smooth->program()[b].line == blocks[b].line);
    CHECK(smooth->program()[b].rapid == blocks[b].rapid);
  }
  const auto fast = plan_blocks(blocks, machine, at_level(SmoothLevel::fast, options));
  REQUIRE(fast);
  CHECK(smooth->duration() <= fast->duration() * (1 + 1e-9));
}

void check(const std::vector<ProgramBlock<Machine<3>>>& blocks, double tolerance = 0.01,
           const Machine<3>& machine = mill) {
  for (const auto level : {SmoothLevel::good, SmoothLevel::best}) check_at(level, blocks, tolerance, machine);
}

}  // namespace

TEST_CASE("best: corners keep limits and tolerance, and are faster than smoothed by corrections",
          "[smooth-blocks]") {
  for (const char* end : {"X60 Y1", "X55 Y9", "X50 Y10", "X42 Y6"}) {
    INFO("a corner to " << end);
    check(blocks_of(std::string("F1800 G1 X50\n") + end + "\n"));
  }
  const auto blocks = blocks_of("F1800 G1 X50\nY50\n");
  const auto best = plan_blocks(blocks, mill, {.tolerance = 0.01});
  REQUIRE(best);
  CHECK(curves(*best) == static_cast<std::ptrdiff_t>(best->piece_count()));
  CHECK(best->duration() < 100.0 / 30 + 2 * std::sqrt(30 / 1e4) + 0.086);  // the study's table
}

TEST_CASE("best: lines and arcs, rapids and feed moves", "[smooth-blocks]") {
  SECTION("line, tangent arc, line") { check(blocks_of("F1800 G1 X30\nG3 X30 Y10 J5\nG1 X0\n")); }
  SECTION("kinked line and arc") { check(blocks_of("F1800 G1 X10\nG2 X20 Y0 I5 J-2\nG1 X30 Y3\n")); }
  SECTION("an arc alone") { check(blocks_of("F1800 G3 X0 Y4 J2\n")); }
  SECTION("rapids") {
    Machine<3> slow = mill;
    slow.rapid_rate = 25;
    check(blocks_of("F600 G0 X10 Y3\nG1 X20\nY5\nG0 X0\n", slow), 0.02, slow);
  }
}

TEST_CASE("best: a corner that the level fast passes sooner is left to it", "[smooth-blocks]") {
  Machine<3> quick{.limits = {.velocity = 100, .acceleration = 2000, .jerk = 40000}};  // tools/soak smooth
  quick.axes[0] = {.letter = 'X', .velocity = 85.0625, .acceleration = 2037.61, .jerk = 42556.1};
  quick.axes[1] = {.letter = 'Y', .velocity = 58.3689, .acceleration = 1521.62, .jerk = 45000.5};
  quick.axes[2] = {.letter = 'Z', .velocity = 73.6935, .acceleration = 1589.64, .jerk = 16465.1};
  check(
      blocks_of("F285.871721\nG1 X2.129050 Y0.051285 Z-0.181512\nG1 X3.554507 Y1.531524 Z-0.646122\n", quick),
      0.0140819, quick);
}

TEST_CASE("best: narrow bends at a high feed", "[smooth-blocks]") {
  const Machine<3> quick{.limits = {.velocity = 100, .acceleration = 2000, .jerk = 40000}};
  for (const double radius : {0.05, 0.3, 2.6})
    for (const double tolerance : {0.002, 0.01}) {
      CAPTURE(radius, tolerance);
      std::ostringstream text;
      text << "F5600 G1 X12\nG3 X12 Y" << 2 * radius << " J" << radius << "\nG1 X6 Y" << 2 * radius + 0.8
           << "\nG5.1 X" << 6 - 4 * radius << " I" << -2 * radius << " J" << radius << "\nG1 X-9\n";
      const auto blocks = blocks_of(text.str(), quick);
      check(blocks, tolerance, quick);
      const auto best = plan_blocks(blocks, quick, {.tolerance = tolerance});
      CHECK(curves(*best) == static_cast<std::ptrdiff_t>(best->piece_count()));
    }
}

TEST_CASE("good and best: a velocity that is not reached changes nothing", "[smooth-blocks]") {
  // Ten mm from rest to rest, twice: at 30 mm/s the highest speed is 29.
  Machine<3> machine{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 1000}};
  const auto blocks = blocks_of("G1 X10 F60000\nY10\n", {.limits = {1000, 1000, 1000}});
  for (const auto level : {SmoothLevel::good, SmoothLevel::best}) {
    INFO("level " << (level == SmoothLevel::good ? "good" : "best"));
    machine.limits.velocity = 30;
    const auto reached = plan_blocks(blocks, machine, {.tolerance = 0.01, .level = level});
    REQUIRE(reached);
    for (const double velocity : {40.0, 60.0, 80.0, 90.0, 100.0, 150.0, 200.0, 1000.0, 1e5}) {
      INFO("velocity " << velocity);
      machine.limits.velocity = velocity;
      const auto planned = plan_blocks(blocks, machine, {.tolerance = 0.01, .level = level});
      REQUIRE(planned);
      CHECK(planned->duration() <= reached->duration() * 1.002);
      CHECK(curves(*planned) > 0);
    }
  }
}

TEST_CASE("good and best: limits of the tool above what its axes reach change nothing", "[smooth-blocks]") {
  Machine<3> machine;
  for (auto& axis : machine.axes) {
    axis.velocity = 30;
    axis.acceleration = 1000;
    axis.jerk = 1e4;
  }
  // Rapids have no feed but that limit.
  const auto blocks =
      blocks_of("G0 X5 Y1\nF1800 G1 X10\nX18 Y6\nX19 Y6.2 Z1\nG3 X25 Y12 R8\nG1 X25.1 Y14\nG0 X3\n");
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const auto level : {SmoothLevel::good, SmoothLevel::best}) {
    INFO("level " << (level == SmoothLevel::good ? "good" : "best"));
    // The length of the vector of the axes' limits.
    machine.limits = {.velocity = 60, .acceleration = std::sqrt(3.0) * 1000, .jerk = std::sqrt(3.0) * 1e4};
    const auto reached = plan_blocks(blocks, machine, {.tolerance = 0.01, .level = level});
    REQUIRE(reached);
    CHECK(reached->fallbacks().empty());
    for (const double velocity : {60.0, 1e5, infinity})
      for (const auto& [acceleration, jerk] :
           {std::pair(1e4, 1e5), std::pair(1e6, 1e6), std::pair(1e4, infinity), std::pair(infinity, 1e7),
            std::pair(infinity, infinity)}) {
        CAPTURE(velocity, acceleration, jerk);
        machine.limits = {velocity, acceleration, jerk};
        const auto planned = plan_blocks(blocks, machine, {.tolerance = 0.01, .level = level});
        REQUIRE(planned);
        CHECK(planned->duration() == Approx(reached->duration()).epsilon(1e-6));
        CHECK(planned->fallbacks().empty());
      }
  }
}

TEST_CASE("good and best: a level that is not the one asked for is told", "[smooth-blocks]") {
  const auto blocks = blocks_of("F1800 G1 X10\nY10\nG4 P0.1\nX20\nG3 X30 Y20 J10\n");
  const auto told = [&](const Machine<3>& machine, const PlanOptions& options,
                        const std::vector<ProgramBlock<Machine<3>>>& program) {
    const auto planned = plan_blocks(program, machine, options);
    REQUIRE(planned);
    return std::vector<Fallback>(planned->fallbacks().begin(), planned->fallbacks().end());
  };
  const auto whole = [&](FallbackReason reason) {
    return std::vector<Fallback>{{0, blocks.size() - 1, SmoothLevel::fast, reason}};
  };
  CHECK(told(mill, {.tolerance = 0.01}, blocks).empty());
  CHECK(told(mill, {.tolerance = 0}, blocks).empty());
  CHECK(told(mill, {.tolerance = 0.01}, blocks_of("F1800 G1 X10\nX20\nG61 X30\nY9\n")).empty());
  Machine<3> machine = mill;
  machine.limits.jerk = std::numeric_limits<double>::infinity();
  CHECK(told(machine, {.tolerance = 0.01}, blocks) == whole(FallbackReason::tool_limits));
  CHECK(told(machine, {.tolerance = 0}, blocks).empty());
  machine = mill;
  std::swap(machine.axes[0].letter, machine.axes[1].letter);
  CHECK(told(machine, {.tolerance = 0.01}, blocks) == whole(FallbackReason::axes));
  // A line along the end of travel, a stop, and a corner with room.
  machine = mill;
  machine.axes[1].low = 0;
  const auto wall = blocks_of("F1800 G1 X10 Y0\nX11 Y0.1\nX12 Y0\nX20\nG4 P0.1\nG1 Y10\nX30\n", machine);
  const auto planned = plan_blocks(wall, machine, {.tolerance = 0.01});
  REQUIRE(planned);
  REQUIRE_FALSE(planned->fallbacks().empty());
  for (const Fallback& fallback : planned->fallbacks()) {
    CHECK(fallback.reason == FallbackReason::travel);
    CHECK(fallback.level < SmoothLevel::good);
    CHECK(planned->program()[fallback.last].line <= 4);
  }
}

TEST_CASE("best: dense lines with noise come up to speed", "[smooth-blocks]") {
  // A braking way has hundreds of cells here: windows of 400 gave up to 0.763 s for 0.710. The exact plan,
  // which jumps at all corners, is about as fast as can be.
  test::Random random(1);
  for (int round = 0; round < 3; ++round) {
    std::ostringstream text;
    text << std::fixed << std::setprecision(6) << "F1800\n";
    for (int i = 1; i <= 600; ++i) {
      const double angle = 0.0015 * i, radius = 20 + random.uniform(-0.001, 0.001);
      text << "G1 X" << radius * std::cos(angle) - 20 << " Y" << radius * std::sin(angle) << "\n";
    }
    const auto blocks = blocks_of(text.str());
    const auto jumping = plan_blocks(blocks, mill, {.tolerance = 0, .junction_deviation = 0.01});
    const auto best = plan_blocks(blocks, mill, {.tolerance = 0.01});
    REQUIRE(jumping);
    REQUIRE(best);
    CAPTURE(round, jumping->duration());
    CHECK(best->duration() < 1.01 * jumping->duration());
  }
}

TEST_CASE("best: stops, pauses and exact blocks divide the program", "[smooth-blocks]") {
  const auto blocks = blocks_of(
      "F1800 G1 X10\nX20 Y5\nX30\nG4 P0.25\nX40 Y5\nX50\nY0\nG61.1 X60\nY10\nG61 X70\nX75\nG64 X80\nX90 "
      "Y0\n");
  check(blocks);
  const auto best = plan_blocks(blocks, mill, {.tolerance = 0.01});
  REQUIRE(best);
  CHECK(curves(*best) > 0);
  // At rest where the program stops, and there exactly.
  double rest = 0;
  for (const auto& [phase, block] : best->phases())
    if (phase.velocity == 0 && phase.jerk == 0 && phase.acceleration == 0) rest += phase.duration;
  CHECK(rest == Approx(0.25));
  for (std::size_t b = 0; b + 1 < blocks.size(); ++b) {
    if (!blocks[b].exact_stop && !(blocks[b].pause > 0)) continue;
    const auto point = best->at(best->start_time(b + 1));
    INFO("behind block " << b);
    CHECK(point.velocity.norm() < 1e-6);
    CHECK((point.position - blocks[b].path.end()).norm() < 1e-9);
  }
  for (const auto& piece : best->pieces())
    if (blocks[piece.block].exact_path || blocks[piece.block].path.length() == 0) CHECK(!piece.curve);
}

TEST_CASE("best: the way back is exact", "[smooth-blocks]") {
  const auto blocks = blocks_of("F1800 G1 X5\nX10 Z-10\nX5 Z0\nX0\n");
  check(blocks);
  const auto best = plan_blocks(blocks, mill, {.tolerance = 0.01});
  REQUIRE(best);
  const auto there = best->at(best->start_time(2));
  CHECK((there.position - Vector3(10, 0, -10)).norm() < 1e-9);
  CHECK(there.velocity.norm() < 1e-6);
}

TEST_CASE("best: what has no such plan is planned as plan_blocks does", "[smooth-blocks]") {
  const auto blocks = blocks_of("F1800 G1 X10\nY10\nG4 P0.1\nX20\nG3 X30 Y20 J10\n");
  Machine<3> no_jerk = mill, far_axes = mill;
  no_jerk.limits.jerk = std::numeric_limits<double>::infinity();
  far_axes.axes[0].letter = 'Y';
  far_axes.axes[1].letter = 'X';
  const auto same = [&](const Machine<3>& machine, const PlanOptions& options) {
    const auto best = plan_blocks(blocks, machine, options);
    const auto fast = plan_blocks(blocks, machine, at_level(SmoothLevel::fast, options));
    REQUIRE(best.has_value() == fast.has_value());
    if (!best) return;
    CHECK(curves(*best) == 0);
    REQUIRE(best->duration() == fast->duration());
    for (double t = 0; t < fast->duration(); t += 0.01)
      CHECK((best->at(t).position - fast->at(t).position).norm() < 1e-12);
  };
  same(mill, {.tolerance = 0});
  same(no_jerk, {.tolerance = 0.01});
  same(far_axes, {.tolerance = 0.01});
  // Along the end of travel there is no room for a curve on both sides.
  Machine<3> narrow = mill;
  narrow.axes[1].low = 0;
  const auto wall = blocks_of("F1800 G1 X10 Y0\nX11 Y0.1\nX12 Y0\nX20\n", narrow);
  const auto planned = plan_blocks(wall, narrow, {.tolerance = 0.01});
  if (planned)
    for (const auto& point : planned->samples(1e-3)) CHECK(point.position[1] > -1e-9);
}

TEST_CASE("best: lines straight on run as on the exact path", "[smooth-blocks]") {
  std::string straight = "F1800\n";
  for (int i = 1; i <= 50; ++i) straight += "G1 X" + std::to_string(i * 0.2) + "\n";
  const auto line = plan_blocks(blocks_of(straight), mill, {.tolerance = 0.01});
  REQUIRE(line);
  CHECK(curves(*line) == 0);
  // 10 mm from rest to rest: ramps of J t^2 = 30, and a cruise
  const double ramp = std::sqrt(30.0 / 10000.0);
  CHECK(line->duration() == Approx(10.0 / 30.0 + 2 * ramp).epsilon(1e-9));
}

TEST_CASE("best: errors say the block", "[smooth-blocks]") {
  const std::vector<ProgramBlock<Machine<3>>> apart{
      {.path = path::Line<3>(Vector3(0, 0, 0), Vector3(1, 0, 0)), .feed = 10, .line = 1},
      {.path = path::Line<3>(Vector3(1, 0, 0), Vector3(2, 1, 0)), .feed = 10, .line = 2},
      {.path = path::Line<3>(Vector3(3, 1, 0), Vector3(4, 0, 0)), .feed = 10, .line = 3}};
  const auto planned = plan_blocks(apart, mill, {.tolerance = 0.01});
  REQUIRE(!planned);
  CHECK(planned.error().error().code == ErrorCode::discontinuous);
  CHECK(planned.error().block == 2u);
  CHECK(planned.error().about.line == 3);
}

TEST_CASE("best: random programs", "[smooth-blocks]") {
  test::Random random;
  for (int round = 0; round < 6; ++round) {
    std::ostringstream text;
    text << "F1800 G1\n";
    Vector3 at = Vector3::Zero();
    const int count = random.integer(2, 20);
    for (int i = 0; i < count; ++i) {
      const Vector3 way(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.3, 0.3));
      at += random.log_uniform(0.1, 10) * way.normalized();
      text << "X" << at[0] << " Y" << at[1] << " Z" << at[2] << " F" << random.integer(300, 1800) << "\n";
      if (random.integer(0, 6) == 0) text << "G4 P0.05\n";
    }
    INFO("seed " << test::seed() << " round " << round << "\n" << text.str());
    check(blocks_of(text.str()), random.log_uniform(0.003, 0.05));
  }
}

TEST_CASE("best: step edges end where the program does", "[smooth-blocks]") {
  Machine<3> machine = mill;
  for (auto& axis : machine.axes) axis.motors = {{.steps_per_unit = 100}};
  const auto blocks = blocks_of("F1800 G1 X10\nX13 Y5\nG3 X23 Y5 I5\nG1 X30 Y1 Z-2\n", machine);
  const auto best = plan_blocks(blocks, machine, {.tolerance = 0.01});
  REQUIRE(best);
  std::array<int, 3> steps{};
  double time = 0;
  for (const auto& edge : best->step_edges()) {
    CHECK(edge.time >= time);
    time = edge.time;
    steps[static_cast<std::size_t>(edge.axis)] += edge.direction;
  }
  CHECK(steps == std::array{3000, 100, -200});
  CHECK(time <= best->duration());
}

TEST_CASE("good and best: a real program takes no longer than a prototype did", "[smooth-blocks][slow]") {
  const auto shared = test::shared();
  if (!shared) {
    WARN("SKIPPED: CNCPLAN_SHARED is not set");
    return;
  }
  auto program = read_file(*shared + "/data/ngc/51MeanderAve.ngc", mill);
  REQUIRE_FALSE(program.failed());
  auto blocks = std::move(program).take_blocks();
  std::erase_if(blocks, [](const auto& block) { return !(block.path.length() > 0); });
  for (auto& block : blocks) {
    block.exact_stop = block.exact_path = false;
    block.pause = block.merge = 0;
    block.tolerance.reset();
  }
  const auto best = plan_blocks(blocks, mill, {.tolerance = 0.01});
  REQUIRE(best);
  CHECK(best->duration() < 218.4);
  const auto good = plan_blocks(blocks, mill, {.tolerance = 0.01, .level = SmoothLevel::good});
  REQUIRE(good);
  CHECK(good->duration() < 220.07 * 1.005);  // the prototype's before its second round
  CHECK(good->duration() > best->duration());
}
