// The speed at which an axis turns round, held against the motion behind it.
#include "cncplan/plan/reversal.hpp"

#include <cmath>

#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

TEST_CASE("at the reversal speed an axis goes as far as allowed in the time, and no farther") {
  test::Random random;
  for (int draws = 0; draws < 2000; ++draws) {
    const plan::ReversalRule rule{random.log_uniform(1e-5, 1e-2), random.log_uniform(1e-5, 1e-1)};
    const double rate = random.coin() ? 0.0 : random.uniform(-1.0, 1.0);
    const double bend = random.coin() ? 0.0 : random.uniform(-3.0, 3.0);
    const double acceleration = random.log_uniform(1, 1e4);
    const double v = plan::reversal_speed(rate, bend, acceleration, rule);
    CAPTURE(rule.time, rule.distance, rate, bend, acceleration, v);
    const double t = rule.time;
    const double by_ramp = acceleration * t * t / 2;
    const auto gone = [&](double way) { return std::abs(rate) * way + std::abs(bend) * way * way / 2; };
    if (rate == 0.0 && bend == 0.0)
      CHECK(std::isinf(v));
    else if (gone(by_ramp) >= rule.distance)
      CHECK(v == 0.0);
    else
      CHECK(gone(v * t + by_ramp) == Approx(rule.distance).epsilon(1e-9));
  }
}
