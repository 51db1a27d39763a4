#include "cncplan/core/plane.hpp"

#include "cncplan/core/vector.hpp"
#include "support/catch.hpp"

#include <Eigen/Geometry>

using namespace cncplan;

TEST_CASE("the ISO planes are right-handed, the printed G18 is not") {
  const auto handedness = [](Plane plane) {
    const auto [first, second, third] = axes(plane);
    return Vector3::Unit(first).cross(Vector3::Unit(second)).dot(Vector3::Unit(third));
  };
  CHECK(handedness(Plane::xy) == 1.0);
  CHECK(handedness(Plane::zx) == 1.0);
  CHECK(handedness(Plane::yz) == 1.0);
  CHECK(handedness(Plane::xz_printed) == -1.0);
}
