#include "cncplan/published/plane_swap.hpp"

#include "support/catch.hpp"

using namespace cncplan;
using namespace cncplan::published;

TEST_CASE("Planes swap as KK22 Table 2 says, G18 the ISO way round, and swap back") {
  const Vector3 p(1, 2, 3);
  CHECK(to_plane(p, Plane::xy) == Vector3(1, 2, 3));
  CHECK(to_plane(p, Plane::zx) == Vector3(3, 1, 2));
  CHECK(to_plane(p, Plane::yz) == Vector3(2, 3, 1));
  CHECK(to_plane(p, Plane::xz_printed) == Vector3(1, 3, 2));
  for (const Plane plane : {Plane::xy, Plane::zx, Plane::yz, Plane::xz_printed}) {
    CHECK(from_plane(to_plane(p, plane), plane) == p);
    CHECK(to_plane(from_plane(p, plane), plane) == p);
    const BasicVector3<float> f(1.5f, 2.5f, 3.5f);
    CHECK(from_plane(to_plane(f, plane), plane) == f);
  }
}
