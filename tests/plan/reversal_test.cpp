// The speed at which an axis turns round, held against the motion behind it.
#include "cncplan/step/reversal.hpp"

#include <algorithm>
#include <cmath>

#include "cncplan/plan_program.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

TEST_CASE("at the reversal speed an axis goes as far as allowed in the time, and no farther") {
  test::Random random;
  for (int draws = 0; draws < 2000; ++draws) {
    const step::ReversalRule rule{random.log_uniform(1e-5, 1e-2), random.log_uniform(1e-5, 1e-1)};
    const double rate = random.coin() ? 0.0 : random.uniform(-1.0, 1.0);
    const double bend = random.coin() ? 0.0 : random.uniform(-3.0, 3.0);
    const double acceleration = random.log_uniform(1, 1e4);
    const double v = step::reversal_speed(rate, bend, acceleration, rule);
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

// The oracle: on a circle X turns round where Y is that of the centre, and its second derivative is 1 / R.
TEST_CASE("an axis with backlash turns round slowly in the middle of a block, and nowhere else") {
  constexpr double R = 10;
  for (const double time : {0.006, 0.009}) {
    Machine<3> machine{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
    machine.axes[0].motors = {{.steps_per_unit = 100, .max_rate = 6 / time, .backlash = 0.05}};
    const auto planned = plan_text("G1 X5 Y0 F1800\nG3 X5 Y0 I6 J8 P2\nG1 X0\n", machine, {.tolerance = 0});
    REQUIRE(planned);
    const double way = std::sqrt(2 * (0.1 / 100) * R);
    int turns = 0;
    double fastest = 0;
    for (double t = 0, v = 0; t < planned->duration(); t += 1e-4) {
      const auto point = planned->at(t);
      if (point.block == 1) {
        fastest = std::max(fastest, point.along.velocity);
        if (v * point.velocity[0] < 0) {
          ++turns;
          CAPTURE(time, t);
          const double allowed = way / time - point.along.acceleration * time / 2;
          CHECK(point.along.velocity <= std::min(allowed, way / time) + 0.2);
        }
        v = point.velocity[0];
      }
    }
    CHECK(turns == 4);
    CHECK(fastest > 25);
  }
}
