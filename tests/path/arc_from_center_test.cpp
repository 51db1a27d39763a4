#include "cncplan/path/arc_from_center.hpp"

#include <limits>

#include "cncplan/published/plane_swap.hpp"
#include "support/catch.hpp"

using namespace cncplan;
using namespace cncplan::path;

namespace {

const double pi = std::numbers::pi;

Expected<Arc> clockwise(const Vector3& end, const Vector3& center) {
  return arc_from_center({0, 0, 0}, end, center, Turn::clockwise, Plane::xy);
}

}  // namespace

TEST_CASE("Start, end and centre give the arc in the sense asked for") {
  const auto right = arc_from_center({0, 0, 0}, {5, 5, 0}, {5, 0, 99}, Turn::clockwise, Plane::xy);
  const auto left = arc_from_center({0, 0, 0}, {5, 5, 0}, {5, 0, 99}, Turn::counterclockwise, Plane::xy);
  REQUIRE((right && left));
  CHECK(right->sweep() == Approx(-pi / 2).epsilon(1e-15));
  CHECK(left->sweep() == Approx(3 * pi / 2).epsilon(1e-15));
  CHECK(right->center() == Vector3(5, 0, 0));
  CHECK(right->is_circular());
  CHECK(left->start_angle() == Approx(pi).epsilon(1e-15));
}

TEST_CASE("End on the start is a full circle, in every plane, with a rise and extra turns") {
  for (const Plane plane : {Plane::xy, Plane::zx, Plane::yz, Plane::xz_printed})
    for (const int extra : {0, 1, 4}) {
      const Vector3 start = published::from_plane(Vector3(3, 4, 1), plane);
      const Vector3 end = published::from_plane(Vector3(3, 4, 11), plane);
      const auto arc = arc_from_center(start, end, Vector3(0, 0, 0), Turn::clockwise, plane, {}, extra);
      REQUIRE(arc);
      CHECK(arc->sweep() == Approx(-2 * pi * (extra + 1)).epsilon(1e-15));
      CHECK(arc->length() == Approx(std::hypot(10 * pi * (extra + 1), 10)).epsilon(1e-15));
      CHECK(arc->position(arc->parameter_end()) == end);
    }
}

TEST_CASE("A full circle needs no exact comparison: ends that rounding parted are one point") {
  for (const Turn turn : {Turn::clockwise, Turn::counterclockwise})
    for (const double off : {1e-13, -1e-13, 5e-10, -5e-10}) {
      const auto arc = arc_from_center({10, 0, 0}, {10, off, 0}, {0, 0, 0}, turn, Plane::xy);
      REQUIRE(arc);
      CHECK(std::abs(arc->sweep()) == Approx(2 * pi).epsilon(1e-9));
      CHECK(arc->position(arc->parameter_end()) == Vector3(10, off, 0));
    }
  // A real distance decides by its direction.
  CHECK(std::abs(arc_from_center({10, 0, 0}, {10, 1e-5, 0}, {0, 0, 0}, Turn::counterclockwise, Plane::xy)
                     ->sweep()) < 2e-6);
  CHECK(std::abs(arc_from_center({10, 0, 0}, {10, 1e-5, 0}, {0, 0, 0}, Turn::clockwise, Plane::xy)->sweep()) >
        6.28);
}

TEST_CASE("The sweep of a short arc keeps its digits") {
  for (const double length : {1e-3, 1e-5, 1e-7}) {
    const Vector3 start(60.1, 80.3, 0);
    const Vector3 end(start.x() - 0.8 * length, start.y() + 0.6 * length, 0);
    const auto arc = arc_from_center(start, end, {0, 0, 0}, Turn::counterclockwise, Plane::xy);
    REQUIRE(arc);
    using L = long double;
    const L cross = L(start.x()) * (L(end.y()) - start.y()) - L(start.y()) * (L(end.x()) - start.x());
    const L dot = L(start.x()) * end.x() + L(start.y()) * end.y();
    CHECK(std::abs(arc->sweep() / std::atan2(cross, dot) - 1) < 1e-15);
  }
}

TEST_CASE("Radii that differ within tolerance make a spiral about the programmed centre") {
  const auto arc = clockwise({10.02, 0, 0}, {5, 0, 0});
  REQUIRE(arc);
  CHECK_FALSE(arc->is_circular());
  CHECK(arc->start_radius() == 5);
  CHECK(arc->end_radius() == Approx(5.02).epsilon(1e-15));
  CHECK(arc->center() == Vector3(5, 0, 0));
  CHECK(arc->sweep() == -pi);
  const Vector3 middle = arc->position(arc->parameter_end() / 2) - arc->center();
  CHECK(middle.norm() == Approx(5.01).epsilon(1e-14));
  CHECK(arc->position(arc->parameter_end()) == Vector3(10.02, 0, 0));

  const auto rounding_only =
      arc_from_center({100.1, 0.3, 0}, {99.9, 0.5, 0}, {99.9, 0.3, 0}, Turn::counterclockwise, Plane::xy);
  REQUIRE(rounding_only);
  CHECK(rounding_only->is_circular());
}

TEST_CASE("Radii that differ too much, or vanish, are refused with their figures") {
  const auto refused = clockwise({10.03, 0, 0}, {5, 0, 0});
  REQUIRE_FALSE(refused);
  CHECK(refused.error().code == ErrorCode::radius_mismatch);
  CHECK(refused.error().field == "center");
  CHECK(refused.error().value == Approx(0.03).epsilon(1e-10));
  CHECK(refused.error().bound == Approx(0.0282842712474619));
  CHECK(clockwise({200.05, 0, 0}, {100, 0, 0}));
  CHECK(clockwise({200.2, 0, 0}, {100, 0, 0}).error().bound == Approx(0.1002));
  CHECK(clockwise({2e4 + 2.9, 0, 0}, {1e4, 0, 0}).error().bound == Approx(2.82842712474619));
  CHECK(clockwise({0, 0, 0}, {0, 0, 0}).error() == Error{ErrorCode::below_limit, "radius", 0.0, 0.00127});
  CHECK(clockwise({10, 0, 0}, {10, 0, 0}).error() == Error{ErrorCode::below_limit, "radius", 0.0, 0.00127});
  CHECK(clockwise({0.0026, 0, 0}, {0.0013, 0, 0}));
}

TEST_CASE("Numbers that are none are refused by name, the centre's third coordinate is not looked at") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(clockwise({nan, 0, 0}, {5, 0, 0}).error().field == "end");
  CHECK(clockwise({10, 0, 0}, {5, nan, 0}).error().field == "center");
  CHECK(clockwise({10, 0, 0}, {1e80, 0, 0}).error() == Error{ErrorCode::above_limit, "center", 1e80, 1e75});
  CHECK(clockwise({10, 0, 0}, {5, 0, nan}));
  CHECK(arc_from_center({0, 0, 0}, {10, 0, 0}, {5, 0, 0}, Turn::clockwise, Plane::xy, {}, -2).error() ==
        Error{ErrorCode::negative, "extra turns", -2.0, 0.0});
}

TEST_CASE("A million extra turns stay on the circle, more are refused") {
  const auto turned = [](int turns) {
    return arc_from_center({1, 0, 0}, {0, 1, 0}, {0, 0, 0}, Turn::counterclockwise, Plane::xy, {}, turns);
  };
  const auto arc = turned(1'000'000);
  REQUIRE(arc);
  double worst = 0;
  for (int i = 0; i <= 1000; ++i)
    worst = std::max(worst, std::abs(arc->position(arc->parameter_end() * i / 1000).norm() - 1));
  CHECK(worst < 1e-15);
  CHECK(turned(1'000'001).error() == Error{ErrorCode::above_limit, "extra turns", 1'000'001, 1'000'000});
  CHECK(turned(2'000'000'000).error().code == ErrorCode::above_limit);
}

TEST_CASE("float arcs land on their ends as well") {
  const BasicVector3<float> start(12.1f, 3.2f, 0.f);
  const BasicVector3<float> end(2.1f, 13.2f, 1.f);
  const auto arc =
      arc_from_center(start, end, BasicVector3<float>(2.1f, 3.2f, 0.f), Turn::counterclockwise, Plane::xy);
  REQUIRE(arc);
  CHECK(arc->is_circular());
  CHECK(arc->position(arc->parameter_end()) == end);
  CHECK(arc->sweep() == Approx(pi / 2).epsilon(1e-6));
}
