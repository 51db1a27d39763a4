#include "cncplan/junction/stop_at_corners.hpp"

#include <cmath>
#include <numbers>

#include "cncplan/junction/deviation.hpp"
#include "cncplan/junction/minimum.hpp"
#include "junction/junctions.hpp"
#include "support/catch.hpp"

using namespace cncplan;

TEST_CASE("exact path stops at corners, and passes what goes straight on") {
  constexpr double degree = std::numbers::pi / 180.0;
  const junction::StopAtCorners policy;
  for (const double smooth : {0.0, 1e-9, 0.05 * degree, 0.0999 * degree})
    CHECK(std::isinf(policy.speed_sq(test::corner(smooth))));
  for (const double corner : {0.1001 * degree, 1.0 * degree, 1.0, 3.1, std::numbers::pi})
    CHECK(policy.speed_sq(test::corner(corner)) == 0.0);
  CHECK(std::isinf(junction::StopAtCorners{.turn = 1.0}.speed_sq(test::corner(0.99))));
  CHECK(junction::BasicStopAtCorners<float>{}.speed_sq(test::corner<float>(0.01)) == 0.0F);
  STATIC_REQUIRE(JunctionPolicy<junction::StopAtCorners>);
}

TEST_CASE("at its smooth junctions another policy decides") {
  const junction::Deviation deviation{0.01};
  const auto both = junction::minimum(junction::StopAtCorners{}, deviation);
  const auto smooth = test::corner(1e-3), corner = test::corner(2e-3);
  CHECK(both.speed_sq(smooth) == deviation.speed_sq(smooth));
  CHECK(both.speed_sq(corner) == 0.0);
}
