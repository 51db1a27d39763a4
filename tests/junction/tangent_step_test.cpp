#include "cncplan/junction/tangent_step.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "junction/junctions.hpp"
#include "support/catch.hpp"

using namespace cncplan;

TEST_CASE("at the tangent policy's speed the axis that jumps most jumps by the step") {
  test::Random random;
  double worst = 0.0;
  for (int draw = 0; draw < 10000; ++draw) {
    const auto junction =
        test::corner<double>(test::random_direction(random), test::random_direction(random));
    const double step = random.log_uniform(0.01, 10.0);
    const double speed = std::sqrt(junction::TangentStep{step}.speed_sq(junction));
    double jump = 0.0;
    for (int axis = 0; axis < 3; ++axis)
      jump = std::max(jump,
                      std::abs(speed * junction.after.tangent[axis] - speed * junction.before.tangent[axis]));
    worst = std::max(worst, std::abs(jump / step - 1.0));
  }
  CHECK(worst < 1e-13);
}

TEST_CASE("a right angle, a reversal and a straight junction by hand") {
  const junction::TangentStep policy{2.0};
  CHECK(policy.speed_sq(test::corner(std::numbers::pi / 2)) == Approx(4.0).epsilon(1e-14));
  CHECK(policy.speed_sq(test::corner(std::numbers::pi)) == Approx(1.0).epsilon(1e-14));
  CHECK(std::isinf(policy.speed_sq(test::corner(0.0))));
  CHECK(std::isinf(junction::TangentStep{0.0}.speed_sq(test::corner(0.0))));
  CHECK(junction::TangentStep{0.0}.speed_sq(test::corner(1e-9)) == 0.0);
  CHECK(junction::BasicTangentStep<float>{2.0f}.speed_sq(test::corner<float>(std::numbers::pi / 2)) ==
        Approx(4.0).epsilon(1e-6));
}
