#include "cncplan/path/detail/rotation.hpp"

#include <cmath>
#include <limits>

#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

TEMPLATE_TEST_CASE("Sine and versine are right to rounding, near whole turns as well", "", float, double) {
  using S = TestType;
  test::Random random;
  const long double eps = std::numeric_limits<S>::epsilon();
  long double sine = 0, versine = 0, small = 0;
  const double most = sizeof(S) == 4 ? 5e4 : 5e7;
  for (int i = 0; i < 300000; ++i) {
    S u = static_cast<S>(i % 3 == 0 ? random.uniform(0, 7) : random.log_uniform(1e-9, most));
    if (i % 3 == 1) u = static_cast<S>(std::round(u / S(0.78539816339744831)) * S(0.78539816339744831));
    const auto rotation = path::rotation(u);
    const long double x = u;
    const long double true_versine = 2 * std::sin(x / 2) * std::sin(x / 2);
    sine = std::max(sine, std::abs(rotation.sine - std::sin(x)));
    versine = std::max(versine, std::abs(rotation.versine - true_versine));
    if (u < S(1) && u > S(0))
      small = std::max(
          {small, std::abs(rotation.sine / std::sin(x) - 1), std::abs(rotation.versine / true_versine - 1)});
  }
  CHECK(static_cast<double>(sine / eps) < 7);
  CHECK(static_cast<double>(versine / eps) < 7);
  CHECK(static_cast<double>(small / eps) < 4);
}

TEST_CASE("Standing still is exact") {
  CHECK(path::rotation(0.0).sine == 0.0);
  CHECK(path::rotation(0.0).versine == 0.0);
}
