// A motion as a value: extrema, and the time at which a position is first reached, against dense samples.
#include "cncplan/state/motion.hpp"

#include <algorithm>
#include <cmath>

#include "cncplan/state/detail/axis_motions.hpp"
#include "state/axis_case.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

TEST_CASE("extrema and first times agree with samples") {
  test::Random random;
  constexpr int samples = 4000;
  for (int n = 0; n < 2000; ++n) {
    const test::AxisCase c = test::draw_axis_case(random);
    const auto m = state::axis_motions(c.from, c.to, c.limits)->fastest();
    const double duration = m.duration();
    const double step = duration / samples;
    const double fast = std::max(c.limits.velocity_up, c.limits.velocity_down);
    const auto [lowest, highest] = m.extrema();
    double low = c.from.position, high = c.from.position;
    for (int k = 0; k <= samples; ++k) {
      const double p = m.at(k * step).position;
      low = std::min(low, p), high = std::max(high, p);
    }
    INFO(c.literal());
    const double rounding = 1e-9 * (highest - lowest) + 1e-300;
    CHECK(lowest <= low + rounding);
    CHECK(highest >= high - rounding);
    CHECK(lowest >= low - fast * step);
    CHECK(highest <= high + fast * step);
    const double wanted = random.uniform(lowest, highest);
    const auto reached = m.time_at(wanted);
    REQUIRE(reached);
    CHECK(std::abs(m.at(*reached).position - wanted) <= rounding);
    const bool above = wanted > c.from.position;
    for (int k = 0; k * step < *reached * (1 - 1e-9); ++k) {
      const double p = m.at(k * step).position;
      if (above ? p > wanted + rounding : p < wanted - rounding) FAIL_CHECK("passed before, at " << k * step);
    }
    CHECK_FALSE(m.time_at(highest + 1 + std::abs(highest)));
    CHECK_FALSE(m.time_at(lowest - 1 - std::abs(lowest)));
  }
}

TEST_CASE("before its start and behind its end a motion has the states there, and goes on") {
  const auto m = state::axis_motions<double>({1, 2, 3}, {9, 4, 0}, {10, 10, 100, 100, 1000})->fastest();
  CHECK(m.at(-1) == AxisState{1, 2, 3});
  CHECK(m.at(m.duration()) == AxisState{9, 4, 0});
  CHECK(m.at(m.duration() + 0.5) == AxisState{11, 4, 0});
  CHECK(state::Motion{}.at(3) == AxisState{});
  CHECK(m.time_at(1) == 0.0);
}
