#include "cncplan/path/spiral.hpp"

#include <cmath>

#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace cncplan::path;

namespace {

/// Integral of sqrt(r^2 + m^2) in long double by the textbook antiderivative where it is well conditioned,
/// and by Gauss-Legendre panels elsewhere.
long double reference_length(const Spiral<double>& spiral, double angle) {
  using L = long double;
  const L m_sq = L(spiral.growth) * spiral.growth + L(spiral.rise) * spiral.rise;
  constexpr L node[] = {0.0L, 0.538469310105683091036314420700208805L,
                        0.906179845938663992797626878299392965L};
  constexpr L weight[] = {0.568888888888888888888888888888888889L, 0.478628670499366468041291514835638193L,
                          0.236926885056189087514264040719917363L};
  const auto speed = [&](L u) {
    const L r = L(spiral.radius) + L(spiral.growth) * u;
    return std::sqrt(r * r + m_sq);
  };
  // Panels shrink towards the small radius, where the speed bends most.
  constexpr int panels = 400;
  const bool shrinks = spiral.growth < 0;
  L sum = 0;
  L from = 0;
  for (int i = 1; i <= panels; ++i) {
    const L part = std::pow(L(i) / panels, 3);
    const L to = part * L(angle);
    const L half = (to - from) / 2;
    const auto at = [&](L x) { return speed(shrinks ? L(angle) - x : x); };
    L panel = weight[0] * at(from + half);
    for (int k = 1; k < 3; ++k)
      panel += weight[k] * (at(from + half * (1 - node[k])) + at(from + half * (1 + node[k])));
    sum += panel * half;
    from = to;
  }
  return sum;
}

Spiral<double> random_spiral(test::Random& random, double& angle) {
  const double r0 = random.log_uniform(1e-3, 1e3);
  angle = random.log_uniform(1e-3, 60);
  const double r1 = random.coin() ? r0 * (1 + random.uniform(-1, 1) * random.log_uniform(1e-12, 1e-1))
                                  : r0 * random.log_uniform(1e-3, 1e3);
  const double rise = random.coin() ? 0 : random.uniform(-1, 1) * r0 * random.log_uniform(1e-6, 1e2);
  return {r0, (r1 - r0) / angle, rise};
}

}  // namespace

TEST_CASE("Length of spirals agrees with integration to a few units in the last place") {
  test::Random random;
  double worst = 0;
  double worst_float = 0;
  double worst_angle = 0;
  Spiral<double> where{};
  for (int i = 0; i < 3000; ++i) {
    double angle = 0;
    const Spiral<double> spiral = random_spiral(random, angle);
    const long double exact = reference_length(spiral, angle);
    const double error = static_cast<double>(std::abs(length_at(spiral, angle) - exact) / exact);
    if (error > worst) {
      worst = error;
      where = spiral;
      worst_angle = angle;
    }
    const Spiral<float> small{static_cast<float>(spiral.radius), static_cast<float>(spiral.growth),
                              static_cast<float>(spiral.rise)};
    const Spiral<double> same{small.radius, small.growth, small.rise};
    const auto short_angle = static_cast<float>(angle);
    if (small.radius_at(short_angle) < small.radius * 1e-2f) continue;  // r0 + growth * angle itself cancels
    const long double exact_float = reference_length(same, short_angle);
    worst_float =
        std::max(worst_float,
                 static_cast<double>(std::abs(length_at(small, short_angle) - exact_float) / exact_float));
  }
  std::printf("spiral length: worst relative error %.2g (double), %.2g (float)\n", worst, worst_float);
  INFO("Spiral{" << where.radius << ", " << where.growth << ", " << where.rise << "}, angle " << worst_angle);
  CHECK(worst < 2e-15);
  CHECK(worst_float < 1e-6);
}

TEST_CASE("The length passes over growth 0 without a step") {
  for (const double rise : {0.0, 0.3}) {
    const double flat = length_at(Spiral<double>{10, 0, rise}, 2.0);
    for (double growth = 1e-3; growth > 1e-19; growth /= 10)
      for (const double k : {growth, -growth}) {
        const Spiral<double> spiral{10, k, rise};
        const double tilt = 2 * k * 10 / std::hypot(10, rise);  // d length / d growth * growth
        CHECK(std::abs(length_at(spiral, 2.0) - flat - tilt) < 2 * k * k + 1e-14);
      }
  }
}

TEST_CASE("angle_at inverts length_at within its steps") {
  test::Random random;
  double worst = 0;
  double worst_extreme = 0;
  for (int i = 0; i < 20000; ++i) {
    double angle = 0;
    Spiral<double> spiral = random_spiral(random, angle);
    const bool extreme = i % 2 == 1;
    if (extreme) {
      const double r1 = spiral.radius * random.log_uniform(1e-9, 1e9);
      spiral.growth = (r1 - spiral.radius) / angle;
      if (!(spiral.radius_at(angle) > 0)) continue;
    }
    const double end = length_at(spiral, angle);
    const double s = random.uniform(0, 1) * end;
    const double error = std::abs(length_at(spiral, angle_at(spiral, s, angle, end)) - s) / end;
    (extreme ? worst_extreme : worst) = std::max(extreme ? worst_extreme : worst, error);
  }
  CHECK(worst < 1e-15);
  CHECK(worst_extreme < 1e-15);
  CHECK(angle_at(Spiral<double>{1, 0.5, 0}, 0.0, 2.0, 3.0) == 0.0);
}

TEST_CASE("log1p_over joins its series without a step") {
  for (const double x : {1e-3, -1e-3, 9.999e-4, -9.999e-4, 1e-5, -1e-9, 1e-300}) {
    const long double exact = std::log1p(static_cast<long double>(x)) / x;
    CHECK(std::abs(log1p_over(x) - static_cast<double>(exact)) < 3e-16);
  }
  CHECK(log1p_over(0.0) == 1.0);
  CHECK(log1p_over(0.0f) == 1.0f);
}

TEST_CASE("Largest curvature bounds and touches what a dense scan sees") {
  test::Random random;
  double above = 0;
  double below = 0;
  int inside = 0;
  for (int i = 0; i < 2000; ++i) {
    const double r0 = random.log_uniform(0.1, 10);
    const double r1 = random.log_uniform(0.1, 10);
    const double angle = random.uniform(0.5, 60);
    const Spiral<double> spiral{r0, (r1 - r0) / angle, random.log_uniform(0.01, 10)};
    double seen = 0;
    for (int k = 0; k <= 1000; ++k)
      seen = std::max(seen, curvature_at_radius(spiral, spiral.radius_at(angle * k / 1000)));
    const double claimed = max_curvature(spiral, angle);
    above = std::max(above, seen / claimed - 1);
    below = std::max(below, 1 - seen / claimed);
    const double at_ends =
        std::max(curvature_at_radius(spiral, r0), curvature_at_radius(spiral, spiral.radius_at(angle)));
    if (claimed > at_ends * 1.001) ++inside;
  }
  CHECK(above < 1e-12);
  CHECK(below < 1e-3);
  CHECK(inside > 50);
}
