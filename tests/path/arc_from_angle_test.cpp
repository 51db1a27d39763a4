// YO04 Table 1: an arc by its centre, its angle and its sense.
#include "cncplan/path/arc_from_angle.hpp"

#include "support/catch.hpp"
#include "support/path_laws.hpp"
#include "support/random.hpp"

using namespace cncplan;
using path::arc_from_angle;

namespace {
constexpr double pi = std::numbers::pi;
}

TEST_CASE("an arc by centre, angle and sense ends where complex numbers say", "[arc]") {
  test::Random random;
  double off = 0;
  test::PathLawErrors worst;
  for (int i = 0; i < 500; ++i) {
    const Plane plane = std::array{Plane::xy, Plane::zx, Plane::yz}[static_cast<std::size_t>(i % 3)];
    const auto [first, second, third] = axes(plane);
    const Turn turn = random.coin() ? Turn::clockwise : Turn::counterclockwise;
    Vector3 start, center;
    for (int k = 0; k < 3; ++k) start[k] = random.uniform(-50, 50), center[k] = random.uniform(-50, 50);
    const double angle = random.log_uniform(1e-3, 30), rise = i % 2 == 0 ? 0.0 : random.uniform(-9, 9);
    CAPTURE(test::seed(), i, angle);
    const auto arc = arc_from_angle(start, center, angle, turn, plane, rise);
    REQUIRE(arc);
    CHECK(arc->position(0.0) == start);
    for (const double share : {0.3, 0.7, 1.0}) {
      using Wide = long double;
      const Wide turned = (turn == Turn::clockwise ? -1.0L : 1.0L) * share * angle;
      const Wide x = Wide(start[first]) - center[first], y = Wide(start[second]) - center[second];
      const Vector3 there = arc->position(share * arc->parameter_end());
      off = std::max(off, static_cast<double>(std::abs(
                              there[first] - (center[first] + x * std::cos(turned) - y * std::sin(turned)))));
      off = std::max(
          off, static_cast<double>(
                   std::abs(there[second] - (center[second] + x * std::sin(turned) + y * std::cos(turned)))));
      off = std::max(off, std::abs(there[third] - (start[third] + share * rise)));
    }
    worst.worst_of(test::path_law_errors(*arc, 1.0));
  }
  CHECK(off < 1e-12);
  test::check_path_laws(worst, "arc from angle");
}

TEST_CASE("an arc by centre and angle: a quarter, and two turns", "[arc]") {
  const auto quarter =
      arc_from_angle<double>({10, 0, 0}, {0, 0, 0}, pi / 2, Turn::counterclockwise, Plane::xy);
  REQUIRE(quarter);
  CHECK((quarter->end() - Vector3(0, 10, 0)).norm() < 1e-14);
  CHECK(quarter->length() == Approx(5 * pi));
  const auto twice = arc_from_angle<double>({10, 0, 0}, {0, 0, 0}, 4 * pi, Turn::clockwise, Plane::xy, 3.0);
  REQUIRE(twice);
  CHECK((twice->end() - Vector3(10, 0, 3)).norm() < 1e-13);
  CHECK(twice->length() == Approx(std::hypot(40 * pi, 3)));
}

TEST_CASE("an arc by centre and angle: what is refused", "[arc]") {
  const auto make = [](const Vector3& start, const Vector3& center, double angle) {
    return arc_from_angle(start, center, angle, Turn::clockwise, Plane::xy);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(make({1, 0, 0}, {0, 0, 0}, 0.0).error() == Error{ErrorCode::not_positive, "angle", 0.0, 0.0});
  CHECK(make({1, 0, 0}, {0, 0, 0}, -1.0).error() == Error{ErrorCode::not_positive, "angle", -1.0, 0.0});
  CHECK(make({1, 0, 0}, {0, 0, 0}, nan).error().code == ErrorCode::not_finite);
  CHECK(make({1, 0, 0}, {0, 0, 0}, 1e9).error().code == ErrorCode::above_limit);
  CHECK(make({nan, 0, 0}, {0, 0, 0}, 1.0).error().field == "start");
  CHECK(make({1, 0, 0}, {0, nan, 0}, 1.0).error().field == "center");
  CHECK(make({1, 2, 0}, {1, 2, 9}, 1.0).error() == Error{ErrorCode::below_limit, "radius", 0.0, 0.00127});
}
