#include "cncplan/junction/deviation.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>

#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/path/line.hpp"
#include "junction/junctions.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

// The formula from the angle between two vectors, in long double.
long double formula(const junction::Geometry& junction, double delta) {
  const Eigen::Matrix<long double, 3, 1> t0 = junction.before.tangent.cast<long double>();
  const Eigen::Matrix<long double, 3, 1> t1 = junction.after.tangent.cast<long double>();
  const long double along = t0.dot(t1);
  const long double across =
      t0.cross(along > 0 ? (t1 - t0).eval() : (t1 + t0).eval()).norm();  // without cancelling digits
  const long double sine = std::sin(std::atan2(across, -along) / 2);     // of theta/2
  const long double rest = 2 * std::pow(std::sin(std::atan2(across, along) / 4), 2.0L);  // 1 - sine
  return junction.limits.acceleration * delta * sine / rest;
}

}  // namespace

TEST_CASE("deviation agrees with its formula from reversal to turns of 1e-9 rad") {
  test::Random random;
  double worst = 0.0, at = 0.0;
  for (int draw = 0; draw < 20000; ++draw) {
    const Vector3 before = test::random_direction(random);
    const Vector3 aside = before.cross(test::random_direction(random)).normalized();
    const double small = random.log_uniform(1e-9, 3.0);
    const double turn = random.coin() ? small : std::numbers::pi - small;
    const auto junction = test::corner<double>(before, std::cos(turn) * before + std::sin(turn) * aside);
    const double delta = random.log_uniform(1e-4, 1.0);
    const double off = std::abs(
        static_cast<double>(junction::Deviation{delta}.speed_sq(junction) / formula(junction, delta) - 1));
    if (off > worst) worst = off, at = turn;
  }
  INFO("turn " << at);
  CHECK(worst < 1e-12);
}

TEST_CASE("a right angle and a reversal by hand") {
  const junction::Deviation policy{0.01};
  const double half = std::sqrt(0.5);
  CHECK(policy.speed_sq(test::corner(std::numbers::pi / 2)) ==
        Approx(10.0 * half / (1.0 - half)).epsilon(1e-14));
  const Vector3 odd = Vector3(1, 2, 3).normalized();
  CHECK(policy.speed_sq(test::corner<double>(odd, -odd)) == 0.0);
  CHECK(junction::Deviation{0.0}.speed_sq(test::corner(1e-3)) == 0.0);
}

TEST_CASE("straight junctions are free, rounded ones too") {
  const junction::Deviation policy{0.01};
  test::Random random;
  int held = 0;
  for (int draw = 0; draw < 1000; ++draw) {
    // one line cut in two, its points rounded to doubles: how straight it stays is a matter of its lengths
    const Vector3 start{random.uniform(-500, 500), random.uniform(-500, 500), random.uniform(-50, 50)};
    const Vector3 direction = test::random_direction(random);
    const Vector3 middle = start + random.log_uniform(1e-3, 100) * direction;
    const Vector3 end = middle + random.log_uniform(1e-3, 100) * direction;
    const auto junction = test::corner<double>(path::Line<3>(start, middle).end_tangent(),
                                               path::Line<3>(middle, end).start_tangent());
    held += policy.speed_sq(junction) < 1e6 * 1e6;
  }
  CHECK(held == 0);
  const Vector3 odd = Vector3(1, 2, 3).normalized();
  CHECK(std::isinf(policy.speed_sq(test::corner<double>(odd, odd))));
}

TEST_CASE("a tangent arc is not slowed, with coordinates of three decimals") {
  // from the left into a quarter circle whose end and centre are off by up to half a micrometre
  const auto arc = path::arc_from_center(Vector3(0, 0, 0), Vector3(0.7073, 0.2929, 0),
                                         Vector3(0.0004, 0.9996, 0), Turn::counterclockwise, Plane::xy);
  REQUIRE(arc);
  const auto junction = test::corner<double>({1, 0, 0}, arc->start_tangent());
  CHECK(std::sqrt(junction::Deviation{0.01}.speed_sq(junction)) > 1000.0);
}

TEST_CASE("the largest turn at full speed") {
  // v^2 <= A delta c / (1 - c): what docs/planning.md states as the tolerance of tangent junctions
  const double free = 2.0 * std::acos(900.0 / 910.0);
  CHECK(free * 180.0 / std::numbers::pi == Approx(17.0).margin(0.05));
  CHECK(std::sqrt(junction::Deviation{0.01}.speed_sq(test::corner(free))) == Approx(30.0).epsilon(1e-12));
}

TEST_CASE("deviation in float") {
  for (const double turn : {1e-3, 0.1, 1.0, 2.0, 3.0}) {
    CAPTURE(turn);
    CHECK(junction::BasicDeviation<float>{0.01f}.speed_sq(test::corner<float>(turn)) ==
          Approx(junction::Deviation{0.01}.speed_sq(test::corner(turn))).epsilon(1e-5));
  }
  CHECK(std::isinf(junction::BasicDeviation<float>{0.01f}.speed_sq(test::corner<float>(0.0))));
}
