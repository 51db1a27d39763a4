#include "cncplan/published/cap_speed.hpp"

#include <algorithm>
#include <cmath>

#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

TEST_CASE("v^2/R and v^3/R^2 reach the limits and no more") {
  test::Random random;
  double worst = 0.0;
  for (int draws = 0; draws < 20000; ++draws) {
    const Limits whole{random.log_uniform(1, 500), random.log_uniform(10, 1e4), random.log_uniform(100, 1e6)};
    const double k = random.log_uniform(1e-4, 1e3);
    const Limits along = published::cap_speed(k, 0, whole);
    const double v = along.velocity;
    const double used =
        std::max({v / whole.velocity, v * v * k / whole.acceleration, v * v * v * k * k / whole.jerk});
    worst = std::max(worst, std::abs(used - 1.0));
    REQUIRE(along.acceleration == whole.acceleration);
    REQUIRE(along.jerk == whole.jerk);
  }
  CHECK(worst < 1e-14);
  // R = 0.5 mm at 30 mm/s would take 1800 mm/s^2 and 108000 mm/s^3
  CHECK(published::cap_speed(2.0, 0, {30, 1000, 10000}).velocity == Approx(std::cbrt(2500.0)).epsilon(1e-14));
}

TEST_CASE("on a helix the jerk at constant speed is that of the curve's third derivative") {
  // |d^3 p / ds^3| = hypot(0.09, 0.4) = 0.41
  CHECK(published::cap_speed(0.3, 0.4, {1e3, 1e9, 41.0}).velocity == Approx(std::cbrt(100.0)).epsilon(1e-14));
}

TEST_CASE("a straight path keeps all its limits") {
  const Limits kk22{30, 1000, 10000};
  CHECK(published::cap_speed(0.0, 0, kk22) == kk22);
}
