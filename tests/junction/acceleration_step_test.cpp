#include "cncplan/junction/acceleration_step.hpp"

#include <cmath>

#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/path/segment.hpp"
#include "junction/junctions.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

// The junction of a path that comes in with one curvature vector and leaves with another.
junction::Geometry bend(const Vector3& before, const Vector3& after) {
  auto junction = test::corner(0.0);
  junction.before.curvature = before;
  junction.after.curvature = after;
  return junction;
}

junction::Geometry bend(const path::Segment<3>& before, const path::Segment<3>& after) {
  return bend(before.point_at(before.length()).second, after.point_at(0.0).second);
}

path::Arc arc(const Vector3& start, const Vector3& end, const Vector3& center) {
  const auto made = path::arc_from_center(start, end, center, Turn::counterclockwise, Plane::xy);
  REQUIRE(made);
  return *made;
}

}  // namespace

TEST_CASE("the normal acceleration jumps by no more than the step") {
  const junction::AccelerationStep policy{500.0};
  // v^2/R from a line; v^2 (1/R1 - 1/R0) between arcs of one side; the sum across an inflection
  CHECK(policy.speed_sq(bend({0, 0, 0}, {0, 0.5, 0})) == 1000.0);
  CHECK(policy.speed_sq(bend({0, 0.5, 0}, {0, 0, 0})) == 1000.0);
  CHECK(policy.speed_sq(bend({0, 0.5, 0}, {0, 0.25, 0})) == 2000.0);
  CHECK(policy.speed_sq(bend({0, 0.5, 0}, {0, -0.5, 0})) == 500.0);
  CHECK(policy.speed_sq(bend({0, 0.5, 0}, {0, 0, 0.5})) == Approx(500.0 / std::sqrt(0.5)));
}

TEST_CASE("no jump, no limit") {
  CHECK(std::isinf(junction::AccelerationStep{500.0}.speed_sq(bend({0, 0, 0}, {0, 0, 0}))));
  CHECK(std::isinf(junction::AccelerationStep{0.0}.speed_sq(bend({0, 0.5, 0}, {0, 0.5, 0}))));
  CHECK(junction::AccelerationStep{0.0}.speed_sq(bend({0, 0, 0}, {0, 0.5, 0})) == 0.0);
}

TEST_CASE("one circle in two arcs, far from the origin, is not slowed") {
  const Vector3 center{417.3, -388.1, 12.0};
  const auto at = [&](double angle) -> Vector3 {
    return center + 0.5 * Vector3(std::cos(angle), std::sin(angle), 0.0);
  };
  const path::Arc first = arc(at(0.3), at(1.1), center), second = arc(at(1.1), at(2.9), center);
  CHECK(std::sqrt(junction::AccelerationStep{1.0}.speed_sq(bend(first, second))) > 1e4);
}

TEST_CASE("a line into an arc runs at the root of step times radius") {
  const auto junction = bend(path::Line<3>({-5, 0, 0}, {0, 0, 0}), arc({0, 0, 0}, {2, 2, 0}, {0, 2, 0}));
  CHECK(junction::AccelerationStep{50.0}.speed_sq(junction) == Approx(100.0).epsilon(1e-14));
}

TEST_CASE("acceleration step in float") {
  junction::BasicGeometry<float> junction;
  junction.after.curvature = {0.0f, 0.5f, 0.0f};
  CHECK(junction::BasicAccelerationStep<float>{500.0f}.speed_sq(junction) == 1000.0f);
}
