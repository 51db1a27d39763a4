// --motions against what LinuxCNC makes of eight real programs.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "gcode/linuxcnc.hpp"
#include "simulate/programs.hpp"
#include "simulate/table.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

constexpr double turn = 2.0 * std::numbers::pi;

// Angle of a point about a centre, in the plane.
double angle_of(const Vector3& point, const Vector3& center, Plane plane) {
  const auto [first, second, third] = axes(plane);
  return std::atan2(point[second] - center[second], point[first] - center[first]);
}

// Signed sweep from start to end about a centre, whole turns included: `rotation` turns begun.
double sweep_of(const Vector3& start, const Vector3& end, const Vector3& center, Plane plane, int rotation) {
  const double sense = rotation < 0 ? -1.0 : 1.0;
  double sweep = sense * (angle_of(end, center, plane) - angle_of(start, center, plane));
  sweep -= turn * std::floor(sweep / turn);
  if (sweep < 1e-9) sweep += turn;
  return sense * (sweep + turn * (std::abs(rotation) - 1));
}

// Length of a spiral whose radius and height are linear in the angle, by Simpson's rule.
double spiral_length(double radius, double last_radius, double sweep, double height) {
  constexpr int intervals = 64;
  const auto speed = [&](double u) {
    return std::hypot((radius + (last_radius - radius) * u) * sweep, last_radius - radius, height);
  };
  double sum = 0.0;
  for (int i = 0; i < intervals; ++i)
    sum += speed(static_cast<double>(i) / intervals) + 4.0 * speed((i + 0.5) / intervals) +
           speed((i + 1.0) / intervals);
  return sum / (6.0 * intervals);
}

}  // namespace

TEST_CASE("the motions of real programs are LinuxCNC's") {
  test::for_real_programs([](const std::string& name, const std::string& path) {
    INFO(name);
    const test::Folder folder;
    const auto run = folder.run(test::quoted(path + ".ngc") + " --quiet --motions motions.csv --period 0.1");
    REQUIRE(run.exit == 0);
    const test::Table rows(folder / "motions.csv");
    const auto expected = test::read_canonical(path + ".motions");
    REQUIRE(rows.rows() == expected.size());
    double end_error = 0.0, center_error = 0.0, third_error = 0.0, radius_error = 0.0, sweep_error = 0.0,
           start_error = 0.0, length_error = 0.0, feed_error = 0.0;
    int wrong_kinds = 0, wrong_planes = 0;
    Vector3 start = Vector3::Zero();
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const auto& motion = expected[i];
      const auto grow = [](double& worst, double error) { worst = std::max(worst, std::abs(error)); };
      const auto value = [&](const char* column) { return rows[column][i]; };
      const bool is_arc = motion.kind == gcode::MotionKind::arc_center;
      const double expected_kind = is_arc                                    ? test::kind::arc
                                   : motion.kind == gcode::MotionKind::rapid ? test::kind::rapid
                                                                             : test::kind::line;
      wrong_kinds += value("kind") != expected_kind;
      wrong_planes += value("plane") != (motion.plane == Plane::xy   ? 17
                                         : motion.plane == Plane::zx ? 18
                                                                     : 19);
      const Vector3 from(value("x0"), value("y0"), value("z0"));
      const Vector3 to(value("x1"), value("y1"), value("z1"));
      grow(start_error, (from - start).norm());
      grow(end_error, (to - motion.end).norm());
      grow(feed_error,
           value("feed") - (motion.kind == gcode::MotionKind::rapid ? 30.0 : motion.feed.value_or(30.0)));
      start = motion.end;
      if (!is_arc) {
        grow(length_error, value("length") - (to - from).norm());
        wrong_kinds +=
            !std::isnan(value("cx")) || !std::isnan(value("radius")) || !std::isnan(value("sweep"));
        continue;
      }
      const Vector3 center(value("cx"), value("cy"), value("cz"));
      const auto [first, second, third] = axes(motion.plane);
      grow(center_error,
           std::hypot(center[first] - motion.center[first], center[second] - motion.center[second]));
      grow(third_error, center[third] - from[third]);
      const double radius = std::hypot(from[first] - center[first], from[second] - center[second]);
      const double last_radius = std::hypot(to[first] - center[first], to[second] - center[second]);
      grow(radius_error, value("radius") - radius);
      grow(sweep_error, value("sweep") - sweep_of(from, to, motion.center, motion.plane, motion.rotation));
      // radius and height linear in the angle
      grow(length_error,
           value("length") - spiral_length(radius, last_radius, value("sweep"), to[third] - from[third]));
    }
    CHECK(wrong_kinds == 0);
    CHECK(wrong_planes == 0);
    CHECK(start_error < 1e-9);
    CHECK(end_error < 1e-9);
    CHECK(center_error < 1e-6);
    CHECK(third_error < 1e-12);
    CHECK(radius_error < 1e-9);
    CHECK(sweep_error < 1e-6);
    CHECK(length_error < 1e-6);
    CHECK(feed_error < 1e-9);
  });
}
