// Motions of a given duration: which durations are possible, and that the motion of one is exact.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "cncplan/state/detail/axis_motions.hpp"
#include "state/axis_case.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using test::AxisCase;
using test::Real;

namespace {

// The farthest that random motions get in a duration, upwards and downwards: three corners of the
// acceleration at full jerk, two of the times at them by the end's velocity and the duration.
struct Reach {
  Real low = std::numeric_limits<Real>::infinity();
  Real high = -std::numeric_limits<Real>::infinity();
};

Reach random_reach(const AxisCase& c, Real duration, test::Random& random) {
  struct Choice {
    std::array<Real, 3> height;
    Real first_time;
  };
  const AxisLimits& l = c.limits;
  Reach reach;
  std::array<Choice, 2> best{};
  const auto end = [&](const Choice& choice) {
    // times at the corners: their sum, and their sum weighted by heights
    std::array<Real, 5> corner{c.from.acceleration, choice.height[0], choice.height[1], choice.height[2],
                               c.to.acceleration};
    Real ramps = 0, gained = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      const Real step = std::abs(corner[i + 1] - corner[i]) / l.jerk;
      ramps += step;
      gained += step * (corner[i] + corner[i + 1]) / 2;
    }
    const Real time = duration - ramps - choice.first_time;
    const Real change = Real(c.to.velocity) - c.from.velocity - gained - choice.first_time * corner[1];
    const Real third = (change - time * corner[2]) / (corner[3] - corner[2]);
    const std::array<Real, 4> hold{choice.first_time, time - third, third, 0};
    if (!(third >= 0 && time - third >= 0)) return std::pair{Real(0), false};
    Real p = 0, v = c.from.velocity, a = corner[0];
    bool within = true;
    const auto run = [&](Real t, Real j) {
      if (j != 0 && -a / j > 0 && -a / j < t) {
        const Real extremum = v - a * a / (2 * j);
        within = within && extremum <= l.velocity_up && extremum >= -l.velocity_down;
      }
      p += t * (v + t * (a / 2 + t * j / 6));
      v += t * (a + t * j / 2);
      a += t * j;
      within = within && v <= l.velocity_up * (1 + 1e-12L) && v >= -l.velocity_down * (1 + 1e-12L);
    };
    for (std::size_t i = 0; i < 4; ++i) {
      run(std::abs(corner[i + 1] - corner[i]) / l.jerk, corner[i + 1] > corner[i] ? l.jerk : -l.jerk);
      a = corner[i + 1];
      run(hold[i], 0);
    }
    return std::pair{p, within};
  };
  const auto height = [&]() -> Real {
    switch (random.integer(0, 3)) {
      case 0:
        return l.acceleration_up;
      case 1:
        return -l.acceleration_down;
      default:
        return random.uniform(-l.acceleration_down, l.acceleration_up);
    }
  };
  for (int n = 0; n < 4000; ++n)
    for (std::size_t side = 0; side < 2; ++side) {
      Choice choice = best[side];
      const bool any = n < 1500 || !std::isfinite(side == 0 ? reach.low : reach.high);
      const double spread = std::pow(10.0, -1.0 - 4.0 * n / 4000.0);
      if (any) {
        choice = {{height(), height(), height()}, random.coin() ? 0 : duration * random.uniform(0, 1)};
      } else {
        for (Real& x : choice.height)
          if (random.coin())
            x = std::clamp<Real>(
                x + spread * random.uniform(-1, 1) * (l.acceleration_up + l.acceleration_down),
                -l.acceleration_down, l.acceleration_up);
        if (random.coin())
          choice.first_time =
              std::max<Real>(choice.first_time + duration * spread * random.uniform(-1, 1), 0);
      }
      const auto [p, within] = end(choice);
      if (!within) continue;
      if (p > reach.high) reach.high = p, best[1] = choice;
      if (p < reach.low) reach.low = p, best[0] = choice;
    }
  return reach;
}

}  // namespace

TEST_CASE("no random motion of a duration gets beyond its two extremes, and some come near") {
  test::Random random;
  int tried = 0, near = 0;
  for (int n = 0; n < 300; ++n) {
    AxisCase c = test::draw_axis_case(random);
    const auto first = state::axis_motions(c.from, c.to, c.limits);
    REQUIRE(first);
    const double duration = first->fastest().duration() * random.uniform(1.0, 2.0);
    if (first->duration_from(duration) != duration) continue;
    const Reach reach = random_reach(c, duration, random);
    if (!std::isfinite(reach.high)) continue;
    ++tried;
    // The extremes: the farthest targets for which the duration is possible, found by halving.
    const auto possible = [&](double position) {
      const auto motions =
          state::axis_motions<double>(c.from, {position, c.to.velocity, c.to.acceleration}, c.limits);
      return motions->duration_from(duration) == duration;
    };
    const double wide = duration * (c.limits.velocity_up + c.limits.velocity_down);
    double high = c.to.position, beyond = c.to.position + wide;
    double low = c.to.position, below = c.to.position - wide;
    for (int halving = 0; halving < 60; ++halving) {
      (possible((high + beyond) / 2) ? high : beyond) = (high + beyond) / 2;
      (possible((low + below) / 2) ? low : below) = (low + below) / 2;
    }
    INFO(c.literal() << " in " << duration);
    CHECK(static_cast<double>(reach.high) <= high + 1e-10 * wide);
    CHECK(static_cast<double>(reach.low) >= low - 1e-10 * wide);
    if (reach.high - reach.low > 0.9L * (high - low)) ++near;
  }
  CHECK(tried > 100);
  CHECK(near > tried / 2);
}

TEST_CASE("motions of random durations are exact") {
  test::Random random;
  int blocked = 0;
  for (int n = 0; n < 200000; ++n) {
    const AxisCase c = test::draw_axis_case(random, random.integer(0, 4) == 0);
    const auto motions = state::axis_motions(c.from, c.to, c.limits);
    if (!motions) FAIL("refused: " << c.literal());
    const double least = motions->fastest().duration() *
                         (random.coin() ? random.uniform(1.0, 1.5) : random.log_uniform(1.0, 20.0));
    const double duration = motions->duration_from(least);
    if (duration != least) ++blocked;
    const auto motion = motions->lasting(duration);
    const auto errors = test::examine(c, motion);
    if (duration >= least && std::isfinite(duration) && errors.target() < 1e-11 && errors.limits() < 1e-11 &&
        std::abs(motion.duration() - duration) <= 1e-12 * duration)
      continue;
    INFO(c.literal() << " in " << least);
    CHECK(duration >= least);
    CHECK(motion.duration() == Approx(duration).epsilon(1e-12));
    CHECK(errors.target() < 1e-11);
    CHECK(errors.limits() < 1e-11);
  }
  CHECK(blocked > 100);  // or the draw has none of them
}

TEST_CASE("a motion that just meets its target may not be possible in a little longer") {
  // Backwards at 1.5 mm/s, 2 mm to go, to be at 0.5: 2 s just do. In 3 s the axis is too far at any speed
  // that it may have; it has to go beyond and come back.
  const auto motions = state::axis_motions<double>({0, -1.5, 0}, {-2, -0.5, 0}, {3, 3, 1, 1, 1});
  REQUIRE(motions);
  CHECK(motions->fastest().duration() == Approx(2.0).epsilon(1e-14));
  CHECK(motions->duration_from(2.0) == 2.0);
  const double next = motions->duration_from(2.1);
  CHECK(next > 4.0);
  CHECK(motions->duration_from(next * (1 - 1e-9)) == Approx(next).epsilon(1e-12));
  CHECK(motions->duration_from(next * (1 + 1e-9)) == next * (1 + 1e-9));
}
