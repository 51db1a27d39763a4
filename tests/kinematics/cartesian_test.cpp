#include "cncplan/kinematics/cartesian.hpp"

#include "cncplan/path/mapped.hpp"
#include "laws.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace cncplan::kinematics;

static_assert(path::Map<CartesianMap> && path::Map<BasicCartesianMap<float>>);

TEST_CASE("a plain mill goes where it is told", "[cartesian]") {
  test::Random random;
  test::KinematicErrors worst;
  for (int i = 0; i < 1000; ++i) {
    const Vector3 q(random.uniform(-500, 500), random.uniform(-500, 500), random.uniform(-500, 500));
    test::examine(Cartesian{}, q, Vector3::Ones(), worst);
    test::examine_jacobian(Cartesian{}, q, 500, worst);
  }
  CHECK(worst.round_trip == 0);
  CHECK(worst.jacobian < 1e-12);
  CHECK(worst.refused == 0);
}

TEST_CASE("a plain mill refuses tilted tools and leaves no travel", "[cartesian]") {
  Cartesian machine;
  machine.limits.low = {0, 0, -100};
  machine.limits.high = {400, 300, 0};
  const auto tilted = machine.inverse({{1, 1, -1}, Vector3(0.1, 0, 1).normalized()});
  REQUIRE(!tilted);
  CHECK(tilted.error().code == ErrorCode::unreachable);
  CHECK(tilted.error().value == Approx(std::atan(0.1)));
  const auto upside_down = machine.inverse({{1, 1, -1}, -Vector3::UnitZ()});
  REQUIRE(!upside_down);
  CHECK(upside_down.error().value == std::numbers::pi);
  CHECK(upside_down.error().bound < 1e-14);
  const auto low = machine.inverse({{1, -2, -1}, Vector3::UnitZ()});
  CHECK(low.error() == Error{ErrorCode::below_limit, "Y", -2, 0});
  const auto high = machine.inverse({{1, 2, 3}, Vector3::UnitZ()});
  CHECK(high.error() == Error{ErrorCode::above_limit, "Z", 3, 0});
}
