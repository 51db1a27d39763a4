#include "cncplan/trajectory.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/path/mapped.hpp"
#include "cncplan/path/measured.hpp"
#include "cncplan/plan_program.hpp"
#include "support/catch.hpp"
#include "support/curves.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

const Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};

path::Line<3> line(const Vector3& from, const Vector3& to) { return {from, to}; }

path::Arc quarter(const Vector3& start, double radius, double end_radius, double angle) {
  path::ArcGeometry<double> g{
      .start = start,
      .end = start + Vector3(end_radius * std::cos(angle) - radius, end_radius * std::sin(angle), 0),
      .center = start - Vector3(radius, 0, 0),
      .radial = {radius, 0, 0}};
  g.start_radius = radius;
  g.end_radius = end_radius;
  g.angle = angle;
  g.turn = Turn::counterclockwise;
  return path::Arc(g);
}

template <class T>
using Columns = Eigen::Matrix<double, T::MachineType::axis_count, Eigen::Dynamic>;

template <class T>
auto view(Columns<T>& columns) {
  return PointsN<double, T::MachineType::axis_count>(columns.data(), columns.rows(), columns.cols());
}

// Every way to ask a trajectory gives the same, on the grid of the contract.
template <class T>
void check_samples(const T& trajectory, double period) {
  const double end = trajectory.duration();
  std::vector<typename T::SetPoint> points;
  for (const auto& point : trajectory.samples(period)) points.push_back(point);
  REQUIRE(static_cast<std::int64_t>(points.size()) == trajectory.samples(period).size());
  REQUIRE(!points.empty());
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    REQUIRE(points[k].time == static_cast<double>(k) * period);
    REQUIRE(points[k].time < end);
  }
  REQUIRE(points.back().time == end);
  REQUIRE(static_cast<double>(points.size() - 1) * period >= end);

  Columns<T> columns(T::MachineType::axis_count, static_cast<Eigen::Index>(points.size()) + 3);
  columns.setConstant(-1e9);
  REQUIRE(trajectory.positions(period, 0, view<T>(columns)) == static_cast<Eigen::Index>(points.size()));
  // In no order: backwards, and from the middle outwards.
  for (std::size_t i = points.size(); i-- > 0;) {
    const auto at = trajectory.at(points[i].time);
    REQUIRE(at.position == points[i].position);
    REQUIRE(at.velocity == points[i].velocity);
    REQUIRE(at.acceleration == points[i].acceleration);
    REQUIRE(at.jerk == points[i].jerk);
    REQUIRE(at.block == points[i].block);
    REQUIRE(at.line == points[i].line);
    REQUIRE(at.tool == points[i].tool);
    REQUIRE(at.along == points[i].along);
    REQUIRE((columns.col(static_cast<Eigen::Index>(i)) - at.position).norm() < 1e-11);
  }
  REQUIRE(columns.col(static_cast<Eigen::Index>(points.size()))[0] == -1e9);
  // A part of them, from any sample on.
  const auto from = static_cast<std::int64_t>(points.size() / 3);
  Columns<T> part(T::MachineType::axis_count, 5);
  const auto count = trajectory.positions(period, from, view<T>(part));
  for (Eigen::Index i = 0; i < count; ++i)
    REQUIRE((part.col(i) - points[static_cast<std::size_t>(from + i)].position).norm() < 1e-11);
  CHECK(trajectory.at(-1.0).position == points.front().position);
  CHECK(trajectory.at(end + 1.0).position == points.back().position);
  CHECK(trajectory.at(end + 1.0).velocity.isZero());
}

// Largest disagreement of the derivatives with differences of the order below, inside phases, as a share.
template <class T>
double derivative_errors(const T& trajectory, test::Random& random) {
  double worst = 0;
  std::array<double, 4> size{1, 1e-3, 1e-3, 1e-3};
  for (const auto& p : trajectory.samples(trajectory.duration() / 500)) {
    size[0] = std::max(size[0], p.position.norm());
    size[1] = std::max(size[1], p.velocity.norm());
    size[2] = std::max(size[2], p.acceleration.norm());
    size[3] = std::max(size[3], p.jerk.norm());
  }
  for (const auto& [phase, block] : trajectory.phases()) {
    if (phase.duration < 1e-4) continue;
    const double h = std::min(1e-3, phase.duration / 8);
    const double t = phase.time + random.uniform(0.3, 0.7) * phase.duration;
    const auto here = trajectory.at(t);
    const auto a = trajectory.at(t - 2 * h), b = trajectory.at(t - h), c = trajectory.at(t + h),
               d = trajectory.at(t + 2 * h);
    const auto compare = [&](const auto& numeric, const auto& value, double below, double scale) {
      const double rounding = 4e-16 * below / h;
      worst = std::max(worst, ((numeric - value).norm() - 10 * rounding) / scale);
    };
    const auto five = [&](auto member) {
      return ((8 * (c.*member - b.*member) - (d.*member - a.*member)) / (12 * h)).eval();
    };
    using P = typename T::SetPoint;
    compare(five(&P::position), here.velocity, size[0], size[1]);
    compare(five(&P::velocity), here.acceleration, size[1], size[2]);
    compare(five(&P::acceleration), here.jerk, size[2], size[3]);
  }
  return worst;
}

// How far position jumps anywhere, and how far velocity and acceleration jump inside blocks.
struct Jumps {
  double position = 0, velocity = 0, acceleration = 0;
};
template <class T>
Jumps jumps(const T& trajectory) {
  Jumps worst;
  const auto phases = trajectory.phases();
  for (std::size_t i = 0; i + 1 < phases.size(); ++i) {
    const double edge = phases[i + 1].phase.time;
    const double h = 1e-9;
    const auto before = trajectory.at(edge - h), after = trajectory.at(edge + h);
    worst.position = std::max(worst.position, (after.position - before.position).norm() -
                                                  2 * h * (before.velocity.norm() + after.velocity.norm()));
    if (before.block != after.block) continue;
    worst.velocity =
        std::max(worst.velocity, (after.velocity - before.velocity).norm() -
                                     2 * h * (before.acceleration.norm() + after.acceleration.norm()));
    worst.acceleration = std::max(worst.acceleration, (after.acceleration - before.acceleration).norm() -
                                                          2 * h * (before.jerk.norm() + after.jerk.norm()));
  }
  return worst;
}

}  // namespace

TEST_CASE("no blocks are a trajectory of no time", "[trajectory]") {
  const auto none = plan_blocks(std::vector<Block<3>>{}, mill, {.tolerance = 0});
  REQUIRE(none);
  CHECK(none->duration() == 0);
  CHECK(none->length() == 0);
  CHECK(none->blocks().empty());
  CHECK(none->samples(0.001).size() == 1);
  check_samples(*none, 0.001);
  int edges = 0;
  for (const auto& edge : none->step_edges()) edges += edge.direction;
  CHECK(edges == 0);
}

TEST_CASE("no samples where the period is none, and why", "[trajectory]") {
  const std::vector<Block<3>> blocks{{.path = line({0, 0, 0}, {10, 0, 0})}};
  for (const auto& planned : {plan_blocks(blocks, mill, {.tolerance = 0}),
                              plan_blocks(std::vector<Block<3>>{}, mill, {.tolerance = 0})}) {
    REQUIRE(planned);
    for (const double period : {0.0, -0.0, -1.0, -1e-300, -std::numeric_limits<double>::infinity(),
                                std::numeric_limits<double>::infinity(), std::nan("")}) {
      INFO("period " << period);
      const auto samples = planned->samples(period);
      CHECK(samples.size() == 0);
      CHECK(samples.begin() == samples.end());
      int rows = 0;
      for (const auto& point : samples) rows += 1 + point.line;
      CHECK(rows == 0);
      REQUIRE(samples.error());
      CHECK(samples.error()->field == "period");
      CHECK(samples.error()->code ==
            (std::isfinite(period) ? ErrorCode::not_positive : ErrorCode::not_finite));
      Columns<std::remove_cvref_t<decltype(*planned)>> out(3, 4);
      CHECK(planned->positions(period, 0, PointsN<double, 3>(out.data(), 3, 4)) == 0);
    }
    CHECK_FALSE(planned->samples(1e-3).error());
    CHECK(planned->samples(1e300).size() == (planned->duration() > 0 ? 2 : 1));
  }
}

// Closed form: a line long enough to reach every limit takes L/v + v/a + a/j.
TEST_CASE("one line takes the time of its profile's closed form", "[trajectory]") {
  const std::vector<Block<3>> blocks{{.path = line({1, 2, 3}, {101, 2, 3}), .feed = 25, .line = 7}};
  const auto one = plan_blocks(blocks, Machine<3>{.limits = {30, 100, 1000}}, {.tolerance = 0});
  REQUIRE(one);
  CHECK(one->duration() == Approx(100.0 / 25 + 25.0 / 100 + 100.0 / 1000).epsilon(1e-13));
  CHECK(one->length() == 100);
  const auto motions = one->blocks();
  REQUIRE(motions.size() == 1);
  CHECK(motions[0].line == 7);
  CHECK(motions[0].peak == Approx(25).epsilon(1e-13));
  CHECK(motions[0].entry == 0);
  CHECK(motions[0].exit == Approx(0).margin(1e-9));
  CHECK(motions[0].duration == one->duration());
  CHECK(one->at(one->duration()).position == Vector3(101, 2, 3));
  check_samples(*one, 0.003);
}

TEST_CASE("pauses at the start, in the middle, in a row and at the end", "[trajectory]") {
  const auto stop = [](const Vector3& at, double pause, int number) {
    return Block<3>{.path = line(at, at), .pause = pause, .exact_stop = true, .line = number};
  };
  const std::vector<Block<3>> blocks{
      stop({0, 0, 0}, 0.25, 1),
      stop({0, 0, 0}, 0.5, 2),
      {.path = line({0, 0, 0}, {10, 0, 0}), .feed = 20, .line = 3},
      {.path = line({10, 0, 0}, {10, 10, 0}), .feed = 20, .pause = 0.125, .line = 4},
      stop({10, 10, 0}, 1, 5),
      stop({10, 10, 0}, 0, 6),
      stop({10, 10, 0}, 2, 7),
      {.path = line({10, 10, 0}, {20, 10, 0}), .feed = 20, .line = 8},
      stop({20, 10, 0}, 0.75, 9)};
  std::vector<Block<3>> moving{blocks[2], blocks[3], blocks[7]};
  moving[1].exact_stop = true;
  moving[1].pause = 0;
  const auto with = plan_blocks(blocks, mill, {.tolerance = 0}),
             without = plan_blocks(moving, mill, {.tolerance = 0});
  REQUIRE(with);
  REQUIRE(without);
  CHECK(with->duration() == Approx(without->duration() + 0.25 + 0.5 + 0.125 + 1 + 2 + 0.75).epsilon(1e-12));
  CHECK(with->length() == 30);
  CHECK(with->at(0.1).line == 1);
  CHECK(with->at(0.3).line == 2);
  CHECK(with->at(0.76).line == 3);
  const double corner = 0.75 + without->blocks()[0].duration + without->blocks()[1].duration;
  CHECK(with->at(corner + 0.1).line == 4);
  CHECK(with->at(corner + 0.1).position == Vector3(10, 10, 0));
  CHECK(with->at(corner + 0.13).line == 5);
  CHECK(with->at(corner + 1.2).line == 7);
  CHECK(with->at(corner + 3.2).line == 8);
  CHECK(with->at(with->duration() - 0.1).line == 9);
  for (const double t : {0.1, 0.6, corner + 0.05, corner + 2, with->duration() - 0.3}) {
    CHECK(with->at(t).velocity.isZero());
    CHECK(with->at(t).acceleration.isZero());
  }
  CHECK(with->at(with->duration() - 0.3).along.position == Approx(30));
  CHECK(with->blocks().size() == 3);
  check_samples(*with, 0.01);
  const auto edges = jumps(*with);
  CHECK(edges.position < 1e-12);
}

TEST_CASE("pauses alone are a trajectory", "[trajectory]") {
  const std::vector<Block<3>> blocks{{.path = line({1, 2, 3}, {1, 2, 3}), .pause = 0.5, .line = 1},
                                     {.path = line({1, 2, 3}, {1, 2, 3}), .pause = 0.25, .line = 2}};
  const auto rest = plan_blocks(blocks, mill, {.tolerance = 0});
  REQUIRE(rest);
  CHECK(rest->duration() == 0.75);
  CHECK(rest->at(0.6).line == 2);
  CHECK(rest->at(0.6).position == Vector3(1, 2, 3));
  check_samples(*rest, 0.1);
}

TEST_CASE("exact stops are at rest, and joints that are smooth are not", "[trajectory]") {
  std::vector<Block<3>> blocks{{.path = line({0, 0, 0}, {20, 0, 0}), .feed = 20},
                               {.path = line({20, 0, 0}, {40, 0, 0}), .feed = 20}};
  const auto through = plan_blocks(blocks, mill, {.tolerance = 0});
  blocks[0].exact_stop = true;
  const auto stops = plan_blocks(blocks, mill, {.tolerance = 0});
  REQUIRE(through);
  REQUIRE(stops);
  CHECK(through->blocks()[1].entry == Approx(20));
  CHECK(stops->blocks()[0].exit == Approx(0).margin(1e-9));
  CHECK(stops->blocks()[1].entry == Approx(0).margin(1e-9));
  CHECK(stops->at(stops->start_time(1)).velocity.norm() < 1e-6);
  CHECK(stops->duration() > through->duration());
}

// A mill's blocks of one kind of motion after another: the unit of length changes from mm to rad.
TEST_CASE("where the unit of length changes the motion stops", "[trajectory]") {
  using V = VectorN<double, 5>;
  Machine<5> machine{.limits = {.velocity = 30, .acceleration = 500, .jerk = 5000}};
  for (Axis& axis : machine.axes) axis.velocity = 50, axis.acceleration = 400, axis.jerk = 4000;
  machine.axes[3].letter = 'A', machine.axes[3].kind = AxisKind::rotary;
  machine.axes[4].letter = 'U', machine.axes[4].kind = AxisKind::linear;
  const V a(0, 0, 0, 0, 0), b(10, 0, 0, 0, 0), c(10, 0, 0, 1.5, 0), d(10, 0, 0, 3, 0), e(10, 0, 0, 3, 8),
      f(10, 0, 0, 4, 8), g(30, 0, 0, 4, 8);
  const auto block = [](const V& from, const V& to, double feed) {
    return Block<5>{.path = path::Line<5>(from, to), .feed = feed};
  };
  const std::vector<Block<5>> blocks{block(a, b, 20), block(b, c, 2), block(c, d, 2),
                                     block(d, e, 5),  block(e, f, 2), block(f, g, 20)};
  const auto planned = plan_blocks(blocks, machine, {.tolerance = 0});
  REQUIRE(planned);
  CHECK(planned->length() == Approx(10 + 8 + 20).epsilon(1e-14));
  const auto motions = planned->blocks();
  REQUIRE(motions.size() == 6);
  for (const std::size_t stopped : {std::size_t{0}, std::size_t{2}, std::size_t{3}, std::size_t{4}})
    CHECK(motions[stopped].exit == Approx(0).margin(1e-9));
  CHECK(motions[1].exit == Approx(2).epsilon(1e-9));  // A goes straight on
  check_samples(*planned, 0.002);
  CHECK(planned->at(planned->duration()).position == g);
}

TEST_CASE("a rotary axis that turns back slows down to what its limits allow", "[trajectory]") {
  using V = VectorN<double, 4>;
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double acceleration : {300.0, infinite}) {
    Machine<4> machine;
    machine.axes[3].velocity = 10;
    machine.axes[3].acceleration = acceleration;
    machine.axes[3].jerk = 4000;
    const std::vector<Block<4>> blocks{{.path = path::Line<4>(V(0, 0, 0, 0), V(0, 0, 0, 2))},
                                       {.path = path::Line<4>(V(0, 0, 0, 2), V(0, 0, 0, 0))}};
    const auto planned = plan_blocks(blocks, machine, {.tolerance = 0, .rotary_tolerance = 1e-3});
    REQUIRE(planned);
    const double speed = planned->blocks()[0].exit;
    // At a blend of half length l = 4 tolerance / 2: v^2 2 / (2 l) = A, or v^3 2 / l^2 = J.
    const double l = 2e-3;
    const double most = std::isfinite(acceleration) ? std::sqrt(l * 300) : std::cbrt(l * l * 4000 / 2);
    CHECK(speed == Approx(most).epsilon(1e-9));
  }
}

TEST_CASE("an axis beside the tool slows down where it alone changes its rate", "[trajectory]") {
  using V = VectorN<double, 4>;
  Machine<4> machine{.limits = mill.limits};
  machine.axes[3] = {.letter = 'U', .velocity = 100, .acceleration = 300, .jerk = 4000};
  const std::vector<Block<4>> blocks{{.path = path::Line<4>(V(0, 0, 0, 0), V(50, 0, 0, 0)), .feed = 30},
                                     {.path = path::Line<4>(V(50, 0, 0, 0), V(99, 0, 0, 49)), .feed = 30}};
  const auto planned = plan_blocks(blocks, machine, {.tolerance = 0, .junction_deviation = 0.02});
  REQUIRE(planned);
  // At a blend of half length l = 4 tolerance / d with d = 1: v^2 d / (2 l) = A.
  CHECK(planned->blocks()[0].exit == Approx(std::sqrt(2 * 0.08 * 300)).epsilon(1e-9));
}

TEST_CASE("blocks that do not meet are refused, with the axis", "[trajectory]") {
  std::vector<Block<3>> blocks{{.path = line({0, 0, 0}, {20, 0, 0}), .feed = 20},
                               {.path = line({20, 0.5, 0}, {40, 0, 0}), .feed = 20}};
  const auto jump = plan_blocks(blocks, mill, {.tolerance = 0});
  REQUIRE(!jump);
  CHECK(jump.error().block == 1);
  CHECK(jump.error().error().code == ErrorCode::discontinuous);
  CHECK(to_text(jump.error()).find("axis Y") != std::string::npos);
}

TEST_CASE("errors of blocks made by hand name the block", "[trajectory]") {
  Machine<3> small = mill;
  small.axes[1].high = 5;
  const std::vector<Block<3>> blocks{{.path = line({0, 0, 0}, {20, 0, 0}), .feed = 20},
                                     {.path = line({20, 0, 0}, {20, 6, 0}), .feed = 20}};
  const auto beyond = plan_blocks(blocks, small, {.tolerance = 0});
  REQUIRE(!beyond);
  CHECK(to_text(beyond.error()) == "block 1: error: axis Y: 6 is above the limit 5");
  auto slow = blocks;
  slow[0].feed = 0;
  REQUIRE(!plan_blocks(slow, mill, {.tolerance = 0}));
  CHECK(plan_blocks(slow, mill, {.tolerance = 0}).error().error().code == ErrorCode::not_positive);
  const Machine<3> unlimited;
  REQUIRE(!plan_blocks(blocks, unlimited, {.tolerance = 0}));
  CHECK(plan_blocks(blocks, unlimited, {.tolerance = 0}).error().error().code == ErrorCode::not_finite);
  Machine<3> wrong = mill;
  wrong.axes[2].jerk = -1;
  CHECK(plan_blocks(blocks, wrong, {.tolerance = 0}).error().error().code == ErrorCode::not_positive);
}

namespace {

// A block of several cells: a spiral that closes in, an ellipse, and a line through a machine's map.
template <class T>
void check_motion(const T& trajectory, double tolerance) {
  test::Random random;
  const auto edges = jumps(trajectory);
  CHECK(edges.position < 1e-9);
  CHECK(edges.velocity < 1e-6);
  CHECK(edges.acceleration < 1e-4);
  CHECK(derivative_errors(trajectory, random) < tolerance);
  check_samples(trajectory, trajectory.duration() / 700);
}

}  // namespace

TEST_CASE("blocks of several cells move without jumps", "[trajectory]") {
  const auto curve = path::measured(test::Ellipse{});
  REQUIRE(curve);
  using B = Block<3, path::Measured<test::Ellipse>>;
  const std::vector<B> blocks{{.path = line({0, 0, 0}, {20, 0, 0}), .feed = 30},
                              {.path = *curve, .feed = 30, .pause = 0.2},
                              {.path = quarter({60, 0, 0}, 30, 1, 7.5), .feed = 30}};
  const auto planned = plan_blocks(blocks, mill, {.tolerance = 0});
  REQUIRE(planned);
  std::array<std::size_t, 3> phases{};
  for (const auto& phase : planned->phases()) ++phases[phase.piece];
  CHECK(phases[2] >= 5);
  CHECK(planned->length() == Approx(20 + curve->length() + blocks[2].path.length()).epsilon(1e-13));
  check_motion(*planned, 1e-5);
}

TEST_CASE("a mapped machine's trajectory moves without jumps and tells the tool", "[trajectory]") {
  const MappedMachine<test::Scara> arm{
      .map = {},
      .axes = {{{.letter = 'J', .kind = AxisKind::rotary, .velocity = 2, .acceleration = 10, .jerk = 100},
                {.letter = 'K', .kind = AxisKind::rotary, .velocity = 3, .acceleration = 15, .jerk = 150},
                {.letter = 'Z', .velocity = 100, .acceleration = 500, .jerk = 5000}}},
      .limits = {.velocity = 150, .acceleration = 2000, .jerk = 40000}};
  const auto planned =
      plan_text("G4 P0.1\nG1 F6000 X260 Y-100\nG4 P0.2\nG3 X160 Y0 Z20 R100\nG0 X250 Y-180 Z0\nG4 P0.3\n",
                arm, {.tolerance = 0, .start = {250, -180, 0}});
  REQUIRE(planned);
  check_motion(*planned, 1e-4);
  double worst = 0;
  std::array<double, 3> velocity{}, acceleration{}, jerk{};
  double speed = 0;
  Vector3 before = planned->at(0).tool;
  for (const auto& p : planned->samples(0.001)) {
    worst = std::max(worst, (arm.map.tool(p.position) - p.tool).norm());
    speed = std::max(speed, (p.tool - before).norm() / 0.001);
    before = p.tool;
    for (std::size_t i = 0; i < 3; ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      velocity[i] = std::max(velocity[i], std::abs(p.velocity[k]) / arm.axes[i].velocity);
      acceleration[i] = std::max(acceleration[i], std::abs(p.acceleration[k]) / arm.axes[i].acceleration);
      jerk[i] = std::max(jerk[i], std::abs(p.jerk[k]) / arm.axes[i].jerk);
    }
  }
  CHECK(worst < 1e-9);
  CHECK(speed < 150.0001);
  for (std::size_t i = 0; i < 3; ++i) {
    CHECK(velocity[i] <= 1 + 1e-9);
    CHECK(acceleration[i] <= 1 + 1e-9);
    CHECK(jerk[i] <= 1 + 1e-9);
  }
  CHECK((planned->at(0.05).tool - Vector3(250, -180, 0)).norm() < 1e-12);
  CHECK((planned->at(planned->duration() - 0.1).tool - Vector3(250, -180, 0)).norm() < 1e-9);
}

namespace {

// Lines, arcs, spirals and helices, end to end, with pauses and stops; other axes along.
template <int N>
std::vector<Block<N>> random_blocks(test::Random& random) {
  std::vector<Block<N>> blocks;
  VectorN<double, N> here = VectorN<double, N>::Zero();
  const int count = random.integer(1, 14);
  for (int i = 0; i < count; ++i) {
    auto there = here;
    for (int axis = 0; axis < N; ++axis)
      if (random.integer(0, 2) > 0) there[axis] += random.uniform(-1, 1) * (axis < 3 ? 20.0 : 1.0);
    Block<N> block{.feed = random.log_uniform(1, 100), .line = i + 1};
    const int kind = random.integer(0, 4);
    if (kind == 0) {
      there = here;
      block.path = path::Line<N>(here, here);
      block.pause = random.coin() ? 0.1 : 0.0;
    } else if (kind < 3) {
      block.path = path::Line<N>(here, there);
    } else {
      const double radius = random.log_uniform(0.3, 30);
      const auto arc = quarter(here.template head<3>(), radius,
                               kind == 3 ? radius : radius * random.uniform(0.3, 2), random.uniform(0.2, 7));
      there.template head<3>() = arc.end();
      if constexpr (N == 3)
        block.path = arc;
      else
        block.path = path::BasicArcAlong<double, N>(arc, here, there);
    }
    block.exact_stop = random.integer(0, 5) == 0;
    block.rapid = random.integer(0, 5) == 0;
    if (random.integer(0, 6) == 0) block.pause = random.uniform(0.01, 0.2);
    blocks.push_back(block);
    here = there;
  }
  return blocks;
}

template <int N>
Machine<N> random_machine(test::Random& random) {
  Machine<N> machine;
  machine.limits = {random.log_uniform(5, 200), random.log_uniform(50, 5000), random.log_uniform(500, 1e5)};
  for (Axis& axis : machine.axes) {
    const double unit = axis.kind == AxisKind::rotary ? 0.05 : 1.0;
    axis.velocity = unit * random.log_uniform(5, 200);
    axis.acceleration = unit * random.log_uniform(50, 5000);
    axis.jerk = unit * random.log_uniform(500, 1e5);
    if (random.integer(0, 3) == 0) axis.velocity_down = axis.velocity * random.uniform(0.3, 1);
  }
  if (random.coin()) machine.rapid_rate = machine.limits.velocity * random.uniform(0.5, 2);
  if (random.coin()) machine.feed_limit = machine.limits.velocity * random.uniform(0.3, 1);
  return machine;
}

// By differences of positions alone, each in a phase: no field of the set points is believed.
template <int N>
void check_limits() {
  test::Random random;
  const int programs = 40;
  for (int program = 0; program < programs; ++program) {
    const auto blocks = random_blocks<N>(random);
    const auto machine = random_machine<N>(random);
    const auto planned = plan_blocks(blocks, machine, {.tolerance = 0});
    INFO("program " << program << ", axes " << N << ": "
                    << (planned ? std::string() : to_text(planned.error())));
    REQUIRE(planned);
    double velocity = 0, acceleration = 0, jerk = 0, tool_velocity = 0, tool_acceleration = 0, tool_jerk = 0;
    for (const auto& [phase, number] : planned->phases()) {
      if (phase.duration < 2e-3 || phase.velocity + phase.acceleration + std::abs(phase.jerk) == 0) continue;
      const double h = phase.duration / 12;
      for (const double part : {0.25, 0.5, 0.75}) {
        const double t = phase.time + part * phase.duration;
        const auto at = [&](int steps) { return planned->at(t + steps * h).position; };
        const auto v = ((8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * h)).eval();
        const auto a = ((16 * (at(1) + at(-1)) - (at(2) + at(-2)) - 30 * at(0)) / (12 * h * h)).eval();
        const auto j = ((at(2) - at(-2) - 2 * (at(1) - at(-1))) / (2 * h * h * h)).eval();
        for (int i = 0; i < N; ++i) {
          const Axis& axis = machine.axes[static_cast<std::size_t>(i)];
          const double down =
              axis.velocity_down > 0 ? std::min(axis.velocity_down, axis.velocity) : axis.velocity;
          velocity = std::max(velocity, std::abs(v[i]) / (v[i] < 0 ? down : axis.velocity));
          acceleration = std::max(acceleration, (std::abs(a[i]) - 1e-12 / h / h) / axis.acceleration);
          jerk = std::max(jerk, (std::abs(j[i]) - 1e-12 / h / h / h) / axis.jerk);
        }
        const auto& block = blocks[number];
        if (!(block.path.bounds(0, 0).tool.first > 0)) continue;
        const double most =
            block.rapid ? (machine.rapid_rate > 0 ? machine.rapid_rate : machine.limits.velocity)
                        : std::min({machine.limits.velocity, block.feed,
                                    machine.feed_limit > 0 ? machine.feed_limit : machine.limits.velocity});
        tool_velocity = std::max(tool_velocity, v.template head<3>().norm() / most);
        tool_acceleration = std::max(
            tool_acceleration, (a.template head<3>().norm() - 1e-12 / h / h) / machine.limits.acceleration);
        tool_jerk =
            std::max(tool_jerk, (j.template head<3>().norm() - 1e-12 / h / h / h) / machine.limits.jerk);
      }
    }
    // Differences over a part of a phase are near to derivatives, not equal.
    REQUIRE(velocity < 1 + 1e-3);
    REQUIRE(tool_velocity < 1 + 1e-3);
    REQUIRE(acceleration < 1 + 1e-2);
    REQUIRE(tool_acceleration < 1 + 1e-2);
    REQUIRE(jerk < 1 + 3e-2);
    REQUIRE(tool_jerk < 1 + 3e-2);
    // The set points' own fields to rounding.
    for (const auto& p : planned->samples(planned->duration() / 300))
      for (int i = 0; i < N; ++i) {
        const Axis& axis = machine.axes[static_cast<std::size_t>(i)];
        REQUIRE(std::abs(p.velocity[i]) <= axis.velocity * (1 + 1e-9));
        REQUIRE(std::abs(p.acceleration[i]) <= axis.acceleration * (1 + 1e-9));
        REQUIRE(std::abs(p.jerk[i]) <= axis.jerk * (1 + 1e-9));
      }
    const auto edges = jumps(*planned);
    REQUIRE(edges.position < 1e-9);
    REQUIRE(edges.velocity < 1e-6);
    REQUIRE(edges.acceleration < 1e-3);
    if (program % 4 == 0) {
      REQUIRE(derivative_errors(*planned, random) < 1e-3);
      check_samples(*planned, planned->duration() / 137.3);
    }
    REQUIRE((planned->at(planned->duration()).position - blocks.back().path.end()).norm() < 1e-12);
  }
}

}  // namespace

TEST_CASE("random programs of three axes keep the limits of tool and axes", "[trajectory]") {
  check_limits<3>();
}

TEST_CASE("random programs of five axes keep the limits of tool and axes", "[trajectory]") {
  check_limits<5>();
}

TEST_CASE("a machine of one axis moves", "[trajectory]") {
  using V = VectorN<double, 1>;
  const Machine<1> slide{.axes = {{{.letter = 'X', .velocity = 20, .acceleration = 200, .jerk = 2000}}}};
  const std::vector<Block<1>> blocks{{.path = path::Line<1>(V(0), V(10))},
                                     {.path = path::Line<1>(V(10), V(4)), .pause = 0.5}};
  const auto planned = plan_blocks(blocks, slide, {.tolerance = 0});
  REQUIRE(planned);
  CHECK(planned->length() == Approx(16));
  CHECK(planned->at(planned->duration()).position[0] == 4);
  check_samples(*planned, 0.01);
}
