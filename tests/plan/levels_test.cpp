// The level of smoothing as an option: the same at every door, and told for every block.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cncplan/junction_jumps.hpp"
#include "cncplan/plan_program.hpp"
#include "plan/at_level.hpp"
#include "plan/smoothed_motion.hpp"
#include "support/catch.hpp"

using namespace cncplan;
using namespace cncplan::test;

namespace {

const Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
constexpr SmoothLevel levels[]{SmoothLevel::exact, SmoothLevel::fast, SmoothLevel::good, SmoothLevel::best};

const std::string text =
    "G21 G90 F1800\nG1 X10\nM8\nX20 Y1\nG3 X30 Y11 J10\nG1 Y20\nX10\nG4 P0.1\nX0 Y0\nM9\n";

// A path that says nothing of its enclosures.
struct NotEnclosed {
  using Scalar = double;
  using Vector = Vector3;

  [[nodiscard]] double length() const { return inside.length(); }
  [[nodiscard]] Vector3 position_at(double s) const { return inside.position_at(s); }
  [[nodiscard]] PathPoint<Vector3> point_at(double s) const { return inside.point_at(s); }
  [[nodiscard]] BasicPathBounds<double, 3> bounds(double from, double to) const {
    return inside.bounds(from, to);
  }
  [[nodiscard]] BasicBox<double, 3> box() const { return inside.box(); }

  path::Line<3> inside;
};

}  // namespace

TEST_CASE("levels: one type of trajectory, chosen when the program runs", "[levels]") {
  std::vector<Trajectory<Machine<3>, Block<3>>> all;
  for (const SmoothLevel level : levels) {
    auto planned = plan_text(text, mill, {.tolerance = 0.01, .level = level});
    REQUIRE(planned);
    CHECK(planned->level() == level);
    all.push_back(std::move(*planned));
  }
  const auto given = read_text(text, mill);
  for (const auto& planned : all) {
    INFO("level " << to_text(planned.level()));
    CHECK(planned.completed());
    CHECK(planned.program().size() == given.blocks().size());
    CHECK(planned.words().size() == 2);
    double length = 0;
    std::size_t before = 0;
    for (const auto& block : planned.blocks()) {
      CHECK(block.level == planned.level());
      CHECK_FALSE(block.reason);
      CHECK(block.line == given.blocks()[block.block].line);
      CHECK(block.length == given.blocks()[block.block].path.length());
      CHECK((length == 0 || block.block > before));  // each block once
      before = block.block;
      length += block.length;
    }
    CHECK(length == Approx(planned.length()));
    // Set points count the blocks that were given, and the length that was programmed.
    for (const auto& point : planned.samples(0.01)) {
      REQUIRE(point.block < given.blocks().size());
      CHECK(point.line == given.blocks()[point.block].line);
      const double within = point.along.position - planned.start_length(point.block);
      const auto& path = given.blocks()[point.block].path;
      if (path.length() > 0)
        CHECK((path.position_at(std::clamp(within, 0.0, path.length())) - point.position).norm() <= 0.011);
    }
    CHECK((corner_velocity_step(planned) > 1) == (planned.level() == SmoothLevel::exact));
    const Used most = used(planned, mill);
    if (planned.level() != SmoothLevel::exact) CHECK(most.jerk <= 1 + 1e-4);
  }
  CHECK(all[2].duration() < all[1].duration());
  CHECK(all[3].duration() <= all[2].duration());
}

TEST_CASE("levels: 0.01 mm and best are the default, and no tolerance is exact", "[levels]") {
  const auto usual = plan_text(text, mill);
  const auto best = plan_text(text, mill, {.tolerance = 0.01, .level = SmoothLevel::best});
  REQUIRE(usual);
  CHECK(usual->duration() == best->duration());
  CHECK(usual->level() == SmoothLevel::best);
  CHECK(plan_blocks(read_text(text, mill).take_blocks(), mill)->duration() == best->duration());
  CHECK(plan_program(read_text(text, mill), mill)->duration() == best->duration());
  const auto exact = plan_text(text, mill, {.tolerance = 0.01, .level = SmoothLevel::exact});
  const auto none = plan_text(text, mill, {.tolerance = 0, .level = SmoothLevel::best});
  CHECK(none->level() == SmoothLevel::exact);
  CHECK(none->duration() == exact->duration());
  CHECK(std::equal(none->phases().begin(), none->phases().end(), exact->phases().begin(),
                   exact->phases().end()));
}

TEST_CASE("levels: each block has its level and why it is not the one asked for", "[levels]") {
  Machine<3> machine = mill;
  machine.axes[1].low = 0;
  // A line along the end of travel, where only the level fast has room; a stop; a corner with room.
  const auto planned = plan_text("F1800 G1 X10 Y0\nX11 Y0.1\nX12 Y0\nX20\nG4 P0.1\nG1 Y10\nX30\n", machine,
                                 {.tolerance = 0.01});
  REQUIRE(planned);
  std::size_t others = 0;
  for (const auto& block : planned->blocks()) {
    const bool beside_the_end = block.line <= 4;
    CHECK((block.level < SmoothLevel::good) == beside_the_end);
    CHECK(block.reason == (beside_the_end ? std::optional(FallbackReason::travel) : std::nullopt));
    others += beside_the_end;
  }
  CHECK(others == 4);
  // What the program itself makes exact is no fallback.
  const auto by_program = plan_text("F1800 G61 G1 X10\nY10\nX0\n", mill);
  REQUIRE(by_program);
  for (const auto& block : by_program->blocks()) CHECK_FALSE(block.reason);
}

TEST_CASE("levels: paths of one's own without enclosures are exact, and that is told", "[levels]") {
  using Own = Block<3, NotEnclosed>;
  std::vector<Own> blocks;
  blocks.push_back({.path = path::Line<3>({0, 0, 0}, {10, 0, 0}), .feed = 20});
  blocks.push_back({.path = NotEnclosed{{{10, 0, 0}, {10, 10, 0}}}, .feed = 20});
  for (const SmoothLevel level : {SmoothLevel::fast, SmoothLevel::best}) {
    const auto planned = plan_blocks(blocks, mill, at_level(level, {}));
    REQUIRE(planned);
    REQUIRE(planned->fallbacks().size() == 1);
    CHECK(planned->fallbacks()[0] == Fallback{0, 1, SmoothLevel::exact, FallbackReason::path});
    for (const auto& block : planned->blocks()) CHECK(block.level == SmoothLevel::exact);
  }
  CHECK(plan_blocks(blocks, mill, {.tolerance = 0})->fallbacks().empty());
  const auto held = plan_blocks(blocks, mill, {.hold_factor = 1.5});
  REQUIRE_FALSE(held);
  CHECK(held.error().about.error.code == ErrorCode::not_supported);
}

TEST_CASE("levels: a smoothed path that would leave the travel is exact there, and none is refused",
          "[levels]") {
  Machine<3> machine = mill;
  machine.axes[1].low = 0;
  for (const SmoothLevel level : {SmoothLevel::fast, SmoothLevel::good, SmoothLevel::best}) {
    const auto planned = plan_text("F1800 G1 X10 Y0\nX11 Y0.1\nX12 Y0\nX20\nY10\nX30\n", machine,
                                   {.tolerance = 0.01, .level = level});
    REQUIRE(planned);
    double lowest = 0;
    for (const auto& point : planned->samples(1e-4)) lowest = std::min(lowest, point.position[1]);
    CHECK(lowest > -1e-9);
    CHECK(used(*planned, machine).jerk <= 1 + 1e-4);  // no corner jumps
    CHECK(corner_velocity_step(*planned) < 1e-6);
    CHECK(planned->fallbacks().empty() == (level == SmoothLevel::fast));  // whose corners all have room
  }
  CHECK_FALSE(plan_text("F1800 G1 X10 Y-0.001\nX20\n", machine));
}

TEST_CASE("levels: a corner at an end of travel costs a rest, not the level of the whole run", "[levels]") {
  std::string wave = "F1800\nG1 X10\nY5\n";
  for (int i = 0; i < 120; ++i) {
    char line[80];
    std::snprintf(line, sizeof line, "X%.4f Y%.4f\n", 30 + 8 * std::cos(0.15 * i) + 0.1 * i,
                  40 + 8 * std::sin(0.15 * i));
    wave += line;
  }
  Machine<3> machine = mill;
  machine.axes[0].low = machine.axes[1].low = 0;
  for (const SmoothLevel level : {SmoothLevel::good, SmoothLevel::best}) {
    const auto free = plan_text(wave, mill, {.tolerance = 0.01, .level = level});
    const auto planned = plan_text(wave, machine, {.tolerance = 0.01, .level = level});
    REQUIRE(free);
    REQUIRE(planned);
    CHECK(planned->duration() < free->duration() + 0.1);
    double lowest = 0;
    for (const auto& point : planned->samples(1e-4)) lowest = std::min(lowest, point.position.minCoeff());
    CHECK(lowest > -1e-9);
    CHECK(used(*planned, machine).jerk <= 1 + 1e-4);
    REQUIRE(planned->fallbacks().size() == 1);
    CHECK(planned->fallbacks()[0] == Fallback{0, 1, SmoothLevel::exact, FallbackReason::travel});
  }
}

TEST_CASE("levels: a tolerance that is none is an error at every door", "[levels]") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::vector<std::pair<PlanOptions, std::string_view>> wrong;
  for (const double value : {-1.0, nan, infinity}) wrong.push_back({{.tolerance = value}, "tolerance"});
  for (const double value : {-1.0, nan, infinity})
    wrong.push_back({{.rotary_tolerance = value}, "rotary tolerance"});
  for (const double value : {-1.0, nan})
    wrong.push_back({{.junction_deviation = value}, "junction deviation"});
  const auto program = read_text(text, mill);
  for (const SmoothLevel level : levels)  // of the exact path, 0 is a rest at each corner
    CHECK(plan_blocks(program.blocks(), mill, at_level(level, {.rotary_tolerance = 0})).has_value() ==
          (level == SmoothLevel::exact));
  for (const auto& [options, field] : wrong)
    for (const SmoothLevel level : levels) {
      CAPTURE(field, to_text(level));
      const PlanOptions given = at_level(level, options);
      const auto planned = plan_blocks(program.blocks(), mill, given);
      REQUIRE_FALSE(planned);
      CHECK(planned.error().error().field == field);
      CHECK_FALSE(plan_text(text, mill, given));
      CHECK_FALSE(plan_program(program, mill, given));
      SmoothStream<Machine<3>, Block<3>> stream(mill, given);
      CHECK_FALSE(stream.push(program.blocks()[0]));
      CHECK_FALSE(stream.finish());
    }
}

TEST_CASE("levels: rapids run at the machine's rapid rate, above the speed of feeds", "[levels]") {
  Machine<3> fast_rapids{.limits = {.velocity = 10, .acceleration = 1000, .jerk = 10000}, .rapid_rate = 60};
  const std::string program =
      "F600\nG1 X5\nG1 X10 Y1\nG1 X20 Y3\nG1 X30 Y6\nG1 X40 Y10\nG0 X100 Y70\nG1 X105 Y75\nX110 Y82\nX113 "
      "Y90\n"
      "X115 Y100\n";
  double fast = 0;
  for (const SmoothLevel level : {SmoothLevel::fast, SmoothLevel::good, SmoothLevel::best}) {
    CAPTURE(to_text(level));
    const auto planned = plan_text(program, fast_rapids, {.tolerance = 0.01, .level = level});
    REQUIRE(planned);
    CHECK(planned->fallbacks().empty());
    double rapid = 0, feed = 0;
    for (double t = 0; t < planned->duration(); t += 1e-3) {
      const auto now = planned->at(t);
      double& most = planned->program()[now.block].rapid ? rapid : feed;
      most = std::max(most, now.velocity.norm());
    }
    CHECK(rapid > 55);
    CHECK(rapid <= 60 * (1 + 1e-6));
    CHECK(feed <= 10 * (1 + 1e-3));
    if (level == SmoothLevel::fast) fast = planned->duration();
    CHECK(planned->duration() <= fast);
  }
}
