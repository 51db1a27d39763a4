#include "cncplan/step_edges.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

#include "cncplan/path/measured.hpp"
#include "cncplan/plan_program.hpp"
#include "support/catch.hpp"
#include "support/curves.hpp"

using namespace cncplan;

namespace {

struct Edge {
  double time;
  int direction;
};

// What `at` says of one axis is all that the oracle knows. The counter stands at the whole number nearest to
// the position in steps; an edge is where that changes. Between samples so near that the axis passes no two
// boundaries unseen, each is found by bisection.
template <class T>
std::vector<Edge> edges_by_bisection(const T& trajectory, int axis, double steps_per_unit, double sampling) {
  const auto steps = [&](double t) {
    return static_cast<long double>(trajectory.at(t).position[axis]) * steps_per_unit;
  };
  std::vector<Edge> edges;
  const double end = trajectory.duration();
  auto count = static_cast<long double>(std::llround(steps(0)));
  double before = 0;
  for (std::int64_t k = 1; before < end; ++k) {
    const double now = std::min(static_cast<double>(k) * sampling, end);
    for (long double value = steps(now); std::abs(value - count) > 0.5L;) {
      const int direction = value > count ? 1 : -1;
      const long double boundary = count + direction * 0.5L;
      double low = before, high = now;
      for (int round = 0; round < 60; ++round) {
        const double middle = low + (high - low) / 2;
        ((steps(middle) - boundary) * direction > 0 ? high : low) = middle;
      }
      edges.push_back({high, direction});
      before = std::max(before, low);
      count += direction;
    }
    before = now;
  }
  return edges;
}

// Edges of each motor, and that all are in order of time.
template <class T>
std::map<std::size_t, std::vector<Edge>> edges_of(const T& trajectory) {
  std::map<std::size_t, std::vector<Edge>> result;
  double last = -1;
  for (const auto& edge : trajectory.step_edges()) {
    REQUIRE(edge.time >= last);
    last = edge.time;
    result[edge.motor].push_back({edge.time, edge.direction});
  }
  return result;
}

// Compares one motor with the oracle. An edge at low speed is uncertain in time: what counts is where the
// axis is then.
template <class T>
void check_motor(const T& trajectory, const std::vector<Edge>& edges, int axis, double steps_per_unit) {
  const auto expected = edges_by_bisection(trajectory, axis, steps_per_unit, 1e-4);
  INFO("axis " << axis << ", " << steps_per_unit << " steps per unit");
  REQUIRE(edges.size() == expected.size());
  double worst_time = 0, worst_place = 0;
  auto count = static_cast<double>(std::llround(trajectory.at(0).position[axis] * steps_per_unit));
  for (std::size_t i = 0; i < edges.size(); ++i) {
    REQUIRE(edges[i].direction == expected[i].direction);
    const auto at = trajectory.at(edges[i].time);
    const double boundary = (count + edges[i].direction * 0.5) / steps_per_unit;
    worst_place = std::max(worst_place, std::abs(at.position[axis] - boundary) * steps_per_unit);
    if (std::abs(at.velocity[axis]) > 1)
      worst_time = std::max(worst_time, std::abs(edges[i].time - expected[i].time));
    count += edges[i].direction;
  }
  CHECK(worst_place < 1e-6);  // steps
  CHECK(worst_time < 1e-9);   // s
  CHECK(count == static_cast<double>(
                     std::llround(trajectory.at(trajectory.duration()).position[axis] * steps_per_unit)));
}

step::Drive drive(double steps_per_unit) {
  step::Drive result;
  result.steps_per_unit = steps_per_unit;
  return result;
}

Machine<3> stepped(double x, double y, double z) {
  Machine<3> machine{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  machine.axes[0].motors = {drive(x)};
  machine.axes[1].motors = {drive(y)};
  machine.axes[2].motors = {drive(z)};
  return machine;
}

}  // namespace

TEST_CASE("edges of lines, arcs and helices are where the axes pass their boundaries", "[edges]") {
  const auto planned = plan_text(
      "G1 X7.3 Y-2 Z1 F1500\nG2 X12 Y3 R6\nG4 P0.3\nG3 X20 Y3 Z4 I4 J0 P2\nG1 X19.99\nG1 X0 Y0\nM0\nG0 Z-3\n",
      stepped(80, 123.4, 400), {.tolerance = 0});
  INFO((planned ? std::string() : to_text(planned.error())));
  REQUIRE(planned);
  auto edges = edges_of(*planned);
  check_motor(*planned, edges[0], 0, 80);
  check_motor(*planned, edges[1], 1, 123.4);
  check_motor(*planned, edges[2], 2, 400);
}

TEST_CASE("two motors of an axis step alike, numbered in the order of axes", "[edges]") {
  Machine<3> gantry = stepped(80, 80, 400);
  gantry.axes[1].motors = {drive(80), drive(200)};
  const auto planned = plan_text("G1 X5 Y3 F900\nG3 X9 Y7 R4\nG1 Y0 Z1\n", gantry, {.tolerance = 0});
  REQUIRE(planned);
  CHECK(planned->step_edges().motor_count() == 4);
  auto edges = edges_of(*planned);
  check_motor(*planned, edges[1], 1, 80);
  check_motor(*planned, edges[2], 1, 200);
  check_motor(*planned, edges[3], 2, 400);
  for (const auto& edge : planned->step_edges()) {
    const int axis = edge.motor == 0 ? 0 : edge.motor == 3 ? 2 : 1;
    REQUIRE(edge.axis == axis);
  }
}

TEST_CASE("steps go on through pauses and begin where the motion starts", "[edges]") {
  const auto planned =
      plan_text("G4 P0.2\nG1 X10 F600\nG4 P0.5\nG4 P0.1\nG1 X10.003\nG4 P0.1\nG1 X4\nG4 P1\n",
                stepped(100, 1, 1), {.tolerance = 0, .start = {2.504, 0, 0}});
  REQUIRE(planned);
  auto edges = edges_of(*planned);
  check_motor(*planned, edges[0], 0, 100);
  CHECK(edges[1].empty());
  CHECK(edges[0].front().time > 0.2);
  // Between the steps up and those back there is the pause.
  for (std::size_t i = 1; i < edges[0].size(); ++i)
    if (edges[0][i].direction != edges[0][i - 1].direction)
      CHECK(edges[0][i].time - edges[0][i - 1].time > 0.6);
}

TEST_CASE("edges on a curve of one's own and on spirals of several cells", "[edges]") {
  const auto curve = path::measured(test::Ellipse{});
  REQUIRE(curve);
  path::ArcGeometry<double> g{
      .start = {60, 0, 0}, .end = {30, 0, 0}, .center = {40, 0, 0}, .radial = {20, 0, 0}};
  g.start_radius = 20;
  g.end_radius = 10;
  g.angle = 3.0 * 3.14159265358979323846;
  g.turn = Turn::counterclockwise;
  using B = Block<3, path::Measured<test::Ellipse>>;
  const std::vector<B> blocks{{.path = path::Line<3>({0, 0, 0}, {20, 0, 0}), .feed = 30},
                              {.path = *curve, .feed = 30},
                              {.path = path::Arc(g), .feed = 30}};
  const auto planned = plan_blocks(blocks, stepped(80, 200, 1), {.tolerance = 0});
  REQUIRE(planned);
  auto edges = edges_of(*planned);
  check_motor(*planned, edges[0], 0, 80);
  check_motor(*planned, edges[1], 1, 200);
  CHECK(edges[2].empty());
}

TEST_CASE("edges of joints behind a map, rapids among them", "[edges]") {
  MappedMachine<test::Scara> arm{
      .map = {},
      .axes = {{{.letter = 'J', .kind = AxisKind::rotary, .velocity = 2, .acceleration = 10, .jerk = 100},
                {.letter = 'K', .kind = AxisKind::rotary, .velocity = 3, .acceleration = 15, .jerk = 150},
                {.letter = 'Z', .velocity = 100, .acceleration = 500, .jerk = 5000}}},
      .limits = {.velocity = 150, .acceleration = 2000, .jerk = 40000}};
  arm.axes[0].motors = {drive(3183.1)};
  arm.axes[1].motors = {drive(2000)};
  arm.axes[2].motors = {drive(50)};
  const auto planned =
      plan_text("G1 F6000 X260 Y-100\nG4 P0.2\nG3 X160 Y0 Z20 R100\nG0 X250 Y-180 Z0\nG1 Y100\n", arm,
                {.tolerance = 0, .start = {250, -180, 0}});
  REQUIRE(planned);
  auto edges = edges_of(*planned);
  const auto fine = [&](std::size_t motor, int axis, double steps) {
    INFO("joint " << axis);
    const auto expected = edges_by_bisection(*planned, axis, steps, 2e-5);
    REQUIRE(edges[motor].size() == expected.size());
    double worst = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      REQUIRE(edges[motor][i].direction == expected[i].direction);
      const auto at = planned->at(edges[motor][i].time);
      if (std::abs(at.velocity[axis]) * steps > 50)
        worst = std::max(worst, std::abs(edges[motor][i].time - expected[i].time));
    }
    CHECK(worst < 1e-9);
  };
  fine(0, 0, 3183.1);
  fine(1, 1, 2000);
  fine(2, 2, 50);
}

// The oracle: the edges without backlash, with so many more at each change of direction.
TEST_CASE("backlash is taken up where an axis turns round, and nowhere else", "[edges]") {
  constexpr std::string_view text = "G1 X10 F900\nG1 X4\nG4 P0.2\nG1 X2\nG4 P0.2\nG1 X7\nG1 X9\n";
  const auto without = plan_text(text, stepped(100, 1, 1), {.tolerance = 0});
  Machine<3> slack = stepped(100, 1, 1);
  slack.axes[0].motors[0].backlash = 0.05;
  const auto with = plan_text(text, slack, {.tolerance = 0});
  REQUIRE(without);
  REQUIRE(with);
  const auto plain = edges_of(*without)[0], taken = edges_of(*with)[0];
  CHECK(taken.size() == plain.size() + 2 * 5);
  // Runs of one direction, with how many steps each.
  const auto runs = [](const std::vector<Edge>& edges) {
    std::vector<int> result;
    for (std::size_t i = 0; i < edges.size(); ++i) {
      if (i == 0 || edges[i].direction != edges[i - 1].direction) result.push_back(0);
      result.back() += edges[i].direction;
    }
    return result;
  };
  CHECK(runs(plain) == std::vector<int>{1000, -800, 700});
  CHECK(runs(taken) == std::vector<int>{1000, -805, 705});
  int net = 0;
  auto source = with->step_edges();
  while (const auto edge = source.next()) net += edge->direction;
  CHECK(net == 900);
}

TEST_CASE("rotary axes and a machine of one axis step", "[edges]") {
  using V = VectorN<double, 1>;
  Machine<1> table{
      .axes = {{{.letter = 'A', .kind = AxisKind::rotary, .velocity = 2, .acceleration = 20, .jerk = 500}}}};
  table.axes[0].motors = {drive(636.6)};
  const std::vector<Block<1>> blocks{{.path = path::Line<1>(V(0), V(3), 3, 0)},
                                     {.path = path::Line<1>(V(3), V(-0.5), 3.5, 0), .pause = 0.5}};
  const auto planned = plan_blocks(blocks, table, {.tolerance = 0});
  REQUIRE(planned);
  auto edges = edges_of(*planned);
  check_motor(*planned, edges[0], 0, 636.6);
}
