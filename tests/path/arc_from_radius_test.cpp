#include "cncplan/path/arc_from_radius.hpp"

#include <limits>

#include "cncplan/published/plane_swap.hpp"
#include "support/catch.hpp"

using namespace cncplan;
using namespace cncplan::path;

namespace {

const double pi = std::numbers::pi;

Expected<Arc> clockwise(const Vector3& start, const Vector3& end, double radius) {
  return arc_from_radius(start, end, radius, Turn::clockwise, Plane::xy);
}

}  // namespace

TEST_CASE("The first example of the design: a quarter circle") {
  const auto arc = arc_from_radius({0, 0, 0}, {5, 5, 0}, 5.0, Turn::clockwise, Plane::xy);
  REQUIRE(arc);
  CHECK((arc->center() - Vector3(5, 0, 0)).norm() < 1e-15);
  CHECK(arc->sweep() == Approx(-pi / 2).epsilon(1e-15));
  CHECK(arc->length() == Approx(2.5 * pi).epsilon(1e-15));
  CHECK(arc->radius_adjustment() == 0);
}

TEST_CASE("Sense and sign of the radius pick one of four arcs") {
  const auto arc = [](double radius, Turn turn) {
    return arc_from_radius({0, 0, 0}, {6, 0, 0}, radius, turn, Plane::xy).value();
  };
  const double h = 4;
  const double small = 2 * std::atan2(3, h);
  CHECK(arc(5.0, Turn::clockwise).center().y() == -h);
  CHECK(arc(5.0, Turn::counterclockwise).center().y() == h);
  CHECK(arc(-5.0, Turn::clockwise).center().y() == h);
  CHECK(arc(-5.0, Turn::counterclockwise).center().y() == -h);
  CHECK(arc(5.0, Turn::clockwise).sweep() == Approx(-small).epsilon(1e-15));
  CHECK(arc(-5.0, Turn::counterclockwise).sweep() == Approx(2 * pi - small).epsilon(1e-15));
}

TEST_CASE("Each plane turns as seen from its positive third axis") {
  // A quarter turn counter-clockwise leads from the first towards the second axis.
  for (const Plane plane : {Plane::xy, Plane::zx, Plane::yz, Plane::xz_printed}) {
    const Vector3 first = published::from_plane(Vector3(5, 0, 1), plane);
    const Vector3 second = published::from_plane(Vector3(0, 5, 3), plane);
    const auto arc = arc_from_radius(first, second, 5.0, Turn::counterclockwise, plane);
    REQUIRE(arc);
    CHECK((published::to_plane(arc->center(), plane) - Vector3(0, 0, 1)).norm() < 1e-15);
    CHECK(arc->rise() == 2);
    CHECK(arc->sweep() == Approx(pi / 2).epsilon(1e-15));
    CHECK(arc->length() == Approx(std::hypot(2.5 * pi, 2)).epsilon(1e-15));
    CHECK(arc->start_tangent().dot(published::from_plane(Vector3(0, 1, 0), plane)) > 0.9);
  }
}

TEST_CASE("The printed G18 of KK22 is the mirror image of the ISO one") {
  const auto iso = arc_from_radius({0, 0, 0}, {5, 0, 5}, 5.0, Turn::clockwise, Plane::zx);
  const auto printed = arc_from_radius({0, 0, 0}, {5, 0, 5}, 5.0, Turn::counterclockwise, Plane::xz_printed);
  REQUIRE((iso && printed));
  CHECK((iso->center() - printed->center()).norm() < 1e-15);
  CHECK(iso->sweep() == -printed->sweep());
}

TEST_CASE("A semicircle of rounded coordinates is one: grbl #1803") {
  const Vector3 start(-110.85, -2163, 0);
  const Vector3 end(-109.15, -2163, 0);
  const auto arc = clockwise(start, end, 0.85);
  REQUIRE(arc);
  CHECK(arc->center() == (start + end) / 2);
  CHECK(arc->sweep() == -pi);
  CHECK(arc->position(arc->parameter_end()) == end);
  CHECK(std::abs(arc->radius_adjustment()) < 1e-12);
  CHECK(clockwise(start, end, -0.85)->sweep() == -pi);
  const auto single =
      arc_from_radius(start.cast<float>(), end.cast<float>(), 0.85f, Turn::clockwise, Plane::xy);
  REQUIRE(single);
  CHECK(single->position(single->parameter_end()) == end.cast<float>());
}

TEST_CASE("A radius too short within tolerance is adjusted, and the adjustment is in the result") {
  const auto arc = clockwise({0, 0, 0}, {10, 0, 0}, 4.99874);
  REQUIRE(arc);
  CHECK(arc->start_radius() == 5);
  CHECK(arc->radius_adjustment() == Approx(0.00126).epsilon(1e-9));
  CHECK(arc->center() == Vector3(5, 0, 0));

  const auto refused = clockwise({0, 0, 0}, {10, 0, 0}, 4.99872);
  REQUIRE_FALSE(refused);
  CHECK(refused.error() == Error{ErrorCode::chord_exceeds_diameter, "radius", 4.99872, 5.0});
  CHECK(clockwise({0, 0, 0}, {10, 0, 0}, -4.99).error() ==
        Error{ErrorCode::chord_exceeds_diameter, "radius", -4.99, 5.0});

  ArcTolerance<double> strict;
  strict.short_radius = 0;
  CHECK_FALSE(arc_from_radius({0, 0, 0}, {10, 0, 0}, 4.99999, Turn::clockwise, Plane::xy, strict));
}

TEST_CASE("R0 is no arc, however short the chord: it fails by the tolerance relative to R") {
  for (const double chord : {1e-6, 0.001, 0.0025, 10.0}) {
    const auto refused = clockwise({0, 0, 0}, {chord, 0, 0}, 0.0);
    REQUIRE_FALSE(refused);
    CHECK(refused.error() == Error{ErrorCode::chord_exceeds_diameter, "radius", 0.0, chord / 2});
  }
}

TEST_CASE("Coincident ends are an error in R form, a micrometre's thousandth apart they are not") {
  const auto refused = clockwise({0, 0, 0}, {0, 0, 5}, 5.0);
  REQUIRE_FALSE(refused);
  CHECK(refused.error() == Error{ErrorCode::coincident_points, "end", 0.0, 1e-9});
  CHECK(clockwise({0, 0, 0}, {1e-10, 0, 0}, 5.0).error() ==
        Error{ErrorCode::coincident_points, "end", 1e-10, 1e-9});
  CHECK(clockwise({0, 0, 0}, {1e-6, 0, 0}, 5.0));
}

TEST_CASE("Numbers that are none, or too large, are refused by name") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  CHECK(clockwise({0, nan, 0}, {1, 0, 0}, 5.0).error().field == "start");
  CHECK(clockwise({0, 0, 0}, {1, 0, inf}, 5.0).error() == Error{ErrorCode::not_finite, "end", inf, 1e75});
  CHECK(clockwise({0, 0, 0}, {1, 0, 0}, nan).error().code == ErrorCode::not_finite);
  CHECK(clockwise({0, 0, 0}, {1, 0, 0}, 1e80).error() == Error{ErrorCode::above_limit, "radius", 1e80, 1e75});
  CHECK(arc_from_radius({0, 0, 0}, {1, 0, 0}, 5.0, Turn::clockwise, Plane::xy, {}, -1).error() ==
        Error{ErrorCode::negative, "extra turns", -1.0, 0.0});
  const auto turned = [](int turns) {
    return arc_from_radius({0, 0, 0}, {1, 0, 0}, 5.0, Turn::clockwise, Plane::xy, {}, turns);
  };
  CHECK(turned(1'000'000));
  CHECK(turned(2'000'000'000).error() == Error{ErrorCode::above_limit, "extra turns", 2e9, 1e6});
}

TEST_CASE("Extra turns add to the sweep: P2 on a half circle is 540 degrees") {
  const auto arc = arc_from_radius({0, 0, 0}, {10, 0, 2}, 5.0, Turn::counterclockwise, Plane::xy, {}, 1);
  REQUIRE(arc);
  CHECK(arc->sweep() == Approx(3 * pi).epsilon(1e-15));
  CHECK(arc->position(arc->parameter_end()) == Vector3(10, 0, 2));
}

TEST_CASE("A radius of 1e12 mm bends ten millimetres by 12.5 picometres, and ends on them") {
  const auto arc = clockwise({0, 0, 0}, {10, 0, 0}, 1e12);
  REQUIRE(arc);
  CHECK(arc->length() == Approx(10).epsilon(1e-15));
  CHECK(arc->position(arc->parameter_end() / 2).y() == Approx(1.25e-11).epsilon(1e-12));
  CHECK((arc->position(std::nextafter(arc->parameter_end(), 0.0)) - arc->end()).norm() < 1e-14);
}

TEST_CASE("Next to a semicircle whose chord is exact, the centre keeps all its digits") {
  // sqrt(R^2 - d^2/4) would lose them in R^2; a chord of 6 mm is exact, and so is R - 3.
  for (const double gap : {1e-3, 1e-5, 1e-7, 1e-9, 1e-11}) {
    const double radius = 3 * (1 + gap);
    const auto arc = clockwise({0, 0, 0}, {6, 0, 0}, radius);
    REQUIRE(arc);
    const long double h = std::sqrt((radius - 3.0L) * (radius + 3.0L));
    CHECK(std::abs(-arc->center().y() / h - 1) < 4e-16L);
  }
}
