#include "cncplan/profile/stretch.hpp"

#include <cmath>

#include "support/catch.hpp"
#include "support/profile_oracle.hpp"

using namespace cncplan;

TEST_CASE("a stretched move takes the time it is given, within the limits") {
  test::Random random;
  double worst_time = 0.0;
  test::ProfileErrors worst;
  int solved = 0;
  for (int n = 0; n < 30000; ++n) {
    const test::ProfileCase c = test::draw(random);
    const auto fastest = profile::seven_phase(c.length, c.speeds, c.limits);
    if (!fastest) continue;
    const double duration = fastest->duration() * random.log_uniform(1.0, 4.0);
    const auto p = profile::stretched(c.length, c.speeds, duration, c.limits);
    INFO(c.literal());
    if (!p) {
      REQUIRE(p.error().code == ErrorCode::above_limit);
      continue;
    }
    ++solved;
    worst_time = std::max(worst_time, std::abs(p->duration() / duration - 1));
    const auto errors = test::examine(c, *p);
    worst.end_position = std::max(worst.end_position, errors.end_position);
    worst.end_speed = std::max(worst.end_speed, errors.end_speed);
    worst.acceleration_excess = std::max(worst.acceleration_excess, errors.acceleration_excess);
    worst.velocity_excess = std::max(worst.velocity_excess, errors.velocity_excess);
    worst.lowest_speed = std::max(worst.lowest_speed, errors.lowest_speed);
  }
  CHECK(solved > 10000);
  CHECK(worst_time < 1e-12);
  CHECK(worst.end_position < 16.0);
  CHECK(worst.end_speed < 16.0);
  CHECK(worst.acceleration_excess < 1e-12);
  CHECK(worst.velocity_excess < 1e-12);
  CHECK(worst.lowest_speed < 1e-12);
}

TEST_CASE("from rest to rest any longer time can be had") {
  const Limits limits{30.0, 1000.0, 10000.0};
  const auto fastest = profile::seven_phase(5.0, {0.0, 0.0}, limits);
  for (const double times : {1.0, 1.0001, 2.0, 100.0}) {
    const auto p = profile::stretched(5.0, {0.0, 0.0}, times * fastest->duration(), limits);
    REQUIRE(p);
    CHECK(p->duration() == Approx(times * fastest->duration()).epsilon(1e-12));
  }
}

TEST_CASE("times out of reach are refused with the bound") {
  const Limits limits{30.0, 1000.0, 10000.0};
  const auto fastest = profile::seven_phase(5.0, {0.0, 0.0}, limits);
  const auto shorter = profile::stretched(5.0, {0.0, 0.0}, 0.5 * fastest->duration(), limits);
  CHECK(shorter.error() ==
        Error{ErrorCode::below_limit, "duration", 0.5 * fastest->duration(), fastest->duration()});
  const auto longer = profile::stretched(0.5, {20.0, 20.0}, 10.0, limits);  // cannot slow down that far
  REQUIRE_FALSE(longer);
  CHECK(longer.error().code == ErrorCode::above_limit);
  CHECK(profile::stretched(0.5, {20.0, 20.0}, longer.error().bound, limits));
}
