#include "cncplan/junction/minimum.hpp"

#include <cmath>

#include "cncplan/junction/acceleration_step.hpp"
#include "cncplan/junction/deviation.hpp"
#include "cncplan/junction/exact_stop.hpp"
#include "cncplan/junction/tangent_step.hpp"
#include "junction/junctions.hpp"
#include "support/catch.hpp"

using namespace cncplan;

TEST_CASE("the minimum is each of its policies where that is the lowest") {
  const junction::Deviation deviation{0.01};
  const junction::TangentStep tangent{3.0};
  const auto both = junction::minimum(deviation, tangent);
  int first = 0, second = 0;
  for (double turn = 0.01; turn < 3.1; turn += 0.01) {
    const auto junction = test::corner(turn);
    const double a = deviation.speed_sq(junction), b = tangent.speed_sq(junction);
    REQUIRE(both.speed_sq(junction) == (a < b ? a : b));
    ++(a < b ? first : second);
  }
  CHECK(first > 0);
  CHECK(second > 0);
  CHECK(junction::minimum(deviation, junction::ExactStop{}).speed_sq(test::corner(0.1)) == 0.0);
  CHECK(std::isinf(both.speed_sq(test::corner(0.0))));
}

TEST_CASE("of no policies the minimum is no limit") {
  CHECK(std::isinf(junction::minimum().speed_sq(test::corner(1.0))));
  CHECK(std::isinf(junction::minimum().speed_sq(test::corner<float>(1.0))));
}
