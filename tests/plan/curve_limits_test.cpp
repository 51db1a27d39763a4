#include "cncplan/plan/curve_limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cncplan/path/arc_from_radius.hpp"
#include "cncplan/profile/five_phase.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Vector sums on a curve, over the limits of the whole motion. What its bend changes by adds the most where
// it points as all the rest does.
struct Sums {
  long double acceleration, jerk;
};
Sums sums(const Limits& whole, const plan::Bend& bend, long double v, long double a, long double j) {
  const long double k = bend.curvature;
  return {std::hypot(a, v * v * k) / whole.acceleration,
          (std::hypot(j - v * v * v * k * k, 3 * v * a * k) + v * v * v * bend.change) / whole.jerk};
}

Limits draw(test::Random& random) {
  return {random.log_uniform(1, 500), random.log_uniform(10, 1e4), random.log_uniform(100, 1e6)};
}

}  // namespace

TEST_CASE("shared limits keep both vector sums at every speed, acceleration and jerk within them") {
  test::Random random;
  long double acceleration = 0, jerk = 0;
  plan::Bend bent;
  Limits where{};
  for (int draws = 0; draws < 400; ++draws) {
    const Limits whole = draw(random);
    const double k = random.log_uniform(1e-4, 1e3);
    const double length = random.coin() ? infinity : random.log_uniform(1e-3, 1e4) / k;
    const plan::Bend bend{k, random.coin() ? 0.0 : k * k * random.log_uniform(1e-6, 1e3), length};
    const Limits along = plan::ShareLimits{}(bend, whole);
    REQUIRE(along.velocity <= whole.velocity);
    for (int iv = 0; iv <= 16; ++iv)
      for (int ia = -8; ia <= 8; ++ia)
        for (int ij = -8; ij <= 8; ++ij) {
          const auto [a, j] = sums(whole, bend, along.velocity * (iv / 16.0L),
                                   along.acceleration * (ia / 8.0L), along.jerk * (ij / 8.0L));
          if (std::max(a, j) > std::max(acceleration, jerk)) where = whole, bent = bend;
          acceleration = std::max(acceleration, a);
          jerk = std::max(jerk, j);
        }
  }
  INFO("bend " << bent.curvature << ", " << bent.change << ", limits " << where.velocity << ' '
               << where.acceleration << ' ' << where.jerk);
  CHECK(static_cast<double>(acceleration) <= 1 + 1e-12);
  CHECK(static_cast<double>(jerk) <= 1 + 1e-12);
  CHECK(static_cast<double>(jerk) > 1 - 1e-12);  // the rule leaves none of the jerk
}

TEST_CASE("what sharing leaves on the table") {
  test::Random random;
  double slowest = 1.0, least_jerk = 1.0;
  for (int draws = 0; draws < 100000; ++draws) {
    const Limits whole = draw(random);
    const double k = random.log_uniform(1e-4, 1e3);
    const Limits shared = plan::ShareLimits{}({k}, whole);
    slowest = std::min(slowest, shared.velocity / plan::CapSpeed{}({k}, whole).velocity);
    least_jerk = std::min(least_jerk, shared.jerk / whole.jerk);
    REQUIRE(shared.acceleration > 0.0);
  }
  CHECK(slowest == Approx(std::cbrt(0.5)).margin(1e-12));  // 20.6 % slower where the jerk binds
  CHECK(least_jerk > 0.13);
  CHECK(least_jerk < 0.14);
}

TEST_CASE("over a known length limits are shared so that it takes less time, and never more") {
  const auto rest_to_rest = [](const Limits& l, double length) {
    const auto ramp = [&](double v) {
      return v * l.jerk >= l.acceleration * l.acceleration ? v / l.acceleration + l.acceleration / l.jerk
                                                           : 2.0 * std::sqrt(v / l.jerk);
    };
    double low = 0.0, high = l.velocity;
    if (high * ramp(high) <= length) return length / high + ramp(high);
    for (int i = 0; i < 60; ++i) {
      const double v = (low + high) / 2.0;
      (v * ramp(v) <= length ? low : high) = v;
    }
    return 2.0 * ramp(low);
  };
  const Limits kk22{30, 1000, 10000};
  const auto gain = [&](double radius, double turns) {
    const double length = 2.0 * 3.141592653589793 * radius * turns;
    return 1.0 - rest_to_rest(plan::ShareLimits{}({1.0 / radius, 0.0, length}, kk22), length) /
                     rest_to_rest(plan::ShareLimits{}({1.0 / radius}, kk22), length);
  };
  CHECK(gain(1, 1) > 0.05);
  CHECK(gain(1, 10) > 0.09);
  CHECK(gain(1, 40) > 0.14);
  test::Random random;
  for (int draws = 0; draws < 2000; ++draws) {
    const double radius = random.log_uniform(0.1, 100), turns = random.log_uniform(0.05, 100);
    INFO(radius << ' ' << turns);
    CHECK(gain(radius, turns) >= -1e-12);
  }
}

TEST_CASE("a single arc keeps its limits as vectors, which its profile alone does not") {
  // the quarter circle of the first example, differenced twice and thrice over 0.1 ms
  const auto arc = path::arc_from_radius({0, 0, 0}, {5, 5, 0}, 5.0, Turn::clockwise, Plane::xy);
  REQUIRE(arc);
  const Limits limits{30.0, 1000.0, 10000.0};
  const auto worst = [&](const Limits& along) {
    const auto profile = profile::five_phase(arc->length(), {0.0, 0.0}, along);
    constexpr double h = 1e-4;
    Sums sums{};
    const auto at = [&](double t) { return arc->position(arc->parameter_at(profile->at(t).position)); };
    for (double t = 2.0 * h; t < profile->duration() - 2.0 * h; t += h) {
      const Vector3 a = (at(t + h) - 2.0 * at(t) + at(t - h)) / (h * h);
      const Vector3 j =
          (at(t + 1.5 * h) - 3.0 * at(t + 0.5 * h) + 3.0 * at(t - 0.5 * h) - at(t - 1.5 * h)) / (h * h * h);
      sums.acceleration = std::max<long double>(sums.acceleration, a.norm() / limits.acceleration);
      sums.jerk = std::max<long double>(sums.jerk, j.norm() / limits.jerk);
    }
    return sums;
  };
  CHECK(worst(limits).jerk > 1.1L);
  const Sums kept = worst(plan::limits_on(*arc, limits));
  CHECK(kept.acceleration <= 1.0L);
  CHECK(kept.jerk < 1.001L);
  CHECK(kept.jerk > 0.5L);
}

TEST_CASE("speed alone: v^2/R and v^3/R^2 reach the limits and no more") {
  test::Random random;
  double worst = 0.0;
  for (int draws = 0; draws < 20000; ++draws) {
    const Limits whole = draw(random);
    const double k = random.log_uniform(1e-4, 1e3);
    const Limits along = plan::CapSpeed{}({k}, whole);
    const double v = along.velocity;
    const double used =
        std::max({v / whole.velocity, v * v * k / whole.acceleration, v * v * v * k * k / whole.jerk});
    worst = std::max(worst, std::abs(used - 1.0));
    REQUIRE(along.acceleration == whole.acceleration);
    REQUIRE(along.jerk == whole.jerk);
  }
  CHECK(worst < 1e-14);
  // R = 0.5 mm at 30 mm/s would take 1800 mm/s^2 and 108000 mm/s^3
  CHECK(plan::CapSpeed{}({2.0}, Limits{30, 1000, 10000}).velocity ==
        Approx(std::cbrt(2500.0)).epsilon(1e-14));
}

TEST_CASE("speed alone on a helix: its jerk at constant speed is that of the curve's third derivative") {
  const plan::Bend bend{0.3, 0.4};  // |d^3 p / ds^3| = hypot(0.09, 0.4) = 0.41
  CHECK(plan::CapSpeed{}(bend, Limits{1e3, 1e9, 41.0}).velocity == Approx(std::cbrt(100.0)).epsilon(1e-14));
}

TEST_CASE("a straight path keeps its limits, and limits that are not there stay so") {
  const Limits kk22{30, 1000, 10000};
  CHECK(plan::ShareLimits{}({0.0}, kk22) == kk22);
  CHECK(plan::CapSpeed{}({0.0}, kk22) == kk22);
  const Limits no_jerk = plan::ShareLimits{}({0.1}, Limits{30, 1000, infinity});
  CHECK(no_jerk.jerk == infinity);
  CHECK(std::hypot(no_jerk.acceleration, 90.0) == Approx(1000.0).epsilon(1e-14));
  const Limits no_acceleration = plan::ShareLimits{}({0.1}, Limits{30, infinity, 10000});
  CHECK(std::isfinite(no_acceleration.acceleration));
  const Sums worst = sums({30, infinity, 10000}, {0.1}, no_acceleration.velocity,
                          no_acceleration.acceleration, -static_cast<long double>(no_acceleration.jerk));
  CHECK(static_cast<double>(worst.jerk) <= 1 + 1e-12);
}

TEST_CASE("shared limits in float are those of double") {
  const auto narrow = plan::ShareLimits{}({2.0f}, BasicLimits<float>{30.0f, 1000.0f, 10000.0f});
  const auto wide = plan::ShareLimits{}({2.0}, Limits{30, 1000, 10000});
  CHECK(narrow.velocity == Approx(wide.velocity).epsilon(1e-6));
  CHECK(narrow.acceleration == Approx(wide.acceleration).epsilon(1e-5));
  CHECK(narrow.jerk == Approx(wide.jerk).epsilon(1e-5));
}
