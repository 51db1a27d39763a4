#include "cncplan/kinematics/polar.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "cncplan/path/mapped.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace cncplan::kinematics;

static_assert(path::Map<PolarMap> && path::Map<BasicPolarMap<float>>);

namespace {
constexpr double pi = std::numbers::pi;
}

TEST_CASE("polar joints of known points", "[polar]") {
  const PolarMap map;
  const auto q = map.joints(std::array{3.0, 4.0, 5.0});
  CHECK(q[0] == 5);
  CHECK(q[1] == 5);
  CHECK(q[2] == Approx(std::atan2(4, 3)));
  CHECK(map.joints(std::array{-3.0, 0.0, 5.0})[2] == Approx(pi));
  CHECK(PolarMap{.center = {1, 2}}.joints(std::array{1.0, 5.0, 0.0})[0] == 3);
}

TEST_CASE("polar: a million points there and back", "[polar]") {
  test::Random random;
  double worst = 0;
  for (int i = 0; i < 1000000; ++i) {
    const std::array<double, 2> center{random.uniform(-50, 50), random.uniform(-50, 50)};
    const PolarMap map{.center = center};
    const double radius = random.log_uniform(1, 900), angle = random.uniform(-pi, pi);
    const std::array point{center[0] + radius * std::cos(angle), center[1] + radius * std::sin(angle),
                           random.uniform(0, 600)};
    const auto q = map.joints(point), back = map.point(q);
    worst = std::max({worst, std::abs(q[0] - radius) / 900,
                      radius * std::abs(std::remainder(q[2] - angle, 2 * pi)) / 900});
    for (std::size_t k = 0; k < 3; ++k) worst = std::max(worst, std::abs(back[k] - point[k]) / 900);
  }
  CHECK(worst < 1e-15);
}
