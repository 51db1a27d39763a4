#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "cncplan/detail/speed/cells.hpp"
#include "cncplan/junction/deviation.hpp"
#include "cncplan/junction/exact_stop.hpp"
#include "cncplan/kinematics/polar.hpp"
#include "cncplan/kinematics/table_table.hpp"
#include "cncplan/path/arc_from_center.hpp"
#include "path/random_arcs.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

const Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};

junction::Side side(const path::Segment<3>& segment, detail::PathEnd junction) {
  const Block<3> block{.path = segment};
  return detail::tool_side(block.path, junction::Kind::line, detail::PathEnds(block.path), junction,
                           tool_axes(mill));
}

// The cells of blocks whose joints a policy alone judges.
template <class Policy>
std::vector<detail::SegmentLimits> segments(const std::vector<Block<3>>& blocks, const Policy& policy) {
  const auto cells = detail::make_cells(std::span(blocks), mill, detail::JunctionRules{policy, -1, -1});
  REQUIRE(cells);
  return {cells->segment_limits.begin(), cells->segment_limits.end()};
}

// Gives the joint's limits back, to see what policies are shown.
struct Shown {
  double Limits::*member;
  double speed_sq(const junction::Geometry& junction) const {
    return junction.limits.*member * (junction.limits.*member);
  }
};

const Block<3> first{.path = path::Line<3>({0, 0, 0}, {10, 0, 0}), .feed = 20};
const Block<3> second{.path = path::Line<3>({10, 0, 0}, {10, 5, 0}), .feed = 25};

}  // namespace

TEST_CASE("tangents and curvature vectors at both ends are those of differences over arc length") {
  test::Random random;
  double tangent = 0.0, curvature = 0.0;
  std::string where;
  for (int draws = 0; draws < 3000; ++draws) {
    const auto arc = test::random_arc<double>(random, test::arc_kinds[random.integer(0, 5)]);
    for (const bool at_end : {false, true}) {
      const auto here = side(arc, at_end ? detail::PathEnd::end : detail::PathEnd::start);
      // of the unit tangent over arc length, one-sided, four points
      const double u0 = at_end ? arc.parameter_end() : 0.0;
      const double h = (at_end ? -1.0 : 1.0) * 1e-3 * std::min(1.0, arc.parameter_end());
      const auto unit = [&](double u) -> Vector3 { return arc.derivative(u).normalized(); };
      const auto slope = [&](const auto& f) -> Vector3 {
        return (-11.0 * f(u0) + 18.0 * f(u0 + h) - 9.0 * f(u0 + 2 * h) + 2.0 * f(u0 + 3 * h)) / (6.0 * h);
      };
      const Vector3 expected = slope(unit) / arc.derivative(u0).norm();
      const double off = (here.curvature - expected).norm() / expected.norm();
      if (off > curvature) curvature = off, where = test::describe(arc);
      const auto place = [&](double u) -> Vector3 { return arc.position(u); };
      tangent = std::max(tangent, (here.tangent - slope(place).normalized()).norm());
      REQUIRE(here.turn == arc.turn());
      REQUIRE(here.plane == arc.plane());
      REQUIRE(here.kind == junction::Kind::arc);
      REQUIRE_FALSE(here.closed);
      REQUIRE(here.chord == arc.chord());
      REQUIRE(std::abs(here.curvature.norm() / arc.curvature(u0) - 1.0) < 1e-9);
    }
  }
  INFO(where);
  CHECK(tangent < 1e-8);
  CHECK(curvature < 1e-6);
}

TEST_CASE("a line shows its direction and no curvature") {
  const auto end = side(path::Line<3>({1, 2, 3}, {1, 2, 8}), detail::PathEnd::end);
  CHECK(end.kind == junction::Kind::line);
  CHECK(end.tangent == Vector3(0, 0, 1));
  CHECK(end.chord == Vector3(0, 0, 5));
  CHECK(end.curvature == Vector3::Zero());
}

TEST_CASE("a full circle is closed, a turn of a helix too") {
  for (const double rise : {0.0, 4.0}) {
    path::ArcGeometry<double> g{
        .start = {5, 0, 0}, .end = {5, 0, rise}, .center = {0, 0, 0}, .radial = {5, 0, 0}};
    g.start_radius = g.end_radius = 5.0;
    g.angle = 2.0 * std::numbers::pi;
    g.turn = Turn::counterclockwise;
    CHECK(side(path::Arc(g), detail::PathEnd::start).closed);
  }
}

TEST_CASE("a policy's speed that is negative or not a number is a stop") {
  struct Fixed {
    double value;
    double speed_sq(const junction::Geometry&) const { return value; }
  };
  for (const double value : {-1.0, std::numeric_limits<double>::quiet_NaN(), 0.0})
    CHECK(segments({first, second}, Fixed{value})[1].entry == 0.0);
  CHECK(segments({first, second}, Fixed{9.0})[1].entry == 3.0);
}

TEST_CASE("a joint is judged under the machine's limits and the lower feed") {
  CHECK(segments({first, second}, Shown{&Limits::velocity})[1].entry == 20.0);
  CHECK(segments({first, second}, Shown{&Limits::acceleration})[1].entry == 1000.0);
  CHECK(segments({first, second}, Shown{&Limits::jerk})[1].entry == 10000.0);
  const double half = std::sqrt(0.5);
  CHECK(segments({first, second}, junction::Deviation{0.01})[1].entry ==
        Approx(std::sqrt(10.0 * half / (1.0 - half))).epsilon(1e-14));
}

TEST_CASE("a cell has its length, its limits and its pause") {
  Block<3> paused = second;
  paused.pause = 0.5;
  const auto straight = segments({first, paused}, junction::Deviation{0.01});
  REQUIRE(straight.size() == 2);
  CHECK(straight[1].length == 5.0);
  CHECK(straight[1].limits == Limits{25, 1000, 10000});
  CHECK(straight[1].pause == 0.5);
  const auto arc = path::arc_from_center(Vector3(10, 0, 0), Vector3(11, 1, 0), Vector3(10, 1, 0),
                                         Turn::counterclockwise, Plane::xy);
  REQUIRE(arc);
  const auto curved = segments({first, Block<3>{.path = *arc}}, junction::Deviation{0.01});
  REQUIRE(curved.size() == 2);
  CHECK(curved[1].length == Approx(std::numbers::pi / 2).epsilon(1e-15));
  CHECK(curved[1].limits.velocity <= std::cbrt(10000.0));  // v^3/R^2 within the jerk limit
  CHECK(curved[1].limits.jerk < 10000.0);
  CHECK(std::isinf(curved[1].entry));  // the line runs into it tangentially
}

TEST_CASE("behind a stop, a pause, and at the start, motion begins at rest") {
  const Shown fast{&Limits::velocity};
  Block<3> stopped = first;
  stopped.exact_stop = true;
  Block<3> paused = first;
  paused.pause = 0.1;
  CHECK(segments({stopped, second}, fast)[1].entry == 0.0);
  CHECK(segments({paused, second}, fast)[1].entry == 0.0);
  CHECK(segments({first, second}, junction::ExactStop{})[1].entry == 0.0);
  CHECK(segments({first}, fast)[0].entry == 0.0);
}

TEST_CASE("where the tool goes straight on and turns, its axes are held to a corner of their own") {
  MappedMachine<kinematics::TableTableBC> tables;
  for (auto& axis : tables.axes) axis.acceleration = 500;
  auto& table = tables.axes[4];
  table.kind = AxisKind::rotary;
  table.acceleration = 20;
  detail::BasicBlockJunction<double, 5> junction;
  junction.tool.before.tangent = junction.tool.after.tangent = Vector3(1, 0, 0);
  junction.before << 1, 0, 0, 0, 0.01;
  junction.after << 1, 0, 0, 0, 0.13;
  // A blend of half length l turns the axis by l 0.12 / 4 = 1e-3 rad at most, and v^2 0.12 / (2 l) = 20.
  CHECK(detail::axis_corner_speed(junction, tables, 0.01, 1e-3) ==
        Approx(std::sqrt(2 * (4 * 1e-3 / 0.12) * 20 / 0.12)));
  // Without angles among the coordinates the joints turn as the tool does.
  MappedMachine<kinematics::PolarMap> polar;
  for (auto& axis : polar.axes) axis.acceleration = 500;
  polar.axes[2].kind = AxisKind::rotary;
  detail::BasicBlockJunction<double, 3> rounded;
  rounded.tool.before.tangent = rounded.tool.after.tangent = Vector3(1, 0, 0);
  rounded.before << 1, 0, 0.01;
  rounded.after << 1, 0, 0.01 + 1e-12;
  CHECK(detail::axis_corner_speed(rounded, polar, 0.01, 1e-3) == std::numeric_limits<double>::infinity());
}
