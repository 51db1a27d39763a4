#include "cncplan/path/b_spline_through.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include "cncplan/path/b_spline.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

using PointList = std::vector<Vector3>;

std::vector<Vector3> through(const PointList& points, const path::BasicSplineEnds<double>& ends = {}) {
  return path::b_spline_through(std::span<const Vector3>(points), ends).value();
}

}  // namespace

TEST_CASE("A B-spline through points is at each of them, and keeps its end conditions") {
  test::Random random;
  double off = 0, bent = 0, turned = 0;
  for (int i = 0; i < test::cases(1000); ++i) {
    PointList points;
    const int count = 2 + i % 40;
    const auto vector = [&] {
      return Vector3(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9));
    };
    for (int k = 0; k < count; ++k) points.push_back(vector());
    path::BasicSplineEnds<double> ends;
    if (i % 2 == 0) ends.start = vector();
    if (i % 3 == 0) ends.end = vector();
    const auto controls = through(points, ends);
    REQUIRE(controls.size() == points.size() + 2);
    const path::BSpline<3> spline(controls);
    for (std::size_t k = 0; k < points.size(); ++k)
      off = std::max(off, (spline.position(static_cast<double>(k)) - points[k]).norm());
    const double last = spline.parameter_end();
    turned = std::max(turned, ends.start ? (spline.derivative(0) - *ends.start).norm() : 0.0);
    turned = std::max(turned, ends.end ? (spline.derivative(last) - *ends.end).norm() : 0.0);
    bent = std::max(bent, ends.start ? 0.0 : spline.second_derivative(0).norm());
    bent = std::max(bent, ends.end ? 0.0 : spline.second_derivative(last).norm());
  }
  CHECK(off < 1e-13);
  CHECK(turned < 1e-12);
  CHECK(bent < 1e-12);
}

TEST_CASE("A B-spline through points of a cubic is that cubic") {
  const auto position = [](double u) { return Vector3(u, 2 - u * u, 0.1 * u * u * u - u); };
  const auto derivative = [](double u) { return Vector3(1, -2 * u, 0.3 * u * u - 1); };
  PointList points;
  for (int i = 0; i <= 6; ++i) points.push_back(position(i));
  const auto controls = through(points, {derivative(0), derivative(6)});
  const path::BSpline<3> spline(controls);
  double worst = 0;
  for (int i = 0; i <= 600; ++i)
    worst = std::max(worst, (spline.position(i * 0.01) - position(i * 0.01)).norm());
  CHECK(worst < 1e-13 * 40);
}

// The error of a cubic spline through points of a circle, whose ends have the circle's tangents, is R d^4/384
// for points every d; KK22 Fig. 8 has R 5.
TEST_CASE("A B-spline through points of a circle leaves it by the fourth power of their distance") {
  constexpr double radius = 5, pi = std::numbers::pi;
  for (const double degrees : {5.0, 15.0, 30.0}) {
    const double d = degrees * pi / 180;
    PointList points;
    for (int i = 0; i * degrees <= 180.0; ++i)
      points.emplace_back(-radius * std::cos(i * d), radius * std::sin(i * d), 0);
    const auto controls = through(points, {Vector3(0, radius * d, 0), Vector3(0, -radius * d, 0)});
    const path::BSpline<3> spline(controls);
    double worst = 0;
    for (int i = 0; i <= 6000; ++i)
      worst = std::max(worst, std::abs(spline.position(spline.parameter_end() * i / 6000).norm() - radius));
    CHECK(worst == Approx(radius * d * d * d * d / 384).epsilon(0.12));  // and higher powers
  }
}

TEST_CASE("A B-spline through one point is refused, and any scalar will do") {
  const PointList one{{1, 2, 3}};
  CHECK(path::b_spline_through(std::span<const Vector3>(one)).error() ==
        Error{ErrorCode::below_limit, "number of points", 1, 2});
  const std::vector<BasicVector3<float>> two{{0, 0, 0}, {3, 0, 0}};
  const auto controls = path::b_spline_through(std::span<const BasicVector3<float>>(two)).value();
  CHECK(path::BasicBSpline<float, 3>(controls).position(0.5F).x() == 1.5F);
}
