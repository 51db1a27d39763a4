#include "cncplan/detail/executor/brake.hpp"

#include <cmath>
#include <vector>

#include "cncplan/profile/from_state.hpp"
#include "support/brake_oracle.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

struct Stop {
  double time = 0.0;
  double worst = 0.0;  ///< acceleration and jerk beyond their limits, relative
  State end;
};

// Profile after profile to rest, as a motion executor drives them.
Stop brake(State now, std::vector<detail::SegmentLimits> zones) {
  Stop stop;
  for (int leg_number = 0; leg_number < 100; ++leg_number) {
    const Limits& limits = zones.front().limits;
    auto profile = detail::BasicBrake<double>(zones).profile(now);
    const double length = profile.length();
    while (profile.left() > 0.0) {
      const State state = profile.state();
      stop.worst = std::max({stop.worst, std::abs(state.acceleration) / limits.acceleration - 1,
                             std::abs(state.jerk) / limits.jerk - 1});
      const double edge = profile.to_edge();
      stop.time += edge;
      if (edge >= profile.left()) break;
      profile.advance(edge);
    }
    profile.advance(profile.left());
    stop.end = now = profile.state();
    if (now.velocity < 1e-8) break;
    zones.front().length -= length;
    if (zones.size() > 1 && zones.front().length < 1e-9) zones.erase(zones.begin());
  }
  return stop;
}

}  // namespace

TEST_CASE("under one set of limits it brakes as the profile does") {
  test::Random random;
  for (int i = 0; i < 1000; ++i) {
    const Limits limits{30.0, random.log_uniform(100, 2000), random.log_uniform(2000, 50000)};
    const double a = random.uniform(-1, 1) * limits.acceleration;
    const State now{0, random.uniform(0, 30) + (a < 0 ? a * a / (2 * limits.jerk) : 0.0), a, 0};
    const auto best = profile::stop({now.velocity, now.acceleration}, limits);
    REQUIRE(best);
    const Stop stop = brake(now, {{1.0, 0, limits, 0}});
    CAPTURE(i, now.velocity, now.acceleration, limits.acceleration, limits.jerk);
    CHECK(stop.time == Approx(best->duration()).epsilon(1e-6));
    CHECK(std::abs(stop.end.velocity) < 1e-9);
  }
}

TEST_CASE("across a border it takes the least time within 0.1 %, and keeps the limits on both sides") {
  test::Random random;
  int drawn = 0, safe = 0, slower = 0;
  double worst = 0.0, excess = 0.0, end = 0.0;
  while (drawn < 120) {
    const Limits first{30.0, random.log_uniform(200, 2000), random.log_uniform(3000, 30000)};
    const Limits second{30.0, first.acceleration * random.uniform(0.3, 1.5),
                        first.jerk * random.uniform(0.3, 1.5)};
    const double a = random.uniform(-1, 1) * first.acceleration;
    const double v = random.uniform(1, 30) + (a < 0 ? a * a / (2 * first.jerk) : 0.0);
    const auto alone = profile::stop({v, a}, first);
    const double room = alone->length() * random.uniform(0.05, 1.0);
    const double best = test::BrakeOracle(v, a, room, first, second).least_time();
    if (!std::isfinite(best)) continue;  // there is no way to rest: no plan would come here
    ++drawn;
    const std::vector<detail::SegmentLimits> zones{{room, 0, first, 0}, {1.0, 0, second, 0}};
    const State now{0, v, a, 0};
    if (!detail::BasicBrake<double>(zones).safe(now)) continue;
    ++safe;
    const Stop stop = brake(now, zones);
    slower += stop.time > best * 1.001 ? 1 : 0;
    worst = std::max(worst, stop.time / best - 1);
    excess = std::max(excess, stop.worst);
    end = std::max(end, std::abs(stop.end.velocity));
  }
  CAPTURE(safe, slower, worst);
  CHECK(safe >= 0.97 * drawn);
  CHECK(slower <= 0.02 * safe);
  CHECK(worst < 0.03);
  CHECK(excess < 1e-9);
  CHECK(end < 1e-8);
}
