// Programs smoothed within a tolerance: limits by differences of positions, distances by brute force.
#include "cncplan/detail/curve/smoothing.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "cncplan/path/arc_from_radius.hpp"
#include "cncplan/peaks.hpp"
#include "cncplan/plan_program.hpp"
#include "cncplan/step_edges.hpp"
#include "plan/smoothed_motion.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

const Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};

using namespace cncplan::test;

template <class T, int N>
void check(const T& planned, const Machine<N>& machine, double tolerance, bool both_ways = true) {
  REQUIRE(planned);
  const Used most = used(*planned, machine);
  CHECK(most.velocity <= 1 + 1e-6);
  CHECK(most.acceleration <= 1 + 1e-5);
  CHECK(most.jerk <= 1 + 1e-4);
  CHECK(corner_velocity_step(*planned) < 1e-8);
  if (!both_ways) return;
  const Polyline path = programmed(planned->program()), curve = driven(*planned, 60);
  const double rounding = tolerance * 1e-6 + 1e-7;  // chords of arcs
  CHECK(farthest(curve, path) <= tolerance + rounding);
  CHECK(farthest(path, curve) <= tolerance + rounding);
}

std::string polyline(const std::vector<std::array<double, 2>>& points, double feed = 1800) {
  std::ostringstream text;
  text << std::fixed;
  text.precision(12);
  text << "F" << feed << "\n";
  for (const auto& [x, y] : points) text << "G1 X" << x << " Y" << y << "\n";
  return text.str();
}

auto smoothed(const std::string& program, double tolerance = 0.01) {
  return plan_text(program, mill, {.tolerance = tolerance, .level = SmoothLevel::fast});
}

}  // namespace

TEST_CASE("the tool is no faster than the feed where a smoothed path is longer", "[smoothing]") {
  // |q'| > 1 between line and arc: by 1.2 % on the arc of R 0.318.
  const auto check_feed = [](const std::string& text, double feed) {
    INFO(text);
    const auto planned = smoothed(text);
    REQUIRE(planned);
    double most = 0;
    for (const auto& point : planned->samples(1e-4)) most = std::max(most, point.velocity.norm());
    CHECK(most <= feed * (1 + 1e-9));
    CHECK(most > 0.99 * feed);
  };
  check_feed("F333\nG1 X3\nG3 X3.318 Y0.318 I0 J0.318\nG1 Y3.318\n", 333.0 / 60);
  Random random;
  for (int i = 0; i < 30; ++i) {
    const double radius = random.log_uniform(0.2, 5), feed = random.uniform(60, 500);
    std::ostringstream text;
    text << std::fixed << "F" << feed << "\nG1 X3\n"
         << (random.coin() ? "G3" : "G2") << " X" << 3 + radius << " Y" << radius << " I0 J" << radius
         << "\nG1 Y" << radius + 3 << "\n";
    check_feed(text.str(), std::stod(text.str().substr(1)) / 60);
  }
}

TEST_CASE("corners are smooth, within the tolerance and the limits", "[smoothing]") {
  for (const double degrees : {2.0, 10.0, 30.0, 90.0, 150.0, 174.0})
    for (const double tolerance : {0.005, 0.05}) {
      const double a = degrees * std::numbers::pi / 180;
      INFO(degrees << " degrees, " << tolerance << " mm");
      const auto planned =
          smoothed(polyline({{50, 0}, {50 + 50 * std::cos(a), 50 * std::sin(a)}}), tolerance);
      check(planned, mill, tolerance);
      // No slower than to stop there.
      const auto stop =
          plan_text(polyline({{50, 0}}) + "G4 P0\n" + polyline({{50 + 50 * std::cos(a), 50 * std::sin(a)}}),
                    mill, {.tolerance = 0});
      REQUIRE(stop);
      CHECK(planned->duration() <= stop->duration() + 1e-6);
    }
}

TEST_CASE("polygons, zigzags, arcs and helices are smooth within the tolerance", "[smoothing]") {
  std::vector<std::array<double, 2>> polygon, zigzag, wave;
  const int corners = 71;  // R 10, chord error 0.01
  for (int i = 1; i <= corners; ++i) {
    const double a = 2 * std::numbers::pi * i / corners;
    polygon.push_back({10 * std::cos(a) - 10, 10 * std::sin(a)});
  }
  for (int i = 1; i <= 12; ++i) zigzag.push_back({0.3 * i, i % 2 == 0 ? 0.0 : 0.4});
  for (int i = 1; i <= 60; ++i) wave.push_back({0.2 * i, 3 * std::sin(0.1 * i)});
  SECTION("polygon") { check(smoothed(polyline(polygon)), mill, 0.01); }
  SECTION("zigzag") { check(smoothed(polyline(zigzag)), mill, 0.01); }
  SECTION("wave") { check(smoothed(polyline(wave)), mill, 0.01); }
  SECTION("features smaller than the tolerance") {
    check(smoothed(polyline({{5, 0}, {5, 0.003}, {5.003, 0.003}, {5.003, 0}, {10, 0}})), mill, 0.01);
  }
  SECTION("line, tangent arc, line") { check(smoothed("F1800 G1 X30\nG3 X30 Y10 J5\nG1 X0\n"), mill, 0.01); }
  SECTION("arc to arc, bent the other way") {
    check(smoothed("F1800 G3 X10 Y10 J10\nG2 X20 Y20 I10\nG1 X40\n"), mill, 0.01);
  }
  SECTION("kinked line and arc") {
    check(smoothed("F1800 G1 X10\nG2 X20 Y0 I5 J-2\nG1 X30 Y3\n"), mill, 0.01);
  }
  SECTION("helix") {
    check(smoothed("F1800 G1 X10\nG3 X10 Y20 Z4 J10\nG3 X10 Y0 Z8 J-10\nG1 X20 Z8\n"), mill, 0.01);
  }
}

TEST_CASE("the interior of an arc stays exact", "[smoothing]") {
  const auto planned = smoothed("F1800 G1 X30\nG3 X30 Y10 J5\nG1 X0\n");
  REQUIRE(planned);
  for (int i = 0; i <= 50; ++i) {
    const auto at = planned->path(1).position_at(3 + (5 * std::numbers::pi - 6) * i / 50);
    CHECK(std::hypot(at[0] - 30, at[1] - 5) == Approx(5).epsilon(1e-12));
  }
}

TEST_CASE("the tool stops where it turns back, and where it must be exact", "[smoothing]") {
  const auto exit_of_first =
      [](const std::string& program,
         const PlanOptions& options = {.tolerance = 0.01, .level = SmoothLevel::fast}) {
        const auto planned = plan_text(program, mill, options);
        REQUIRE(planned);
        CHECK(planned->at(planned->start_time(1)).position == planned->program()[0].path.end());
        return planned->blocks()[0].exit;
      };
  const auto rests = Approx(0).margin(1e-6);
  CHECK(exit_of_first("F1800 G1 Z-10\nZ0\n") == rests);
  CHECK(exit_of_first("F1800 G61.1 G1 X10\nX20\n") == rests);
  CHECK(exit_of_first("F1800 G1 X10\nG61.1 X20 Y1\n") == rests);  // from the start of the exact block on
  CHECK(exit_of_first("F1800 G1 X10\nG61 X20 Y1\n") == rests);
  CHECK(exit_of_first("F1800 G61 G1 X10\nX20 Y1\n") == rests);
  CHECK(exit_of_first("F1800 G64 P0 G1 X10\nX20 Y1\n") == rests);
  CHECK(exit_of_first("F1800 G61 G1 X10\nX20\n") == Approx(30));  // smooth: no reason to stop
  CHECK(exit_of_first("F1800 G1 X10\nG4 P0.1\nX20\n") == rests);
  CHECK(exit_of_first("F1800 G1 X10\nM0\nX20\n") == rests);
  CHECK(exit_of_first("F1800 G1 X10\nM6 T1\nX20\n") == rests);
  CHECK(exit_of_first("F1800 G0 X10\nG1 X20 Y1\n",
                      {.tolerance = 0.01, .exact_between_rapids_and_feeds = true}) == rests);
  const auto passes = smoothed("F1800 G0 X10\nG1 X20 Y0.5\n");
  REQUIRE(passes);
  CHECK(passes->blocks()[0].exit > 5);
}

TEST_CASE("a corner that is passed at rest is exact, into an arc as well", "[smoothing]") {
  const std::string program = "G1 Y10\nG3 Y20 J5\nG1 X-10\nY30\n";  // sharp, tangent, sharp
  const auto planned = smoothed("F1800 " + program), stops = smoothed("F1800 G61.1 " + program);
  REQUIRE((planned && stops));
  CHECK(planned->blocks()[0].exit == Approx(0).margin(1e-6));
  for (const double s : {0.0, 0.5, 2.0}) {
    CHECK(planned->path(0).position_at(10 - s) == planned->program()[0].path.position_at(10 - s));
    CHECK(planned->path(1).position_at(s) == planned->program()[1].path.position_at(s));
  }
  const double first = stops->start_time(1);
  CHECK(planned->start_time(1) == Approx(first).epsilon(1e-12));
  CHECK(planned->duration() < stops->duration());
}

// Distance of the programmed corner from the curve.
double left_by(const std::string& program, const PlanOptions& options) {
  const auto planned = plan_text(program, mill, options);
  REQUIRE(planned);
  const auto path = planned->path(0);
  return (path.position_at(path.length()) - planned->program()[0].path.end()).norm();
}

TEST_CASE("G64 P sets the tolerance, block by block", "[smoothing]") {
  const std::string corner = "G1 X20\nX40 Y1\n";
  const double usual = left_by("F1800 " + corner, {.tolerance = 0.01, .level = SmoothLevel::fast});
  CHECK(usual > 0.004);
  CHECK(usual <= 0.01);
  CHECK(left_by("F1800 G64 P0.002 " + corner, {.tolerance = 0.01, .level = SmoothLevel::fast}) <=
        0.002 * (1 + 1e-12));
  CHECK(left_by("F1800 G64 P0.002 " + corner, {.tolerance = 0.01, .level = SmoothLevel::fast}) > 0.0015);
  CHECK(left_by("G20 F70 G64 P0.0001 G1 X1\nX2 Y0.1\n", {.tolerance = 0.01, .level = SmoothLevel::fast}) <=
        0.00254 * (1 + 1e-12));
  CHECK(left_by("F1800 G64 P0.002 G1 X20\nG64 X40 Y1\n", {.tolerance = 0.01, .level = SmoothLevel::fast}) <=
        0.002 * (1 + 1e-12));  // the lower of both
  CHECK(left_by("F1800 G64 P0.002\nG64 " + corner, {.tolerance = 0.01, .level = SmoothLevel::fast}) ==
        Approx(usual));
  CHECK(left_by("F1800 " + corner, {.tolerance = 0}) == 0);
  const auto planned = smoothed("G64 P0.02\nF600 G1 X1\n");
  REQUIRE(planned);
  CHECK(planned->warnings().empty());
  const auto merging = smoothed("G64 P0.02 Q0.01\nF600 G1 X1\nX2\n");
  REQUIRE(merging);
  CHECK(merging->warnings().empty());
  CHECK(smoothed("G64 P0.02 Q0.01\nF600 G1 X1\nX2\n", 0)->warnings().size() == 2);
}

TEST_CASE("limits of six axes hold on smooth paths, with a tolerance for rotary ones", "[smoothing]") {
  Machine<6> machine{.limits = {.velocity = 40, .acceleration = 800, .jerk = 9000}};
  for (std::size_t i = 0; i < 6; ++i) {
    Axis& axis = machine.axes[i];
    const bool turns = axis.kind == AxisKind::rotary;
    axis.velocity = turns ? 2.0 : 25.0;
    axis.acceleration = turns ? 30.0 : 600.0;
    axis.jerk = turns ? 600.0 : 7000.0;
  }
  test::Random random;
  for (int round = 0; round < 6; ++round) {
    using V = VectorN<double, 6>;
    std::vector<Block<6>> blocks;
    V at = V::Zero();
    for (int i = 0; i < 8; ++i) {
      V to = at;
      for (int k = 0; k < 3; ++k) to[k] += random.uniform(-6, 6);
      for (int k = 3; k < 6; ++k) to[k] += random.coin() ? random.uniform(-0.6, 0.6) : 0.0;
      blocks.push_back({.path = path::Line<6>(at, to), .feed = random.log_uniform(5, 60), .line = i});
      at = to;
    }
    INFO("seed " << test::seed() << " round " << round);
    const double rotary = 1e-3;
    const auto planned = plan_blocks(
        blocks, machine, {.tolerance = 0.02, .level = SmoothLevel::fast, .rotary_tolerance = rotary});
    check(planned, machine, 0.02);
    for (std::size_t b = 0; b < blocks.size(); ++b)
      for (int i = 0; i <= 50; ++i) {
        const double s = blocks[b].path.length() * i / 50;
        const V off = planned->path(b).position_at(s) - blocks[b].path.position_at(s);
        REQUIRE(off.tail<3>().cwiseAbs().maxCoeff() <= rotary * (1 + 1e-9));
        REQUIRE(off.head<3>().norm() <= 0.02 * (1 + 1e-9));
      }
  }
}

TEST_CASE("random programs keep limits and tolerance", "[smoothing]") {
  test::Random random;
  for (int round = 0; round < 40; ++round) {
    std::ostringstream text;
    text << std::fixed;
    text.precision(9);
    const double longest = random.log_uniform(0.1, 20), tolerance = random.log_uniform(0.002, 0.1);
    double x = 0, y = 0, z = 0;
    const int count = random.integer(2, 14);
    for (int i = 0; i < count; ++i) {
      const double length = longest * random.log_uniform(0.05, 1);
      const double a = random.uniform(-std::numbers::pi, std::numbers::pi);
      const double dx = length * std::cos(a), dy = length * std::sin(a);
      const int kind = random.integer(0, 9);
      if (kind == 9) z += random.uniform(-1, 1) * length;
      x += dx;
      y += dy;
      if (kind < 6 || kind == 9)
        text << "G1 X" << x << " Y" << y << " Z" << z << " F" << random.log_uniform(100, 3000) << "\n";
      else if (kind == 6)
        text << "G0 X" << x << " Y" << y << "\n";
      else
        text << (random.coin() ? "G2" : "G3") << " X" << x << " Y" << y << " R"
             << length * random.uniform(0.6, 3) << " F1200\n";
      if (random.integer(0, 9) == 0) text << (random.coin() ? "G4 P0.01\n" : "G61\n");
      if (random.integer(0, 5) == 0) text << "G64 P" << tolerance * random.uniform(0.3, 1) << "\n";
    }
    INFO("seed " << test::seed() << " round " << round << " tolerance " << tolerance << "\n" << text.str());
    check(smoothed(text.str(), tolerance), mill, tolerance);
  }
}

TEST_CASE("steps of a smoothed program follow its curve", "[smoothing]") {
  Machine<3> machine = mill;
  for (Axis& axis : machine.axes) axis.motors = {{.steps_per_unit = 400}};
  const auto planned = plan_text("F1800 G1 X10\nX12 Y5\nX3 Y6\nG3 X3 Y10 J2\nG1 X0 Y0\n", machine,
                                 {.tolerance = 0.02, .level = SmoothLevel::fast});
  REQUIRE(planned);
  std::array<long, 3> count{};
  double last = 0, worst = 0;
  for (const auto& edge : planned->step_edges()) {
    REQUIRE(edge.time >= last);
    last = edge.time;
    count[static_cast<std::size_t>(edge.axis)] += edge.direction;
    const double steps = planned->at(edge.time).position[edge.axis] * 400;
    const double boundary =
        static_cast<double>(count[static_cast<std::size_t>(edge.axis)]) - 0.5 * edge.direction;
    worst = std::max(worst, std::abs(steps - boundary));
  }
  CHECK(worst < 1e-3);
  CHECK(count[0] == 0);
  CHECK(count[1] == 0);
}
