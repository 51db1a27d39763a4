// The fastest motion of one axis: exact, within its limits, and no slower than any other.
#include <algorithm>
#include <cmath>
#include <string>

#include "cncplan/state/detail/axis_motions.hpp"
#include "cncplan/state/rest_to_rest.hpp"
#include "state/axis_case.hpp"
#include "state/switching_oracle.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using test::AxisCase;

namespace {

state::BasicMotion<double> fastest(const AxisCase& c) {
  const auto motions = state::axis_motions(c.from, c.to, c.limits);
  REQUIRE(motions);
  return motions->fastest();
}

}  // namespace

TEST_CASE("random motions end at their targets and keep their limits") {
  test::Random random;
  for (int n = 0; n < 300000; ++n) {
    const AxisCase c = test::draw_axis_case(random, random.integer(0, 4) == 0);
    const auto motions = state::axis_motions(c.from, c.to, c.limits);
    if (!motions) FAIL("refused: " << c.literal());
    const auto errors = test::examine(c, motions->fastest());
    if (errors.target() < 1e-11 && errors.limits() < 1e-12) continue;
    INFO(c.literal());
    CHECK(errors.target() < 1e-11);
    CHECK(errors.limits() < 1e-12);
  }
}

TEST_CASE("no motion of any switching pattern is faster") {
  test::Random random;
  int near = 0;
  constexpr int cases = 4000;
  for (int n = 0; n < cases; ++n) {
    const AxisCase c = test::draw_axis_case(random);
    const test::Real duration = fastest(c).duration();
    const test::Real found = test::SwitchingOracle(c).fastest();
    if (!(duration <= found * (1 + 1e-9L) + 1e-12L)) {
      INFO(c.literal());
      CHECK(static_cast<double>(duration) == static_cast<double>(found));
    }
    if (found <= duration * (1 + 1e-9L) + 1e-12L) ++near;
  }
  CHECK(near > cases * 0.99);  // or the search proves nothing
}

TEST_CASE("a move to where an axis stands takes no time") {
  const AxisLimits limits{30, 30, 300, 300, 10000};
  CHECK(fastest({{5, 0, 0}, {5, 0, 0}, limits}).duration() == 0);
  CHECK(fastest({{5, 10, 100}, {5, 10, 100}, limits}).duration() < 1e-15);
}

TEST_CASE("jerk alone that ends at the target is found where roundings are rooted") {
  // 0.5 + 3 - 1.5 = 2 and 0.5 + 1.5 - 0.5 = 1.5: the jerk of -3 for a second
  CHECK(fastest({{0, 0.5, 3}, {1.5, 2, 0}, {2, 2, 3, 3, 3}}).duration() == Approx(1).epsilon(1e-12));
  // of starts beyond the limits: -2 + 4 - 1.5 = 0.5, -2 + 2 - 0.5 = -0.5; -1.5 + 4 - 1.5 = 1, -1.5 + 2 - 0.5
  // = 0
  CHECK(fastest({{0, -2, 4}, {-0.5, 0.5, 1}, {1, 1, 2, 2, 3}}).duration() == Approx(1).epsilon(1e-12));
  CHECK(fastest({{0, -1.5, 4}, {0, 1, 1}, {2, 4, 2, 2, 3}}).duration() == Approx(1).epsilon(1e-12));
}

TEST_CASE("jerk alone that ends at the limit of the velocity is found, however the start is rounded") {
  test::Random random;
  int planned = 0;
  for (int n = 0; n < 100000; ++n) {
    AxisCase c = test::draw_axis_case(random);
    const double v = c.limits.velocity_up, j = c.limits.jerk;
    const double a = std::min(c.limits.acceleration_up, std::sqrt(2 * j * v)) * random.uniform(0.0, 1.0);
    const double before = v - a * a / (2 * j), time = a / j;
    if (before < 0) continue;
    c.from = {0, before, a};
    c.to = {time * (before + time * (a / 2 - time * j / 6)), v, 0};
    ++planned;
    const double late = fastest(c).duration() - time;
    if (late <= 1e-12 * time + 8 * std::sqrt(1e-16 * v / j)) continue;
    INFO(c.literal());
    CHECK(late == 0);
  }
  CHECK(planned > 50000);
}

TEST_CASE("a motion that just comes to the limit of the velocity is the one with a cruise, without it") {
  test::Random random;
  int compared = 0;
  for (int n = 0; n < 50000; ++n) {
    AxisCase c = test::draw_axis_case(random);
    const double v = c.limits.velocity_up, a = std::min(c.limits.acceleration_up, c.limits.acceleration_down);
    const auto near = [&](const AxisState& end, double sign) {
      return test::settled(end.velocity, sign * end.acceleration, c.limits.jerk) > 0.99 * v;
    };
    if (near(c.from, 1) || near(c.to, -1)) continue;  // then none is shorter: a rounding more is a detour
    c.to.position = 4 * v * (v / a + a / c.limits.jerk);
    const auto with_cruise = fastest(c);
    double cruise = 0;
    for (const auto& phase : with_cruise.phases())
      if (phase.acceleration == 0 && phase.jerk == 0) cruise = std::max(cruise, phase.duration);
    if (cruise == 0) continue;
    ++compared;
    c.to.position -= cruise * v;
    const double without = with_cruise.duration() - cruise;
    const double late = fastest(c).duration() - without;
    if (late <= 1e-7 * without) continue;
    INFO(c.literal());
    CHECK(late == 0);
  }
  CHECK(compared > 20000);
}

TEST_CASE("from rest to rest it is the known profile") {
  // J t^3 = 4 L / 8 for a quarter of the time
  const auto m = fastest({{0, 0, 0}, {1, 0, 0}, {1000, 1000, 1e6, 1e6, 10000}});
  CHECK(m.duration() == Approx(4 * std::cbrt(1.0 / 2 / 10000)).epsilon(1e-14));
}

TEST_CASE("rest to rest without a search is the motion that the search finds") {
  test::Random random;
  double slowest = 0, worst = 0;
  for (int n = 0; n < 100000; ++n) {
    AxisCase c = test::draw_axis_case(random);
    c.from = {}, c.to.velocity = c.to.acceleration = 0;
    c.limits.acceleration_down = c.limits.acceleration_up;
    if (!state::at_rest(c.from, c.to, c.limits)) continue;
    state::Motion direct;
    state::make_rest_to_rest(c.from, c.to, c.limits, direct);
    const auto errors = test::examine(c, direct);
    slowest = std::max(slowest, std::abs(direct.duration() / fastest(c).duration() - 1));
    worst = std::max({worst, errors.target(), errors.limits()});
  }
  CHECK(slowest < 1e-13);
  CHECK(worst < 1e-13);
}

TEST_CASE("motion goes back where that is the only way") {
  // 2 mm ahead at 10 mm/s cannot be stopped for in 0.01 mm
  const auto m = fastest({{0, 10, 0}, {0.01, 0, 0}, {30, 30, 300, 300, 10000}});
  CHECK(m.extrema().highest > 0.1);
  CHECK(m.at(m.duration()) == AxisState{0.01, 0, 0});
}

TEST_CASE("limits that differ between the directions bind in theirs") {
  const AxisCase c{{0, 0, 0}, {100, 0, 0}, {20, 5, 1000, 100, 1e6}};
  const auto there = fastest(c);
  const auto back = fastest({c.to, c.from, c.limits});
  CHECK(there.duration() == Approx(100.0 / 20 + 20.0 / 2 * (1.0 / 1000 + 1.0 / 100)).epsilon(1e-3));
  CHECK(back.duration() == Approx(100.0 / 5 + 5.0 / 2 * (1.0 / 1000 + 1.0 / 100)).epsilon(1e-3));
}

TEST_CASE("without a limit of acceleration, or of jerk") {
  constexpr double none = AxisLimits::infinity;
  const auto free = fastest({{0, 0, 0}, {100, 0, 0}, {30, 30, none, none, 10000}});
  CHECK(free.duration() == Approx(100.0 / 30 + 2 * std::sqrt(30.0 / 10000)).epsilon(1e-14));
  const auto sharp = fastest({{0, 0, 0}, {100, 0, 0}, {30, 30, 300, 300, none}});
  CHECK(sharp.duration() == Approx(100.0 / 30 + 30.0 / 300).epsilon(1e-14));
  const auto back = fastest({{0, 20, 0}, {-1, -3, 0}, {30, 30, 300, 300, none}});
  CHECK(back.at(back.duration()) == AxisState{-1, -3, 0});
  test::Random random;
  for (int n = 0; n < 20000; ++n) {
    AxisCase c = test::draw_axis_case(random);
    c.limits.jerk = none;
    c.from.acceleration = c.to.acceleration = 0;
    const auto errors = test::examine(c, fastest(c));
    if (errors.target() < 1e-11 && errors.limits() < 1e-12) continue;
    INFO(c.literal());
    CHECK(errors.target() < 1e-11);
    CHECK(errors.limits() < 1e-12);
  }
}

TEST_CASE("what cannot be planned is refused by name") {
  const AxisLimits limits{30, 20, 300, 200, 10000};
  const auto error = [](const AxisState& from, const AxisState& to, const AxisLimits& l) {
    const auto motions = state::axis_motions(from, to, l);
    REQUIRE_FALSE(motions);
    return motions.error();
  };
  CHECK(error({}, {1, 31, 0}, limits) == Error{ErrorCode::above_limit, "target velocity", 31, 30});
  CHECK(error({}, {1, -21, 0}, limits) == Error{ErrorCode::below_limit, "target velocity", -21, -20});
  CHECK(error({}, {1, 0, -201}, limits) == Error{ErrorCode::below_limit, "target acceleration", -201, -200});
  // to be at 29.9 with -200 it would have to come from 31.9
  CHECK(error({}, {1, 29.9, -200}, limits) ==
        Error{ErrorCode::above_limit, "target acceleration", 29.9 + 2, 30});
  CHECK(error({NAN, 0, 0}, {}, limits).field == "start");
  CHECK(error({}, {INFINITY, 0, 0}, limits).field == "target");
  CHECK(error({}, {}, {30, 30, 0, 300, 10000}).code == ErrorCode::not_positive);
  CHECK(error({}, {}, {AxisLimits::infinity, 30, 300, 300, 10000}).code == ErrorCode::not_finite);
  CHECK(error({}, {}, {30, 30}).field == "acceleration limit");
}

TEST_CASE("in float") {
  test::Random random;
  for (int n = 0; n < 100000; ++n) {
    AxisCase c = test::draw_axis_case(random);
    const auto to_float = [](double x) { return static_cast<double>(static_cast<float>(x)); };
    for (double* x : {&c.from.velocity, &c.from.acceleration, &c.to.position, &c.to.velocity,
                      &c.to.acceleration, &c.limits.velocity_up, &c.limits.velocity_down,
                      &c.limits.acceleration_up, &c.limits.acceleration_down, &c.limits.jerk})
      *x = to_float(*x);
    const auto f = [](double x) { return static_cast<float>(x); };
    const auto& l = c.limits;
    const auto motions = state::axis_motions<float>(
        {0, f(c.from.velocity), f(c.from.acceleration)},
        {f(c.to.position), f(c.to.velocity), f(c.to.acceleration)},
        {f(l.velocity_up), f(l.velocity_down), f(l.acceleration_up), f(l.acceleration_down), f(l.jerk)});
    INFO(c.literal());
    if (!motions) FAIL("refused");
    const auto errors = test::examine(c, motions->fastest());
    if (errors.target() < 2e-4 && errors.limits() < 1e-4) continue;
    CHECK(errors.target() < 2e-4);
    CHECK(errors.limits() < 1e-4);
  }
}
