#include "cncplan/kinematics/polar.hpp"

#include "cncplan/path/mapped.hpp"
#include "laws.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace cncplan::kinematics;

static_assert(path::Map<PolarMap> && path::Map<BasicPolarMap<float>>);

namespace {
constexpr double pi = std::numbers::pi;
}

TEST_CASE("polar joints of known points", "[polar]") {
  const Polar machine;
  const auto q = machine.inverse({{3, 4, 5}, Vector3::UnitZ()});
  REQUIRE(q);
  CHECK((*q)[0] == 5);
  CHECK((*q)[1] == 5);
  CHECK((*q)[2] == Approx(std::atan2(4, 3)));
  CHECK((*machine.inverse({{-3, 0, 5}, Vector3::UnitZ()}))[2] == Approx(pi));
}

TEST_CASE("polar: a million poses there and back", "[polar]") {
  test::Random random;
  const Polar machine;
  test::KinematicErrors worst;
  for (int i = 0; i < 1000000; ++i) {
    const Vector3 q(random.log_uniform(1, 900), random.uniform(0, 600), random.uniform(-pi, pi));
    test::examine(machine, q, Vector3(q[0], 600, pi), worst);
    if (i < 1000) test::examine_jacobian(machine, q, 900, worst);
  }
  CHECK(worst.round_trip < 1e-12);
  CHECK(worst.jacobian < 1e-10);
  CHECK(worst.refused == 0);
}

TEST_CASE("polar: the axis and tilted tools are out of reach", "[polar]") {
  const Polar machine{.smallest_radius = 2};
  CHECK(machine.inverse({{1, 1, 0}, Vector3::UnitZ()}).error() ==
        Error{ErrorCode::below_limit, "radius", std::sqrt(2.0), 2});
  CHECK(machine.inverse({{0, 0, 0}, Vector3::UnitZ()}).error() ==
        Error{ErrorCode::below_limit, "radius", 0, 2});
  for (const double angle : {-3.0, -1.0, 0.1, pi / 2, pi}) {
    const auto refused = machine.inverse({{9, 9, 0}, {std::sin(angle), 0, std::cos(angle)}});
    REQUIRE(!refused);
    CHECK(refused.error().code == ErrorCode::unreachable);
    CHECK(refused.error().value == Approx(std::abs(angle)));
  }
}

TEST_CASE("polar: a table that turns from 0 to 360 degrees reaches every direction", "[polar]") {
  Polar machine;
  machine.limits.low[2] = 0;
  machine.limits.high[2] = 2 * pi;
  for (int degree = 0; degree < 360; ++degree) {
    const double c = degree * pi / 180;
    CAPTURE(degree);
    const auto q = machine.inverse({{50 * std::cos(c), 50 * std::sin(c), 5}, Vector3::UnitZ()});
    REQUIRE(q);
    CHECK((*q)[2] == Approx(c).margin(1e-14));
  }
  machine.limits.high[2] = pi / 2;
  CHECK(machine.inverse({{-3, 0, 5}, Vector3::UnitZ()}).error() ==
        Error{ErrorCode::above_limit, "C and whole turns from it", pi, pi / 2});
}
