// K17 Fig. 3.16 d and e: seven points are two cubic curves, with a corner at P3 or without one.
#include "cncplan/path/joined_bezier.hpp"

#include "cncplan/core/concepts.hpp"
#include "cncplan/path/arc_length_table.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using path::JoinedBezier;

static_assert(ParametricPath<JoinedBezier<2>>);
static_assert(!CurveByLength<JoinedBezier<2>> && CurveByLength<path::ArcLengthTable<JoinedBezier<2>, 2>>);

namespace {

using Controls = JoinedBezier<2>::Controls;

const Controls with_corner{Vector3(0, 0, 0),  Vector3(2, 6, 0),  Vector3(6, 8, 0), Vector3(10, 4, 0),
                           Vector3(14, 9, 0), Vector3(18, 7, 0), Vector3(20, 0, 0)};

Vector3 bernstein(const Controls& p, double u) {
  const std::size_t first = u < 1 ? 0 : 3;
  const double t = u < 1 ? u : u - 1, v = 1 - t;
  return v * v * v * p[first] + 3 * v * v * t * p[first + 1] + 3 * v * t * t * p[first + 2] +
         t * t * t * p[first + 3];
}

}  // namespace

TEST_CASE("seven points are two cubic curves with P3 in common", "[bezier]") {
  const JoinedBezier<2> curve(with_corner);
  double off = 0, slope = 0;
  for (int i = 0; i <= 200; ++i) {
    const double u = i / 100.0, h = 1e-5;
    off = std::max(off, (curve.position(u) - bernstein(with_corner, u)).norm());
    if (i % 100 == 0) continue;
    const Vector3 numeric = (bernstein(with_corner, u + h) - bernstein(with_corner, u - h)) / (2 * h);
    slope = std::max(slope, (curve.derivative(u) - numeric).norm());
  }
  CHECK(off < 1e-14);
  CHECK(slope < 1e-7);
  CHECK(curve.position(1.0) == with_corner[3]);
  CHECK(curve.position(9.0) == with_corner[6]);
  double polygon = 0;
  for (int i = 0; i < 20000; ++i)
    polygon += (bernstein(with_corner, (i + 1) / 1e4) - bernstein(with_corner, i / 1e4)).norm();
  CHECK(curve.length() == Approx(polygon).epsilon(1e-7));
}

TEST_CASE("the joint has a corner unless P2, P3 and P4 lie on a line", "[bezier]") {
  const JoinedBezier<2> corner(with_corner);
  // from (4, -4) to (4, 5)
  const double turned = std::atan2(1.0, 1.0) + std::atan2(5.0, 4.0);
  CHECK(corner.corner(0) == Approx(turned));
  const Controls smooth = path::smooth_joints(with_corner);
  const JoinedBezier<2> curve(smooth);
  CHECK(curve.corner(0) < 1e-15);
  CHECK((smooth[4] - smooth[3]).norm() == Approx((with_corner[4] - with_corner[3]).norm()));
  for (const std::size_t i : {0U, 1U, 2U, 3U, 5U, 6U}) CHECK(smooth[i] == with_corner[i]);
  // the direction on both sides of the joint, from the curve
  const double h = 1e-9;
  CHECK((curve.derivative(1 - h).normalized() - curve.derivative(1).normalized()).norm() < 1e-7);
  CHECK((corner.derivative(1 - h).normalized() - corner.derivative(1).normalized()).norm() > 1.0);
}

TEST_CASE("any number of smooth joints", "[bezier]") {
  test::Random random;
  JoinedBezier<4>::Controls controls;
  for (Vector3& control : controls)
    control = {random.uniform(-10, 10), random.uniform(-10, 10), random.uniform(-10, 10)};
  const JoinedBezier<4> curve(path::smooth_joints(controls));
  for (int i = 0; i < 3; ++i) {
    CAPTURE(test::seed(), i);
    CHECK(curve.corner(i) < 1e-15);
    CHECK(curve.next_change(i + 0.5) == i + 1);
    CHECK(curve.next_change(i) == i + 1);
  }
  CHECK(curve.next_change(3.5) == 4.0);
  CHECK(curve.next_change(4.0) == 4.0);
}
