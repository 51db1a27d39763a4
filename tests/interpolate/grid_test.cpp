#include "cncplan/interpolate/grid.hpp"

#include <cstdint>
#include <limits>

#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using interpolate::BasicGrid;

TEMPLATE_TEST_CASE("Instants are multiples of the period before the end, and the end", "", float, double) {
  const BasicGrid<TestType> grid{TestType(0.25), TestType(1.1)};
  REQUIRE(grid.size() == 6);
  for (int k = 0; k < 5; ++k) {
    CHECK(grid.time(k) == TestType(0.25) * TestType(k));
    CHECK_FALSE(grid.is_last(k));
  }
  CHECK(grid.time(5) == TestType(1.1));
  CHECK(grid.is_last(5));
}

TEST_CASE("An end on the grid is one instant, and a motion of no time has one") {
  CHECK(BasicGrid<double>{0.25, 1.0}.size() == 5);
  CHECK(BasicGrid<double>{0.25, 0.0}.size() == 1);
  CHECK(BasicGrid<double>{0.001, 0.0}.time(0) == 0.0);
}

TEMPLATE_TEST_CASE("The first instant at or after a time is found whatever rounding does", "", float,
                   double) {
  test::Random random;
  const double most = sizeof(TestType) == 4 ? 1e5 : 1e9;
  bool right = true;
  for (int i = 0; i < 100000 && right; ++i) {
    const auto period = static_cast<TestType>(random.log_uniform(1e-5, 1e-1));
    const auto k = static_cast<std::int64_t>(random.log_uniform(1, most));
    auto t = static_cast<TestType>(k) * period;
    if (random.coin()) t = std::nextafter(t, random.coin() ? TestType(0) : TestType(1e30));
    const std::int64_t found = BasicGrid<TestType>{period, t}.first_at(t);
    CAPTURE(period, k, t, found);
    right = static_cast<TestType>(found) * period >= t && static_cast<TestType>(found - 1) * period < t;
    if (!right) CHECK(right);
  }
  CHECK(right);
}

TEMPLATE_TEST_CASE("A period that is none leaves the last instant alone", "", float, double) {
  using S = TestType;
  constexpr S infinity = std::numeric_limits<S>::infinity();
  for (const S period : {S(0), S(-0.0), S(-1e-3), -infinity, infinity, std::numeric_limits<S>::quiet_NaN()}) {
    const BasicGrid<S> grid{period, S(1.5)};
    CAPTURE(period);
    CHECK(grid.size() == 1);
    CHECK(grid.is_last(0));
    CHECK(grid.time(0) == S(1.5));
    CHECK(grid.first_at(S(1)) == 0);
  }
}

TEMPLATE_TEST_CASE("Counting ends where numbers are no longer told apart", "", float, double) {
  using S = TestType;
  constexpr auto most = std::int64_t{1} << std::numeric_limits<S>::digits;
  for (const S period : {std::numeric_limits<S>::denorm_min(), S(1e-30)}) {
    const std::int64_t size = BasicGrid<S>{period, S(1e10)}.size();
    CHECK(size >= most);
    CHECK(size <= most + 3);
  }
  CHECK(BasicGrid<S>{S(1), S(1)}.first_at(S(-1e30)) == 0);
  CHECK(BasicGrid<S>{S(1), S(1)}.first_at(std::numeric_limits<S>::quiet_NaN()) == 0);
}
