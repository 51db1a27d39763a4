#include "cncplan/detail/executor/running_profile.hpp"

#include <array>
#include <cmath>

#include "cncplan/profile/seven_phase.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

TEST_CASE("a running profile says what its profile says, whatever the steps") {
  test::Random random;
  double worst = 0.0;
  for (int i = 0; i < 300; ++i) {
    const Limits limits{30.0, random.log_uniform(100, 2000), random.log_uniform(1000, 50000)};
    const auto profile = profile::seven_phase(random.log_uniform(0.01, 20), {0.0, 0.0}, limits);
    REQUIRE(profile);
    detail::BasicRunningProfile<double> running(*profile);
    CHECK(running.length() == profile->length());
    CHECK(running.left() == profile->duration());
    double time = 0.0;
    while (running.left() > 1e-9) {
      const double step = std::min(running.left() * random.uniform(0, 1), random.log_uniform(1e-5, 1e-1));
      running.advance(step);
      time += step;
      const State is = running.state(), should = profile->at(time);
      worst = std::max({worst, std::abs(is.position - should.position) / profile->length(),
                        std::abs(is.velocity - should.velocity) / limits.velocity});
    }
  }
  CHECK(worst < 1e-9);
}

TEST_CASE("edges are where the jerk changes, the turn lies in the cruise, before the way down") {
  const Limits limits{30.0, 1000.0, 10000.0};
  const auto profile = profile::seven_phase(20.0, {0.0, 0.0}, limits);
  const auto phases = profile->phases();
  detail::BasicRunningProfile<double> running(*profile);
  const double down = profile->duration() - phases[4].time;
  CHECK(running.to_cruise_end() == Approx(phases[4].time - 0.25 * down));
  for (const double jerk : {10000.0, -10000.0, 0.0, -10000.0, 10000.0}) {
    CHECK(running.state().jerk == jerk);
    const double edge = running.to_edge();
    running.advance(edge / 2);
    CHECK(running.state().jerk == jerk);
    CHECK(running.to_edge() == Approx(edge / 2));
    running.advance(running.to_edge());
  }
  CHECK(running.to_cruise_end() < 0.0);
  CHECK(running.left() == Approx(0.0).margin(1e-15));
}

TEST_CASE("without a cruise the turn is at the top, no phases are rest") {
  const auto profile = profile::seven_phase(0.5, {0.0, 0.0}, Limits{30.0, 1000.0, 10000.0});
  CHECK(detail::BasicRunningProfile<double>(*profile).to_cruise_end() == Approx(profile->duration() / 2));
  const detail::BasicRunningProfile<double> none;
  CHECK(none.state() == State{});
  CHECK(none.left() == 0.0);
}

TEST_CASE("a profile that takes no time is in motion as its phases are") {
  const std::array<Phase, 2> phases{{{0.0, 0.0, 0.0, 1.5, -30.0, -4000.0}, {0.0, 0.0, 0.0, 1.5, -30.0, 0.0}}};
  detail::BasicRunningProfile<double> none(phases, 0.0);
  CHECK(none.left() == 0.0);
  none.advance(0.0);
  CHECK(none.state().velocity == 1.5);
  CHECK(none.end().velocity == 1.5);
  CHECK(none.end().acceleration == -30.0);
}
