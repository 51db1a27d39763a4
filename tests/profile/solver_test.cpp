#include "cncplan/profile/solver.hpp"

#include <cmath>
#include <limits>

#include "cncplan/profile/five_phase.hpp"
#include "cncplan/profile/seven_phase.hpp"
#include "support/catch.hpp"
#include "support/profile_oracle.hpp"

using namespace cncplan;

TEST_CASE("random profiles keep every limit and lose no time against an independent optimum") {
  // the same check as the soak, which goes on for longer
  test::Random random;
  test::ProfileErrors worst;
  test::ProfileCase where{};
  for (int draw = 0; draw < 100000; ++draw) {
    const test::ProfileCase c = test::draw(random);
    for (const bool seven : {false, true}) {
      const auto p = seven ? profile::seven_phase(c.length, c.speeds, c.limits)
                           : profile::five_phase(c.length, c.speeds, c.limits);
      if (!p) continue;
      const auto errors = test::examine(c, *p);
      const double loss = test::time_loss(c, *p, seven);
      if (std::abs(loss) > worst.time_loss) worst.time_loss = std::abs(loss), where = c;
      worst.end_position = std::max(worst.end_position, errors.end_position);
      worst.end_speed = std::max(worst.end_speed, errors.end_speed);
      worst.velocity_excess = std::max(worst.velocity_excess, errors.velocity_excess);
      worst.acceleration_excess = std::max(worst.acceleration_excess, errors.acceleration_excess);
      worst.jerk_excess = std::max(worst.jerk_excess, errors.jerk_excess);
    }
  }
  INFO("worst time: " << where.literal());
  CHECK(worst.time_loss < 1e-12);
  CHECK(worst.end_position < 8.0);
  CHECK(worst.end_speed < 8.0);
  CHECK(worst.velocity_excess < 1e-12);
  CHECK(worst.acceleration_excess < 1e-12);
  CHECK(worst.jerk_excess < 1e-12);
}

TEST_CASE("the reachable speed is the one whose ramp fills the length") {
  test::Random random;
  double worst = 0.0;
  test::ProfileCase where{};
  for (int draw = 0; draw < 50000; ++draw) {
    const test::ProfileCase c = test::draw(random);
    for (const bool seven : {false, true}) {
      const auto solver =
          seven ? profile::seven_phase_solver(c.limits) : profile::five_phase_solver(c.limits);
      const double top = solver.reachable_speed(c.speeds.start, c.length);
      REQUIRE(top >= c.speeds.start);
      REQUIRE(top <= c.limits.velocity);
      REQUIRE(solver(c.length, {c.speeds.start, top}));
      REQUIRE(solver(c.length, {top, c.speeds.start}));
      if (top == c.limits.velocity) continue;
      // by bisection on the change of speed
      test::Real low = 0, high = c.limits.velocity - c.speeds.start;
      for (int halving = 0; halving < 200; ++halving) {
        const test::Real middle = (low + high) / 2;
        (test::ramp_distance(c.speeds.start, c.speeds.start + middle, c.limits.acceleration, c.limits.jerk,
                             seven) <= c.length
             ? low
             : high) = middle;
      }
      const double off = std::abs(static_cast<double>((c.speeds.start + low - top) / (c.speeds.start + low)));
      if (off > worst) worst = off, where = c;
    }
  }
  INFO(where.literal());
  CHECK(worst < 1e-14);
}

TEST_CASE("the root between two ramps is exact to rounding over all magnitudes") {
  test::Random random;
  double worst = 0.0;
  for (int n = 0; n < 200000; ++n) {
    const double high = random.integer(0, 9) == 0 ? 0.0 : random.log_uniform(1e-6, 1e4);
    const double low =
        random.coin() ? high * random.uniform(0.0, 1.0) : high * (1.0 - random.log_uniform(1e-12, 1.0));
    const double sum = high + low, d = high - low;
    const double c =
        std::sqrt(d) * sum * (1.0 + random.log_uniform(1e-12, 1e4)) + random.log_uniform(1e-12, 1e8);
    const double w = profile::detail::double_ramp_root(sum, c, d);
    // by halving, of w^3 + 4 sum w - d^2 / w = 4 c, which grows with w
    test::Real below = w / 2, above = 2 * w;
    for (int halving = 0; halving < 80; ++halving) {
      const test::Real middle = (below + above) / 2;
      const test::Real value = middle * (middle * middle + 4 * static_cast<test::Real>(sum)) -
                               static_cast<test::Real>(d) * d / middle - 4 * static_cast<test::Real>(c);
      (value < 0 ? below : above) = middle;
    }
    worst = std::max(worst, std::abs(static_cast<double>(w / below - 1)));
  }
  CHECK(worst < 1e-15);
}

TEST_CASE("the cube root is exact to rounding over all magnitudes") {
  double worst = 0.0;
  float worst_float = 0.0F;
  for (const double scale : {1e-300, 1e-9, 1.0, 1e11, 1e300})
    for (int n = 0; n < 100000; ++n) {
      const double x = scale * std::exp2(3.0 * n / 100000);
      const test::Real root = std::cbrt(static_cast<test::Real>(x));
      worst = std::max(worst, static_cast<double>(std::abs(profile::detail::cube_root(x) / root - 1)));
      if (scale < 1e-9 || scale > 1e11) continue;
      const float narrow = static_cast<float>(x);
      const float off = profile::detail::cube_root(narrow) / std::cbrt(narrow) - 1.0F;
      worst_float = std::max(worst_float, std::abs(off));
    }
  CHECK(worst < 3 * std::numeric_limits<double>::epsilon());
  CHECK(worst_float < 4 * std::numeric_limits<float>::epsilon());
}

TEST_CASE("zero length and the speed limit itself are ordinary cases") {
  const auto solver = profile::seven_phase_solver(Limits{30.0, 1000.0, 10000.0});
  const auto nothing = solver(0.0, {5.0, 5.0});
  REQUIRE(nothing);
  CHECK(nothing->duration() == 0.0);
  CHECK(nothing->at(0.0).velocity == 5.0);
  const auto cruise = solver(60.0, {30.0, 30.0});
  REQUIRE(cruise);
  CHECK(cruise->duration() == Approx(2.0).epsilon(1e-15));
  CHECK(solver.reachable_speed(5.0, 0.0) == 5.0);
  CHECK(solver.reachable_speed(30.0, 1.0) == 30.0);
}

TEST_CASE("a ramp that fills its length to the last digit is feasible (found by the soak, seed 1)") {
  const Limits limits{0.021340459271441979, 3.7496784472480762, 6838613.1541934507};
  CHECK(profile::five_phase(4.4861359234020375e-05, {0.016946962267085339, 0.021340459271441979}, limits));
}

TEST_CASE("a solver without a speed limit above zero refuses whatever it is asked") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double length : {0.0, 10.0}) {
    const auto p = profile::five_phase_solver(Limits{nan, 1000.0, 10000.0})(length, {0.0, 0.0});
    REQUIRE_FALSE(p);
    CHECK(p.error().code == ErrorCode::not_finite);
    CHECK(p.error().field == "velocity limit");
    for (const double limit : {0.0, -1.0})
      CHECK(profile::seven_phase_solver(Limits{limit, 1000.0, 10000.0})(length, {0.0, 0.0}).error() ==
            Error{ErrorCode::not_positive, "velocity limit", limit, 0.0});
  }
}

TEST_CASE(
    "an end speed out of reach is refused with the nearest one on the way, though a lower one is near") {
  // (20 + v) sqrt((20 - v) / J) is 0.95 mm at v = 9.915, more at 5, less again at 3.1
  const auto solver = profile::seven_phase_solver(Limits{30.0, 1000.0, 10000.0});
  const auto refused = solver(0.95, {20.0, 5.0});
  REQUIRE_FALSE(refused);
  const double bound = refused.error().bound;
  CHECK(bound == Approx(9.915).epsilon(1e-3));
  CHECK((20.0 + bound) * std::sqrt((20.0 - bound) / 1e4) == Approx(0.95).epsilon(1e-12));
  CHECK(solver(0.95, {20.0, 3.1}));
}
