#include "cncplan/plan/block.hpp"

#include <cmath>

#include "path/random_arcs.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

plan::Block block(const path::Segment<3>& segment) {
  return {segment, {30, 1000, 10000}, segment.arc() != nullptr ? junction::Kind::arc : junction::Kind::line};
}

}  // namespace

TEST_CASE("tangents and curvature vectors at both ends are those of differences over arc length") {
  test::Random random;
  double tangent = 0.0, curvature = 0.0;
  std::string where;
  for (int draws = 0; draws < 3000; ++draws) {
    const auto arc = test::random_arc<double>(random, test::arc_kinds[random.integer(0, 5)]);
    for (const bool at_end : {false, true}) {
      const auto side = plan::side(block(arc), at_end);
      // of the unit tangent over arc length, one-sided, four points
      const double u0 = at_end ? arc.parameter_end() : 0.0;
      const double h = (at_end ? -1.0 : 1.0) * 1e-3 * std::min(1.0, arc.parameter_end());
      const auto unit = [&](double u) -> Vector3 { return arc.derivative(u).normalized(); };
      const auto slope = [&](const auto& f) -> Vector3 {
        return (-11.0 * f(u0) + 18.0 * f(u0 + h) - 9.0 * f(u0 + 2 * h) + 2.0 * f(u0 + 3 * h)) / (6.0 * h);
      };
      const Vector3 expected = slope(unit) / arc.derivative(u0).norm();
      const double off = (side.curvature - expected).norm() / expected.norm();
      if (off > curvature) curvature = off, where = test::describe(arc);
      const auto place = [&](double u) -> Vector3 { return arc.position(u); };
      tangent = std::max(tangent, (side.tangent - slope(place).normalized()).norm());
      REQUIRE(side.turn == arc.turn());
      REQUIRE(side.plane == arc.plane());
      REQUIRE(side.kind == junction::Kind::arc);
      REQUIRE_FALSE(side.closed);
      REQUIRE(side.chord == arc.chord());
      REQUIRE(std::abs(side.curvature.norm() / arc.curvature(u0) - 1.0) < 1e-9);
    }
  }
  INFO(where);
  CHECK(tangent < 1e-8);
  CHECK(curvature < 1e-6);
}

TEST_CASE("a line shows its direction and no curvature") {
  const auto side = plan::side(block(path::Line<3>({1, 2, 3}, {1, 2, 8})), true);
  CHECK(side.kind == junction::Kind::line);
  CHECK(side.tangent == Vector3(0, 0, 1));
  CHECK(side.chord == Vector3(0, 0, 5));
  CHECK(side.curvature == Vector3::Zero());
}

TEST_CASE("a full circle is closed, a turn of a helix too") {
  for (const double rise : {0.0, 4.0}) {
    path::ArcGeometry<double> g{
        .start = {5, 0, 0}, .end = {5, 0, rise}, .center = {0, 0, 0}, .radial = {5, 0, 0}};
    g.start_radius = g.end_radius = 5.0;
    g.angle = 2.0 * std::numbers::pi;
    g.turn = Turn::counterclockwise;
    CHECK(plan::side(block(path::Arc(g)), false).closed);
  }
}
