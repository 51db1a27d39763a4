#include "cncplan/profile/from_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cncplan/profile/five_phase.hpp"
#include "cncplan/profile/seven_phase.hpp"
#include "profile/state_case.hpp"
#include "state/switching_oracle.hpp"
#include "support/catch.hpp"
#include "support/profile_oracle.hpp"

using namespace cncplan;

namespace {

using test::integrate;
using test::Real;
using test::StateCase;
using test::Travelled;

StateCase draw_state(test::Random& random) {
  StateCase c{};
  c.limits = {random.log_uniform(0.1, 1e4), random.log_uniform(1.0, 1e6), random.log_uniform(1.0, 1e9)};
  c.start.velocity = random.integer(0, 4) == 0 ? c.limits.velocity : random.uniform(0.0, c.limits.velocity);
  // accelerations that do not force the speed above its limit or below zero
  const double up = std::sqrt(2 * c.limits.jerk * (c.limits.velocity - c.start.velocity));
  const double down = std::sqrt(2 * c.limits.jerk * c.start.velocity);
  c.start.acceleration =
      random.uniform(-std::min(down, c.limits.acceleration), std::min(up, c.limits.acceleration));
  if (random.integer(0, 5) == 0) c.start.acceleration = 0.0;
  c.end = random.integer(0, 2) == 0 ? 0.0 : random.uniform(0.0, c.limits.velocity);
  const double scale = c.limits.velocity * (c.limits.velocity / c.limits.acceleration +
                                            std::sqrt(c.limits.velocity / c.limits.jerk));
  c.length = scale * random.log_uniform(1e-4, 10.0);
  return c;
}

}  // namespace

TEST_CASE("random stops come to rest within the limits, and no later than any other braking") {
  test::Random random;
  double worst_speed = 0.0, worst_excess = 0.0, worst_lowest = 0.0, worst_time = 0.0;
  std::string where;
  for (int n = 0; n < 100000; ++n) {
    const StateCase c = draw_state(random);
    const auto p = profile::stop(c.start, c.limits);
    INFO(c.literal());
    REQUIRE(p);
    const Travelled t = integrate(c.start, *p);
    const double v = c.limits.velocity;
    worst_speed = std::max(worst_speed, static_cast<double>(std::abs(t.velocity)) / v);
    worst_excess = std::max(worst_excess, static_cast<double>(t.steepest / c.limits.acceleration - 1));
    worst_lowest = std::max(worst_lowest, static_cast<double>(-t.lowest) / v);
    // the least time by bisection on the peak of the braking, with the same freedom: from -a to the limit
    const Real a0 = c.start.acceleration, j = c.limits.jerk;
    Real low = std::max<Real>(0, -a0), high = std::max<Real>(low, c.limits.acceleration);
    const auto lost = [&](Real peak) { return (peak * peak - a0 * a0) / (2 * j) + peak * peak / (2 * j); };
    if (lost(high) >= c.start.velocity)
      for (int halving = 0; halving < 120; ++halving) {
        const Real middle = (low + high) / 2;
        (lost(middle) <= c.start.velocity ? low : high) = middle;
      }
    const Real peak = high;
    const Real hold = std::max<Real>(0, (c.start.velocity - lost(peak)) / peak);
    const Real least = (peak + a0) / j + hold + peak / j;
    const double loss =
        static_cast<double>((t.duration - least) / (c.limits.velocity / c.limits.acceleration + least));
    if (loss > worst_time) worst_time = loss, where = c.literal();
  }
  CHECK(worst_speed < 1e-14);
  CHECK(worst_excess < 1e-12);
  CHECK(worst_lowest < 1e-14);
  INFO(where);
  CHECK(worst_time < 1e-9);
}

TEST_CASE("random moves from any state cover the length exactly within the limits") {
  test::Random random;
  double worst_position = 0.0, worst_speed = 0.0, worst_excess = 0.0, worst_highest = 0.0, worst_lowest = 0.0;
  std::string position_case, speed_case;
  int solved = 0;
  for (int n = 0; n < 200000; ++n) {
    const StateCase c = draw_state(random);
    const auto p = profile::from_state(c.length, c.start, c.end, c.limits);
    if (!p) {
      INFO(c.literal());
      REQUIRE(p.error().code == ErrorCode::end_speed_unreachable);
      continue;
    }
    ++solved;
    const Travelled t = integrate(c.start, *p);
    const double v = c.limits.velocity;
    const auto grow = [](double& worst, Real value) {
      const bool grew = static_cast<double>(value) > worst;
      if (grew) worst = static_cast<double>(value);
      return grew;
    };
    if (grow(worst_position, std::abs(t.position - c.length) / c.length)) position_case = c.literal();
    if (grow(worst_speed, std::abs(t.velocity - c.end) / v)) speed_case = c.literal();
    grow(worst_excess, t.steepest / c.limits.acceleration - 1);
    grow(worst_highest, t.highest / v - 1);
    grow(worst_lowest, -t.lowest / v);
  }
  CHECK(solved > 50000);
  INFO(position_case);
  CHECK(worst_position < 1e-12);
  INFO(speed_case);
  CHECK(worst_speed < 1e-12);
  CHECK(worst_excess < 1e-12);
  CHECK(worst_highest < 1e-12);
  CHECK(worst_lowest < 1e-12);
}

TEST_CASE("more jerk never takes longer") {
  test::Random random;
  int tried = 0;
  for (int n = 0; n < 3000; ++n) {
    StateCase c = draw_state(random);
    const auto p = profile::from_state(c.length, c.start, c.end, c.limits);
    if (!p) continue;
    Limits more = c.limits;
    more.jerk *= 1.0 + random.uniform(0.0, 0.5);
    const auto quicker = profile::from_state(c.length, c.start, c.end, more);
    INFO(c.literal());
    REQUIRE(quicker);
    CHECK(quicker->duration() <= p->duration() * (1 + 1e-7));
    ++tried;
  }
  CHECK(tried > 500);
}

TEST_CASE("from rest acceleration it is the seven-phase profile") {
  test::Random random;
  double worst = 0.0;
  test::ProfileCase where{};
  for (int n = 0; n < 20000; ++n) {
    test::ProfileCase c = test::draw(random);
    if (c.limits.velocity < 1e-2) continue;
    const auto p =
        profile::from_state(c.length, profile::StartState{c.speeds.start, 0.0}, c.speeds.end, c.limits);
    const auto q = profile::seven_phase(c.length, c.speeds, c.limits);
    if (!p || !q) continue;
    const double off = std::abs(p->duration() / q->duration() - 1);
    if (off > worst) worst = off, where = c;
  }
  INFO(where.literal());
  CHECK(worst < 1e-6);
}

TEST_CASE("states that cannot be are refused") {
  const Limits limits{30.0, 1000.0, 10000.0};
  CHECK(profile::stop({-1.0, 0.0}, limits).error() == Error{ErrorCode::negative, "start speed", -1.0, 0.0});
  CHECK(profile::stop({1.0, 2000.0}, limits).error().field == "start acceleration");
  const auto reverses = profile::stop({1.0, -500.0}, limits);  // 12.5 mm/s are lost before the brake is off
  REQUIRE_FALSE(reverses);
  CHECK(reverses.error() == Error{ErrorCode::below_limit, "start acceleration", -500.0, 1.0 - 12.5});
  CHECK(profile::from_state(1.0, {1.0, 0.0}, 31.0, limits).error().field == "end speed");
  CHECK(profile::from_state(-1.0, {1.0, 0.0}, 1.0, limits).error().field == "length");
}

TEST_CASE("an end that is too near names the speed that can be had there") {
  const Limits limits{30.0, 1000.0, 10000.0};
  const profile::StartState start{20.0, 100.0};
  const auto p = profile::from_state(0.5, start, 0.0, limits);
  REQUIRE_FALSE(p);
  CHECK(p.error().code == ErrorCode::end_speed_unreachable);
  CHECK(profile::from_state(0.5, start, p.error().bound * (1 + 1e-12), limits));
}

TEST_CASE("a start above the speed limit is brought down to it") {
  const auto p = profile::from_state(50.0, {40.0, 0.0}, 0.0, Limits{10.0, 1000.0, 10000.0});
  REQUIRE(p);
  CHECK(p->top_velocity() == 10.0);
  CHECK(p->parts().cruise > 1.0);
  CHECK(p->parts().up.acceleration < 0.0);
}

TEST_CASE("a start whose acceleration cannot end in time passes the speed limit, and the peak tells") {
  const Limits limits{30.0, 1000.0, 10000.0};
  const auto p = profile::from_state(20.0, {29.0, 300.0}, 0.0, limits);
  REQUIRE(p);
  CHECK(p->peak().velocity == Approx(29.0 + 300.0 * 300.0 / 20000.0).epsilon(1e-14));
}

TEST_CASE("what was once planned with a hole, too slow, or refused") {
  const auto covers = [](const StateCase& c, double at_most) {
    const auto p = profile::from_state(c.length, c.start, c.end, c.limits);
    INFO(c.literal());
    REQUIRE(p);
    const Travelled t = integrate(c.start, *p);
    CHECK(static_cast<double>(std::abs(t.position - c.length)) < 1e-13 * c.length);
    CHECK(static_cast<double>(std::abs(t.velocity - c.end)) < 1e-12);
    CHECK(p->duration() <= at_most);
  };
  const double any = std::numeric_limits<double>::infinity();
  covers(
      {3.0650236081596911, {37.277411254633826, -0.97428280148323054}, 24.675722858302137, {30, 300, 10000}},
      any);
  covers(
      {2.8048650123957648, {31.369841900898258, 102.10181401175032}, 0.095310610499423076, {30, 300, 10000}},
      0.1566);
  // the way there dips below its end speed
  covers({1.0573160135663617, {21.869718360860936, 0}, 2.2832549965231017, {30, 1000, 10000}}, any);
}

TEST_CASE("starts beyond the limits cover the length, and return as fast as they can") {
  test::Random random;
  int solved = 0;
  for (int n = 0; n < 200000; ++n) {
    StateCase c = draw_state(random);
    const double v = c.limits.velocity, a = c.limits.acceleration;
    c.start.velocity = v * random.uniform(0.0, 3.0);
    const double down = std::sqrt(2 * c.limits.jerk * c.start.velocity);
    c.start.acceleration =
        random.uniform(-std::min(down, 3 * a), std::min(3 * a, 3 * std::sqrt(c.limits.jerk * v)));
    c.length *= 3;
    const auto p = profile::from_state(c.length, c.start, c.end, c.limits);
    if (!p) continue;
    ++solved;
    const Travelled t = integrate(c.start, *p);
    const test::Real settled = profile::settled_speed(c.start, c.limits);
    const test::Real highest = std::max<test::Real>({v, c.start.velocity, settled});
    const test::Real steepest = std::max<test::Real>(a, std::abs(c.start.acceleration));
    const test::Real rounding = 1e-12L * highest + 64e-16L * steepest * t.duration;
    const bool kept = std::abs(t.position - c.length) <= 1e-12L * (c.length + highest * t.duration) &&
                      std::abs(t.velocity - c.end) <= rounding && t.highest <= highest + rounding &&
                      t.lowest >= -rounding && t.steepest <= steepest * (1 + 1e-12L);
    if (kept) continue;
    INFO(c.literal());
    CHECK(static_cast<double>(t.position) == c.length);
    CHECK(static_cast<double>(t.velocity) == c.end);
    CHECK(static_cast<double>(t.highest) <= static_cast<double>(highest));
    CHECK(static_cast<double>(t.lowest) >= 0.0);
    CHECK(static_cast<double>(t.steepest) <= static_cast<double>(steepest));
  }
  CHECK(solved > 50000);
}

TEST_CASE("no forward motion of any switching pattern is faster, and none exists where it refuses") {
  test::Random random;
  int refused = 0, near = 0, solved = 0;
  for (int n = 0; n < 4000; ++n) {
    const StateCase c = draw_state(random);
    const test::AxisCase axis{
        {0, c.start.velocity, c.start.acceleration},
        {c.length, c.end, 0},
        {c.limits.velocity, 0, c.limits.acceleration, c.limits.acceleration, c.limits.jerk}};
    const test::Real found = test::SwitchingOracle(axis).fastest();
    const auto p = profile::from_state(c.length, c.start, c.end, c.limits);
    INFO(c.literal());
    if (!p) {
      ++refused;
      CHECK_FALSE(std::isfinite(found));
      continue;
    }
    ++solved;
    if (!(p->duration() <= found * (1 + 1e-9L))) CHECK(p->duration() == static_cast<double>(found));
    if (found <= p->duration() * (1 + 1e-9L)) ++near;
  }
  CHECK(refused > 200);
  CHECK(near > solved * 0.99);
}

TEST_CASE("the bound of a refusal is the end speed that the length just allows") {
  test::Random random;
  int held = 0, free = 0;
  for (int n = 0; n < 100000; ++n) {
    const StateCase c = draw_state(random);
    const auto refused = profile::from_state(c.length, c.start, c.end, c.limits);
    if (refused) continue;
    const double bound = refused.error().bound, v = c.limits.velocity;
    const double settled = std::max(profile::settled_speed(c.start, c.limits), 0.0);
    if (bound > v || std::abs(bound - settled) < 1e-6 * v) continue;
    const auto p = profile::from_state(c.length * (1 + 1e-9), c.start, bound, c.limits);
    INFO(c.literal());
    REQUIRE(p);
    const auto ramp = profile::ramp_from(c.start, bound, c.limits);  // no room for anything else
    if (!(std::abs(p->duration() / ramp.duration() - 1) < 1e-3)) CHECK(p->duration() == ramp.duration());
    ++(ramp.hold > 0 ? held : free);
  }
  CHECK(std::min(held, free) > 1000);
}

TEST_CASE("slower end speeds than the bound of a refusal may be had") {
  const Limits limits{30.0, 1000.0, 10000.0};
  const double to_rest = profile::stop({20.0, 0.0}, limits)->length();
  const auto refused = profile::from_state(to_rest, {20.0, 0.0}, 20.0 / 3.0, limits);
  REQUIRE_FALSE(refused);
  CHECK(refused.error().bound > 20.0 / 3.0);
  CHECK(profile::from_state(to_rest, {20.0, 0.0}, 0.0, limits));
}

TEST_CASE("whole numbers may stand for scalars, and braces for all else") {
  const Limits limits{30.0, 1000.0, 10000.0};
  CHECK(*profile::from_state(5, {20.0, 300.0}, 0, limits) ==
        *profile::from_state(5.0, profile::StartState{20.0, 300.0}, 0.0, limits));
  CHECK(*profile::five_phase(5, {0, 0}, limits) == *profile::five_phase(5.0, {0.0, 0.0}, limits));
  CHECK(*profile::seven_phase(5, {0, 0}, {30, 1000, 10000}) ==
        *profile::seven_phase(5.0, {0.0, 0.0}, limits));
  CHECK(
      profile::from_state(5, profile::BasicStartState<float>{20, 300}, 0, BasicLimits<float>{30, 1000, 10000})
          ->length() == 5.0F);
}
