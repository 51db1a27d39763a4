// Tool-point control: the tip by forward kinematics written anew, the modes that switch it, and what it
// refuses.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "cncplan/block_reader.hpp"
#include "cncplan/kinematics/ready_made.hpp"
#include "cncplan/plan_program.hpp"
#include "maps/maps.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

constexpr double degree = std::numbers::pi / 180;
using Vector5 = VectorN<double, 5>;
using Mill = MappedMachine<kinematics::FiveAxes>;

Mill mill() {
  return {.map = kinematics::TableTableAC{.center = {0, 0, -60}},
          .axes = {{{.letter = 'X', .velocity = 200, .acceleration = 2000, .jerk = 40000},
                    {.letter = 'Y', .velocity = 200, .acceleration = 2000, .jerk = 40000},
                    {.letter = 'Z', .velocity = 150, .acceleration = 1500, .jerk = 30000},
                    {.letter = 'A',
                     .kind = AxisKind::rotary,
                     .velocity = 90 * degree,
                     .acceleration = 720 * degree,
                     .jerk = 7200 * degree,
                     .low = -100 * degree,
                     .high = 100 * degree},
                    {.letter = 'C',
                     .kind = AxisKind::rotary,
                     .velocity = 180 * degree,
                     .acceleration = 1440 * degree,
                     .jerk = 14400 * degree}}},
          .limits = {.velocity = 80, .acceleration = 1000, .jerk = 20000}};
}

// The tip in the part of a tool of so many mm.
Vector3 tip(const Vector5& q, double length = 0) {
  const Vector3 center(0, 0, -60);
  const Eigen::AngleAxisd a(q[3], Vector3::UnitX()), c(q[4], Vector3::UnitZ());
  const Vector3 at(q[0], q[1], q[2] - length);
  return center + (a.toRotationMatrix() * c.toRotationMatrix()).transpose() * (at - center);
}

double off_line(const Vector3& p, const Vector3& a, const Vector3& b) {
  const Vector3 way = b - a;
  const double t = std::clamp((p - a).dot(way) / way.squaredNorm(), 0.0, 1.0);
  return (p - a - t * way).norm();
}

// All that programs do, and its blocks' ends in the axes.
template <class T>
std::vector<Vector5> ends(const T& trajectory) {
  std::vector<Vector5> result;
  for (const auto& block : trajectory.program())
    if (block.path.length() > 0) result.push_back(block.path.end());
  return result;
}

std::string refused(const std::string& text) {
  const auto trajectory = plan_text(text, mill(), {.tolerance = 0});
  return trajectory ? std::string() : to_text(trajectory.error());
}

}  // namespace

TEST_CASE("under G43.4 X Y Z is the tip in the part, and the axes keep their limits", "[tool point]") {
  const std::string text =
      "G21 G90 G94 F3000\nG43.4\nG1 X40 Y0 Z0 A0 C0\nG1 X40 Y30 A-30 C45\nG1 X0 Y40 A-45 C120\n"
      "G1 X-30 Y10 Z5 A-20 C200\nG49\nM30\n";
  const auto trajectory = plan_text(text, mill(), {.tolerance = 0});
  REQUIRE(trajectory);
  const std::array<Vector3, 5> points{Vector3(0, 0, 0), Vector3(40, 0, 0), Vector3(40, 30, 0),
                                      Vector3(0, 40, 0), Vector3(-30, 10, 5)};
  const std::array<std::array<double, 2>, 5> angles{{{0, 0}, {0, 0}, {-30, 45}, {-45, 120}, {-20, 200}}};
  double off = 0, told = 0, turn = 0, feed = 0, velocity = 0, acceleration = 0, jerk = 0;
  for (const auto& point : trajectory->samples(0.001)) {
    told = std::max(told, (tip(point.position) - point.tool).norm());
    const auto i = static_cast<std::size_t>(std::clamp(point.line - 2, 1, 4));
    off = std::max(off, off_line(point.tool, points[i - 1], points[i]));
    const double share = (point.tool - points[i - 1]).norm() / (points[i] - points[i - 1]).norm();
    for (int k = 0; k < 2; ++k) {
      const auto j = static_cast<std::size_t>(k);
      const double linear = angles[i - 1][j] + (angles[i][j] - angles[i - 1][j]) * std::min(share, 1.0);
      turn = std::max(turn, std::abs(point.position[3 + k] - linear * degree));
    }
    feed = std::max(feed, point.along.velocity);
    const std::array v{200., 200., 150., 90 * degree, 180 * degree};
    const std::array a{2000., 2000., 1500., 720 * degree, 1440 * degree};
    const std::array j{40000., 40000., 30000., 7200 * degree, 14400 * degree};
    for (int k = 0; k < 5; ++k) {
      const auto n = static_cast<std::size_t>(k);
      velocity = std::max(velocity, std::abs(point.velocity[k]) / v[n]);
      acceleration = std::max(acceleration, std::abs(point.acceleration[k]) / a[n]);
      jerk = std::max(jerk, std::abs(point.jerk[k]) / j[n]);
    }
  }
  CHECK(told < 1e-10);
  CHECK(off < 1e-9);
  CHECK(turn < 1e-9);
  CHECK(feed > 49);
  CHECK(feed <= 50 * (1 + 1e-12));
  CHECK(velocity < 1 + 1e-9);
  CHECK(acceleration < 1 + 1e-9);
  CHECK(jerk < 1 + 1e-9);
}

TEST_CASE("under G43.4 corners are smoothed at the tip, within the axes' limits", "[tool point]") {
  const std::vector<Vector3> points{{40, 0, 0}, {40, 30, 0}, {0, 40, 0}, {-30, 10, 5}, {-30, -20, 0}};
  const std::array<std::array<double, 2>, 5> angles{{{0, 0}, {-30, 45}, {-45, 120}, {-20, 200}, {-20, 200}}};
  std::string text = "F3000\nG43.4\n";
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::array<char, 120> line;
    std::snprintf(line.data(), line.size(), "G1 X%g Y%g Z%g A%g C%g\n", points[i].x(), points[i].y(),
                  points[i].z(), angles[i][0], angles[i][1]);
    text += line.data();
  }
  const PlanOptions options{.tolerance = 0.02, .rotary_tolerance = 0.05 * degree};
  const auto trajectory = plan_text(text, mill(), options);
  REQUIRE(trajectory);
  CHECK(trajectory->fallbacks().empty());
  double off = 0, told = 0, jerk = 0;
  constexpr double period = 0.001;
  std::vector<Vector5> axes;
  for (const auto& point : trajectory->samples(period)) {
    if (point.time > trajectory->duration() - 1e-9) break;
    axes.push_back(point.position);
    told = std::max(told, (tip(point.position) - point.tool).norm());
    double nearest = (point.tool - Vector3(0, 0, 0)).norm();
    nearest = std::min(nearest, off_line(point.tool, {0, 0, 0}, points[0]));
    for (std::size_t i = 1; i < points.size(); ++i)
      nearest = std::min(nearest, off_line(point.tool, points[i - 1], points[i]));
    off = std::max(off, nearest);
  }
  const std::array most{40000., 40000., 30000., 7200 * degree, 14400 * degree};
  for (std::size_t i = 3; i < axes.size(); ++i)
    for (int k = 0; k < 5; ++k) {
      const double third = axes[i][k] - 3 * axes[i - 1][k] + 3 * axes[i - 2][k] - axes[i - 3][k];
      jerk = std::max(jerk, std::abs(third) / (period * period * period) / most[static_cast<std::size_t>(k)]);
    }
  CHECK(told < 1e-9);
  CHECK(off > 0.001);
  CHECK(off <= 0.02 * (1 + 1e-6));
  CHECK(jerk <= 1.001);
  const auto exact = plan_text(text, mill(), {.tolerance = 0});
  CHECK(trajectory->duration() < exact->duration());
}

TEST_CASE("tool-point control is switched on and off, and the axes go on from where they are",
          "[tool point]") {
  for (const auto& [on, off] : {std::pair("G43.4", "G49"), std::pair("M428", "M429")}) {
    const std::string text = std::string("F3000\nG1 X10 Y5 A30 C90\n") + on + "\nG1 X-20 C10\nG1 Z4\n" + off +
                             "\nG1 X50\nG1 A0\n" + on + "\nG1 X1 Y2 Z3\n";
    INFO(text);
    const auto trajectory = plan_text(text, mill(), {.tolerance = 0});
    REQUIRE(trajectory);
    const auto q = ends(*trajectory);
    REQUIRE(q.size() == 6);
    CHECK((q[0] - (Vector5() << 10, 5, 0, 30 * degree, 90 * degree).finished()).norm() < 1e-12);
    // What is not named stays: Y and Z of the tip, not of the axes.
    const Vector3 before = tip(q[0]);
    CHECK((tip(q[1]) - Vector3(-20, before.y(), before.z())).norm() < 1e-10);
    CHECK(q[1][3] == q[0][3]);
    CHECK(q[1][4] == Approx(10 * degree));
    CHECK((tip(q[2]) - Vector3(-20, before.y(), 4)).norm() < 1e-10);
    // Off: Y, Z, A and C of the axes stay.
    CHECK(q[3][0] == 50);
    CHECK((q[3] - q[2]).tail<4>().norm() < 1e-10);
    CHECK((q[4] - q[3]).head<3>().norm() < 1e-10);
    CHECK((tip(q[5]) - Vector3(1, 2, 3)).norm() < 1e-10);
    // The machine rests where places change their meaning.
    double at_switch = 1e9;
    for (const auto& point : trajectory->samples(0.0005))
      at_switch = std::min(at_switch, (point.position - q[2]).norm() + point.velocity.norm());
    CHECK(at_switch < 0.02);
    // The tool is the tip in the part all along, also while the axes are driven.
    double told = 0;
    for (const auto& point : trajectory->samples(0.002))
      told = std::max(told, (tip(point.position) - point.tool).norm());
    CHECK(told < 1e-9);
  }
}

TEST_CASE("the tool's length turns with the table, and work offsets with the part", "[tool point]") {
  gcode::Dialect dialect = dialect_of(mill());
  dialect.tools = {{.number = 1, .length = 80}, {.number = 2, .length = 50}};
  dialect.work_offsets[1] = {7, -3, 2};
  const PlanOptions options{.tolerance = 0, .dialect = dialect};
  const auto trajectory = plan_text(
      "F3000 G55 G43.4 H1\nG1 X10 Y5 Z2 A30 C90\nG43.4 H2\nG1 X11\nG43 H2\nG1 Y40\n", mill(), options);
  REQUIRE(trajectory);
  const auto q = ends(*trajectory);
  REQUIRE(q.size() == 3);
  CHECK((tip(q[0], 80) - Vector3(17, 2, 4)).norm() < 1e-10);
  const Vector3 with_other = tip(q[0], 50);
  CHECK((tip(q[1], 50) - Vector3(18, with_other.y(), with_other.z())).norm() < 1e-10);
  CHECK(q[2][1] == Approx(37));
  CHECK((q[2] - q[1])[0] == Approx(0).margin(1e-10));
  CHECK((q[2] - q[1])[2] == Approx(0).margin(1e-10));
}

TEST_CASE("under G43.5 I J K is the direction of the tool", "[tool point]") {
  const auto trajectory = plan_text("F3000 G43.5\nG1 X10 Y5 Z2 I1 J1 K2\nX20 I0 J-1 K1\nI0 J0 K1\nY9 I-1\n",
                                    mill(), {.tolerance = 0});
  REQUIRE(trajectory);
  const auto q = ends(*trajectory);
  REQUIRE(q.size() == 4);
  const std::array<Vector3, 4> directions{Vector3(1, 1, 2), Vector3(0, -1, 1), Vector3(0, 0, 1),
                                          Vector3(-1, 0, 0)};
  for (std::size_t i = 0; i < q.size(); ++i) {
    const Eigen::AngleAxisd a(q[i][3], Vector3::UnitX()), c(q[i][4], Vector3::UnitZ());
    const Vector3 tool = (a.toRotationMatrix() * c.toRotationMatrix()).transpose() * Vector3::UnitZ();
    CHECK((tool - directions[i].normalized()).norm() < 1e-9);
    CHECK(std::abs(q[i][3]) <= 100 * degree);
    if (i > 0) CHECK(std::abs(q[i][4] - q[i - 1][4]) <= 90.001 * degree);  // the shorter of two ways
  }
  CHECK(q[2][4] == q[1][4]);  // upright: C stays
  CHECK((tip(q[3]) - Vector3(20, 9, 2)).norm() < 1e-10);
}

TEST_CASE("where the tip rests the axes turn by degrees a minute", "[tool point]") {
  const auto trajectory = plan_text("F600 G43.4\nG1 X40\nG1 A-40 C20\nG1 X10\n", mill(), {.tolerance = 0});
  REQUIRE(trajectory);
  double moved = 0, fastest = 0;
  for (const auto& point : trajectory->samples(0.001)) {
    if (point.line != 3) continue;
    moved = std::max(moved, (tip(point.position) - Vector3(40, 0, 0)).norm());
    fastest = std::max(fastest, point.velocity.tail<2>().norm());
  }
  CHECK(moved < 1e-9);
  CHECK(fastest == Approx(10 * degree));
}

TEST_CASE("what does not go with tool-point control is refused at its place", "[tool point]") {
  CHECK(refused("F100\nG43.4\nG53 G1 X3\n").find("3:1: error: G53") != std::string::npos);
  CHECK(refused("F100\nG43.4\nG28\n").find("3:1: error: G28") != std::string::npos);
  CHECK(refused("F100\nG43.4\nG41.1 D3\n").find("3:") != std::string::npos);
  CHECK(refused("M430\n").find("1:1: error: M430") != std::string::npos);
  CHECK(refused("M428 P1\n").find("1:1: error: M428") != std::string::npos);
  CHECK(refused("F100 G43.5\nG1 X1 I0 J0 K0\n").find("2:7: error: I J K") != std::string::npos);
  CHECK(refused("F100 G43.5\nG1 X1 I1 C3\n").find("2:10: error: C") != std::string::npos);
  CHECK(refused("F100 G43.4\nG1 X1 I1\n").find("2:7: error: I") != std::string::npos);
  CHECK(!plan_text("G43.4\n", Machine<5>{.limits = {10, 10, 10}}));
  CHECK(refused("F100 G43.4\nG1 X10 A130\n").find("2:8: error: axis A: ") != std::string::npos);
}

TEST_CASE("tool-point control line by line makes the blocks of the whole program", "[tool point]") {
  const std::vector<std::string> lines{
      "F3000", "G1 X10 Y5 A30 C90", "G43.4 G1 X-20 C10", "G43.5 G1 X3 I1 J0 K1", "G1 Y2 M429", "G1 X50",
      "M428",  "G1 Z5 C-40"};
  std::string text;
  for (const auto& line : lines) text += line + "\n";
  const auto program = read_text(text, mill(), {.tolerance = 0});
  INFO((program.failed() ? to_text(*program.first_error()) : std::string()));
  REQUIRE_FALSE(program.failed());
  BlockReader reader(mill(), {.tolerance = 0});
  std::vector<Vector5> live;
  for (const auto& line : lines) {
    const auto blocks = reader.read_line(line);
    REQUIRE(blocks);
    if (!blocks->empty()) CHECK(!reader.read_line("G1 X1"));  // blocks are left
    for (const auto& block : *blocks)
      if (block.path.length() > 0) live.push_back(block.path.end());
  }
  std::vector<Vector5> whole;
  for (const auto& block : program.blocks())
    if (block.path.length() > 0) whole.push_back(block.path.end());
  CHECK(live == whole);
  CHECK(whole.size() == 6);
}

TEST_CASE("other five-axis machines keep the tip as well", "[tool point]") {
  const std::string text = "F3000\nG43.4\nG1 X40 B20 C30\nG1 Y20 Z-5 B-50 C400\nG0 X0 Y0 Z30 B0 C0\n";
  const auto check = [&](const auto& map, const auto& forward) {
    Mill machine{.map = map, .limits = {.velocity = 80, .acceleration = 1000, .jerk = 20000}};
    for (auto& axis : machine.axes) axis.velocity = 100, axis.acceleration = 1000, axis.jerk = 20000;
    const auto trajectory = plan_text(text, machine, {.tolerance = 0});
    REQUIRE(trajectory);
    double told = 0, off = 0;
    for (const auto& point : trajectory->samples(0.002)) {
      told = std::max(told, (forward(point.position) - point.tool).norm());
      if (point.line == 4) off = std::max(off, off_line(point.tool, {40, 0, -60}, {40, 20, -5}));
    }
    CHECK(told < 1e-9);
    CHECK(off < 1e-9);
    const Vector5 end = trajectory->at(trajectory->duration()).position;
    CHECK(end.tail<2>().norm() < 1e-12);
  };
  check(kinematics::HeadTable{.center = {5, 0, 0}, .pivot_length = 150, .tool_length = 60},
        [](const Vector5& q) -> Vector3 {
          const Vector3 tool(std::sin(q[3]), 0, std::cos(q[3])), center(5, 0, 0);
          const Vector3 at = q.head<3>() + 150 * Vector3::UnitZ() - 210 * tool;
          return center + Eigen::AngleAxisd(-q[4], Vector3::UnitZ()) * Vector3(at - center);
        });
  check(kinematics::HeadHeadBC{.pivot_length = 150, .tool_length = 60}, [](const Vector5& q) -> Vector3 {
    const Vector3 tool(std::sin(q[3]) * std::cos(q[4]), std::sin(q[3]) * std::sin(q[4]), std::cos(q[3]));
    return q.head<3>() + 150 * Vector3::UnitZ() - 210 * tool;
  });
}
