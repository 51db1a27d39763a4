#include "cncplan/junction/exact_stop.hpp"

#include "junction/junctions.hpp"
#include "support/catch.hpp"

using namespace cncplan;

TEST_CASE("exact stop stops, even where nothing turns") {
  CHECK(junction::ExactStop{}.speed_sq(test::corner(0.0)) == 0.0);
  CHECK(junction::ExactStop{}.speed_sq(test::corner<float>(1.0)) == 0.0f);
  STATIC_REQUIRE(JunctionPolicy<junction::ExactStop>);
  STATIC_REQUIRE(JunctionPolicy<junction::ExactStop, float>);
}
