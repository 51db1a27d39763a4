// Joints behind a map that winds: no jump where the formula has one, the shorter way, whole turns into the
// travel, and what no whole turn mends.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

#include "cncplan/block_reader.hpp"
#include "cncplan/executor.hpp"
#include "cncplan/kinematics/ready_made.hpp"
#include "cncplan/plan_program.hpp"
#include "maps/maps.hpp"
#include "support/catch.hpp"
#include "support/executor_machines.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

constexpr double pi = std::numbers::pi, degree = pi / 180;

// Radius, angle by atan2 alone, height; as a user writes it.
using Polar = MappedMachine<test::Polar>;

Polar polar(double low = -INFINITY, double high = INFINITY) {
  Polar machine = test::polar;
  machine.axes[1].low = low;
  machine.axes[1].high = high;
  return machine;
}

struct Followed {
  double jump = 0;    // the largest step of a joint between samples, over what its velocity allows
  double tip = 0;     // of the tool from where the joints put it
  double travel = 0;  // of the angle from start to end, rad
  double low = INFINITY, high = -INFINITY;
};

template <class T, class Tip>
Followed follow(const T& trajectory, const Tip& tip, int joint) {
  Followed result;
  constexpr double period = 0.002;
  auto before = trajectory.at(0).position;
  const double start = before[joint];
  for (const auto& point : trajectory.samples(period)) {
    for (int i = 0; i < before.size(); ++i) {
      const double velocity = trajectory.machine().axes[static_cast<std::size_t>(i)].velocity;
      result.jump = std::max(result.jump, std::abs(point.position[i] - before[i]) / (velocity * period));
    }
    before = point.position;
    result.tip = std::max(result.tip, (tip(point.position) - point.tool).norm());
    result.low = std::min(result.low, point.position[joint]);
    result.high = std::max(result.high, point.position[joint]);
  }
  result.travel = before[joint] - start;
  return result;
}

Vector3 polar_tip(const Vector3& q) { return {q[0] * std::cos(q[1]), q[0] * std::sin(q[1]), q[2]}; }

template <class M>
auto planned(const std::string& text, const M& machine, const std::array<double, 9>& start) {
  return plan_text(text, machine, {.tolerance = 0, .start = start});
}

std::string refusal_of(const auto& trajectory) {
  return trajectory ? std::string() : to_text(trajectory.error());
}

}  // namespace

TEST_CASE("a table that is told by atan2 goes on turning, round and round", "[turns]") {
  struct Case {
    std::string text;
    std::array<double, 9> start;
    double turns;
  };
  const std::array cases{
      Case{"F1200\nG3 X50 Y0 I-50\n", {50, 0, 0}, 1},      // a circle round the centre
      Case{"F1200\nG3 X-50 Y0 I50\n", {-50, 0, 0}, 1},     // from the cut itself
      Case{"F1200\nG2 X50 Y0 I-50 P3\n", {50, 0, 0}, -3},  // three turns
      Case{"F1200\nG3 X40 Y0 I-30 P2\n", {40, 0, 0}, 2},   // off the centre
      Case{"F1200\nG1 X-30 Y20\nX-30 Y-20\nX30 Y-20\nX30 Y20\nX-30 Y20\nX-30 Y-20\n", {30, 20, 0}, 1.5},
      Case{"F1200\nG1 X-30 Y1\nY-1\nY1\nY-1\n", {30, 20, 0}, 0.5},
      Case{
          "F1200\nG1 X-30.5 Y0.3\nG2 X-30.5 Y0.31 I2 J-0.3\n", {-30.5, -0.3, 0}, 0},  // over the cut and back
  };
  for (const Case& each : cases) {
    INFO(each.text);
    const auto trajectory = planned(each.text, polar(), each.start);
    INFO(refusal_of(trajectory));
    REQUIRE(trajectory);
    const Followed seen = follow(*trajectory, polar_tip, 1);
    CHECK(seen.jump < 1 + 1e-6);
    CHECK(seen.tip < 1e-9);
    CHECK(std::abs(seen.travel - each.turns * 2 * pi) < 1.5);
    CHECK(std::abs(std::remainder(seen.travel, 2 * pi) -
                   std::remainder(
                       trajectory->at(trajectory->duration()).position[1] - trajectory->at(0).position[1],
                       2 * pi)) < 1e-9);
  }
  const auto exact = planned(cases[2].text, polar(), cases[2].start);
  CHECK(follow(*exact, polar_tip, 1).travel == Approx(-6 * pi));
}

TEST_CASE("a smoothed path turns on where the formula jumps", "[turns]") {
  const std::string square = "X-30 Y20\nX-30 Y-20\nX30 Y-20\nX30 Y20\n";
  const auto trajectory =
      plan_text("F1200\nG1 " + square + square + "G3 X30 Y20 I-30 J-20\nG1 X-30 Y0\nX-30.5\n", polar(),
                {.tolerance = 0.05, .start = {30, 20, 0}});
  REQUIRE(trajectory);
  const Followed seen = follow(*trajectory, polar_tip, 1);
  CHECK(seen.jump < 1 + 1e-6);
  CHECK(seen.tip < 1e-9);
  CHECK(seen.travel == Approx(3 * 2 * pi + pi - std::atan2(20, 30)));
  bool smoothed = false;
  for (const auto& point : trajectory->samples(0.002))
    smoothed = smoothed || (std::abs(point.tool.x() + 30) < 0.06 && point.tool.y() > 19.9 &&
                            (point.tool - Vector3(-30, 20, 0)).norm() > 0.01 && point.velocity.norm() > 1);
  CHECK(smoothed);
}

TEST_CASE("rapids turn the shorter way, and stay within the travel", "[turns]") {
  const std::string text = "G0 X-50 Y-10\n";
  const auto shorter = planned(text, polar(), {-50, 10, 0});
  REQUIRE(shorter);
  CHECK(follow(*shorter, polar_tip, 1).travel == Approx(2 * std::atan2(10, 50)));
  CHECK(follow(*shorter, polar_tip, 1).tip < 1e-8);
  const auto longer = planned(text, polar(-pi, pi), {-50, 10, 0});
  REQUIRE(longer);
  CHECK(follow(*longer, polar_tip, 1).travel == Approx(2 * std::atan2(10, 50) - 2 * pi));
  const auto positive = planned(text, polar(0, 2 * pi), {50, -10, 0});
  REQUIRE(positive);
  const Followed seen = follow(*positive, polar_tip, 1);
  CHECK(seen.low >= 0);
  CHECK(seen.high <= 2 * pi);
  CHECK(seen.high == Approx(2 * pi - std::atan2(10, 50)));  // where it starts
}

TEST_CASE("a feed move that would leave the travel is refused at its place", "[turns]") {
  const auto refused = planned("F1200\nG1 X-50 Y10\nG1 X-50 Y-10\n", polar(-pi, pi), {50, 10, 0});
  CHECK(refusal_of(refused).find("3:4: error: axis C: ") != std::string::npos);
  // Whole turns bring the first motion into the travel: from 190 to 170 degrees, not from -170 to -190.
  CHECK(planned("F1200\nG1 X-50 Y10\n", polar(0, 2 * pi), {-50, -10, 0}));
  CHECK(planned("F1200\nG1 X-50 Y10\n", polar(-2 * pi, 0), {-50, -10, 0}));
}

TEST_CASE("a line through the centre is refused, and one beside it slows down", "[turns]") {
  CHECK(!planned("F1200\nG1 X-50 Y0\n", polar(), {50, 0, 0}));
  const auto beside = planned("F1200\nG1 X-50 Y0.01\n", polar(), {50, 0.01, 0});
  REQUIRE(beside);
  const Followed seen = follow(*beside, polar_tip, 1);
  CHECK(seen.jump < 1 + 1e-6);
  CHECK(seen.tip < 1e-9);
  CHECK(seen.travel == Approx(pi).epsilon(1e-3));
}

TEST_CASE("arms go on where their formulas jump, and end at the edge of their reach", "[turns]") {
  MappedMachine<kinematics::ThreeJoints> scara{
      .map = kinematics::Scara{}, .limits = {.velocity = 100, .acceleration = 1000, .jerk = 20000}};
  for (auto& axis : scara.axes)
    axis.kind = AxisKind::rotary, axis.velocity = 2, axis.acceleration = 20, axis.jerk = 300;
  scara.axes[2] = {.letter = 'Z', .velocity = 100};
  const auto tip = [&](const Vector3& q) -> Vector3 {
    const auto p = scara.map.point(std::array{q[0], q[1], q[2]});
    return {p[0], p[1], p[2]};
  };
  const auto round =
      planned("F6000\nG3 X200 Y0 I-200\nG1 X100 Y-200\nG1 X-200 Y-30\nG1 Y30\n", scara, {200, 0, 0});
  INFO(refusal_of(round));
  REQUIRE(round);
  CHECK(follow(*round, tip, 0).jump < 1 + 1e-6);
  CHECK(follow(*round, tip, 0).tip < 1e-8);
  // Out of reach, by the side, through the hole in the middle, and along its edge.
  CHECK(refusal_of(planned("F600\nG1 X360\n", scara, {200, 0, 0})).find("2:4: error: axis") !=
        std::string::npos);
  CHECK(!planned("F600\nG1 X-200\n", scara, {200, 10, 0}));
  CHECK(!planned("F600\nG1 X200 Y340\n", scara, {200, -340, 0}));
}

TEST_CASE("a wrist that counts against its arm goes on where the arm's formula jumps", "[turns]") {
  MappedMachine<kinematics::ScaraWrist> scara{
      .limits = {.velocity = 100, .acceleration = 1000, .jerk = 20000}};
  for (auto& axis : scara.axes)
    axis.kind = AxisKind::rotary, axis.velocity = 2, axis.acceleration = 20, axis.jerk = 300;
  scara.axes[2] = {.letter = 'Z', .velocity = 100};
  const auto trajectory =
      planned("F6000\nG3 X200 Y0 I-200 C90\nG1 X100 Y-200\nG1 X-200 Y-30 C0\nG1 Y30\nG0 Y-30\nG1 C720\n",
              scara, {200, 0, 0});
  INFO(refusal_of(trajectory));
  REQUIRE(trajectory);
  const auto tip = [&](const VectorN<double, 4>& q) -> Vector3 {
    const auto p = scara.map.point(std::array{q[0], q[1], q[2], q[3]});
    return {p[0], p[1], p[2]};
  };
  const Followed seen = follow(*trajectory, tip, 3);
  CHECK(seen.jump < 1 + 1e-6);
  CHECK(seen.tip < 1e-8);
  const auto end = trajectory->at(trajectory->duration()).position;
  CHECK(std::remainder(end[0] + end[1] + end[3], 2 * pi) == Approx(0).margin(1e-9));
}

TEST_CASE("a rapid turns a wrist as C says, and not as the arm's formula jumps", "[turns]") {
  MappedMachine<kinematics::ScaraWrist> scara{
      .limits = {.velocity = 100, .acceleration = 1000, .jerk = 20000}};
  for (auto& axis : scara.axes)
    axis.kind = AxisKind::rotary, axis.velocity = 2, axis.acceleration = 20, axis.jerk = 300;
  scara.axes[2] = {.letter = 'Z', .velocity = 100};
  for (const double c : {0.0, 30.0, 720.0, -360.0}) {
    char text[60];
    std::snprintf(text, sizeof text, "G0 Y-30 C%.0f\n", c);
    INFO(text);
    const auto trajectory = planned(text, scara, {-200, 30, 0, 0});
    REQUIRE(trajectory);
    const auto from = trajectory->at(0).position, to = trajectory->at(trajectory->duration()).position;
    CHECK(to[0] - from[0] == Approx(2 * std::atan2(30, 200)));  // the shorter way
    // The arm is as long as before: the tool turns by the shoulder's turn, and the wrist takes that back.
    CHECK(to[3] - from[3] == Approx(c * degree - 2 * std::atan2(30, 200)));
  }
}

TEST_CASE("random programs on arms and tables never jump", "[turns]") {
  test::Random random;
  MappedMachine<kinematics::WristArm> arm{.limits = {.velocity = 200, .acceleration = 2000, .jerk = 40000}};
  for (auto& axis : arm.axes)
    axis.kind = AxisKind::rotary, axis.velocity = 3, axis.acceleration = 30, axis.jerk = 600;
  int made = 0;
  for (int round = 0; round < 30; ++round) {
    const auto draw = [&](bool first) {
      char line[200];
      const double angle = random.uniform(-pi, pi), far = random.uniform(400, 800);
      std::snprintf(line, sizeof line, "%s X%.3f Y%.3f Z%.3f A%.3f B%.3f C%.3f\n",
                    !first && random.coin() ? "G1" : "G0", far * std::cos(angle), far * std::sin(angle),
                    random.uniform(200, 700), random.uniform(-40, 40), random.uniform(40, 130),
                    angle / degree + random.uniform(-60, 60));
      return std::string(line);
    };
    std::string text = "F9000\n" + draw(true);
    for (int i = 0; i < 4; ++i) text += draw(false);
    const auto trajectory = planned(text, arm, {600, 0, 400, 0, 90 * degree, 0});
    INFO(text);
    if (!trajectory) {  // beyond the arm's reach on the way
      CHECK(refusal_of(trajectory).find("error: axis") != std::string::npos);
      continue;
    }
    ++made;
    const auto tip = [&](const VectorN<double, 6>& q) -> Vector3 {
      const auto p = arm.map.point(std::array{q[0], q[1], q[2], q[3], q[4], q[5]});
      return {p[0], p[1], p[2]};
    };
    const Followed seen = follow(*trajectory, tip, 0);
    CHECK(seen.jump < 1 + 1e-6);
    CHECK(seen.tip < 1e-6);
  }
  CHECK(made >= 5);
}

TEST_CASE("turns that a program names are its own", "[turns]") {
  MappedMachine<kinematics::FiveAxes> mill{.limits = {.velocity = 80, .acceleration = 1000, .jerk = 20000}};
  for (auto& axis : mill.axes) axis.velocity = 50, axis.acceleration = 500, axis.jerk = 10000;
  for (const std::string on : {"", "G43.4\n"}) {
    const auto trajectory = planned("F6000\n" + on + "G0 C720\nG1 X10 C0\nG0 C-1000\n", mill, {});
    REQUIRE(trajectory);
    double high = 0;
    for (const auto& point : trajectory->samples(0.01)) high = std::max(high, point.position[4]);
    CHECK(high == Approx(720 * degree).epsilon(1e-3));
    CHECK(trajectory->at(trajectory->duration()).position[4] == Approx(-1000 * degree));
  }
}

TEST_CASE("line by line the joints turn as in the whole program", "[turns]") {
  const PlanOptions options{.tolerance = 0, .start = {50, 0, 0}};
  const std::array<std::string, 5> lines{"F1200", "G3 X50 Y0 I-50 P2", "G0 X-50 Y10", "G1 Y-10", "G1 X9e9"};
  BlockReader reader(polar(-INFINITY, 40), options);
  double angle = 0;
  for (const std::string& line : lines) {
    const auto blocks = reader.read_line(line);
    if (line == "G1 X9e9") continue;
    REQUIRE(blocks);
    for (const auto& block : *blocks)
      if (block.path.length() > 0) angle = block.path.end()[1];
  }
  CHECK(angle == Approx(4 * pi + pi + std::atan2(10, 50)));
}

TEST_CASE("in a jog the tool is known where the map has an inverse", "[turns]") {
  MappedMachine<kinematics::CoreXY> printer{
      .axes = {{{.letter = 'A', .velocity = 100, .acceleration = 1000, .jerk = 20000},
                {.letter = 'B', .velocity = 100, .acceleration = 1000, .jerk = 20000},
                {.letter = 'Z', .velocity = 100, .acceleration = 1000, .jerk = 20000}}},
      .limits = {.velocity = 100, .acceleration = 1000, .jerk = 20000}};
  Executor<MappedMachine<kinematics::CoreXY>, 16> executor(printer, {.background = true});
  REQUIRE(executor.jog_to(Vector3(8, 2, 3)));
  SetPoint<3> point;
  double off = 0;
  for (int tick = 0; tick < 2000; ++tick) {
    point = executor.tick(0.001);
    const auto& q = point.position;
    off = std::max(off, (point.tool - Vector3((q[0] + q[1]) / 2, (q[0] - q[1]) / 2, q[2])).norm());
  }
  CHECK(off < 1e-12);
  CHECK((point.tool - Vector3(5, 3, 3)).norm() < 1e-9);
}
