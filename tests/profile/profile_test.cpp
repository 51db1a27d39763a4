#include "cncplan/profile/profile.hpp"

#include <cmath>
#include <type_traits>

#include "cncplan/core/concepts.hpp"
#include "cncplan/profile/seven_phase.hpp"
#include "cncplan/published/constant_speed.hpp"
#include "support/catch.hpp"
#include "support/profile_oracle.hpp"

using namespace cncplan;

static_assert(Profile<profile::Profile>);
static_assert(Profile<profile::BasicProfile<float>>);
static_assert(std::is_trivially_copyable_v<profile::Profile>);

TEST_CASE("a profile is exact at its ends, and stays there outside") {
  const auto p = *profile::seven_phase(10.0, {3.0, 7.0}, Limits{30.0, 200.0, 10000.0});
  CHECK(p.at(0.0) == State{0.0, 3.0, 0.0, p.parts().up.jerk});
  CHECK(p.at(-1.0).position == 0.0);
  CHECK(p.at(p.duration()) == State{10.0, 7.0, 0.0, 0.0});
  CHECK(p.at(1e9).position == 10.0);
  CHECK(p.time_at(0.0) == 0.0);
  CHECK(p.time_at(10.0) == p.duration());
  CHECK(p.time_at(11.0) == p.duration());
  CHECK(p.velocity_at(0.0) == 3.0);
  CHECK(p.velocity_at(10.0) == 7.0);
  CHECK(p.velocity_at(11.0) == 7.0);
}

TEST_CASE("the default profile stands still for no time") {
  const profile::Profile p;
  CHECK(p.duration() == 0.0);
  CHECK(p.at(0.0) == State{});
  CHECK(p == profile::Profile());
}

TEST_CASE("random profiles: position grows with time, time_at is its inverse, derivatives and speeds fit") {
  test::Random random;
  double worst_inverse = 0.0, worst_back = 0.0, worst_slope = 0.0, worst_speed = 0.0;
  test::ProfileCase inverse_case{}, back_case{}, slope_case{}, speed_case{};
  for (int draw = 0; draw < 20000; ++draw) {
    const test::ProfileCase c = test::draw(random);
    const auto p = profile::seven_phase(c.length, c.speeds, c.limits);
    if (!p) continue;
    const double duration = p->duration();
    double last = 0.0;
    for (int k = 0; k <= 20; ++k) {
      const double t = duration * k / 20;
      const State state = p->at(t);
      const double back = (last - state.position) / c.length;
      last = state.position;
      if (back > worst_back) worst_back = back, back_case = c;
      // positions agree where times differ by the rounding of the position
      const double again = std::abs(p->at(p->time_at(state.position)).position - state.position) / c.length;
      if (again > worst_inverse) worst_inverse = again, inverse_case = c;
      // the square, as the root of a rounded position is left where the speed vanishes
      const double speed = p->velocity_at(state.position), scale = p->peak().velocity;
      const double square = std::abs(speed * speed - state.velocity * state.velocity) /
                            (scale * scale + p->peak().acceleration * c.length);
      if (square > worst_speed) worst_speed = square, speed_case = c;
      const double step = duration * 1e-5;
      if (t < step || t > duration - step) continue;
      const double slope = (p->at(t + step).position - p->at(t - step).position) / (2 * step);
      const double top = p->peak().velocity;
      const double off = std::abs(slope - state.velocity) / top - p->peak().jerk * step * step / top;
      if (off > worst_slope) worst_slope = off, slope_case = c;
    }
  }
  INFO(inverse_case.literal());
  CHECK(worst_inverse < 1e-14);
  INFO(back_case.literal());
  CHECK(worst_back < 1e-15);
  INFO(slope_case.literal());
  CHECK(worst_slope < 1e-9);
  INFO(speed_case.literal());
  CHECK(worst_speed < 1e-13);
}

TEST_CASE("constant speed is one cruise") {
  const auto p = published::constant_speed(12.0, 4.0);
  CHECK(p.duration() == 3.0);
  CHECK(p.at(1.5) == State{6.0, 4.0, 0.0, 0.0});
  CHECK(p.time_at(6.0) == Approx(1.5));
  CHECK(p.peak().acceleration == 0.0);
}
