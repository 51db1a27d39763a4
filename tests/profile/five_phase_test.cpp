#include "cncplan/profile/five_phase.hpp"

#include <cmath>
#include <limits>

#include "support/catch.hpp"
#include "support/profile_oracle.hpp"

using namespace cncplan;

namespace {

constexpr Limits kk22{.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0};
constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("the ramp of the paper's limits") {
  const auto p = profile::five_phase(100.0, {0.0, 0.0}, kk22);
  REQUIRE(p);
  CHECK(p->parts().up.duration() == Approx(2 * std::sqrt(30.0 / 10000.0)).epsilon(1e-14));
  CHECK(p->phases()[3].position == Approx(1.6432).margin(5e-5));
  CHECK(p->peak().acceleration == Approx(547.72).margin(5e-3));
  CHECK(p->peak().velocity == Approx(30.0).epsilon(1e-14));
}

TEST_CASE("all five phases are those of Eq. 14") {
  const double length = 12.0, vs = 7.0, ve = 18.0, v = 30.0, j = 10000.0;
  const double th = std::sqrt((v - vs) / j), ty = std::sqrt((v - ve) / j);
  const double ts = (length - (vs + v) * th - (v + ve) * ty) / v;
  const auto p = profile::five_phase(length, {vs, ve}, kk22);
  REQUIRE(p);
  const auto table = p->phases();
  const double ends[] = {
      th, th, 2 * th, 2 * th + ts, 2 * th + ts + ty, 2 * th + ts + ty, 2 * th + ts + 2 * ty};
  const double jerks[] = {j, 0.0, -j, 0.0, -j, 0.0, j};
  for (std::size_t i = 0; i < table.size(); ++i) {
    CAPTURE(i);
    CHECK(table[i].time + table[i].duration == Approx(ends[i]).epsilon(1e-14));
    CHECK(table[i].jerk == Approx(jerks[i]).epsilon(1e-14));
  }
  CHECK(p->at(th / 2).velocity == Approx(vs + j * th * th / 8).epsilon(1e-14));
  CHECK(p->at(2 * th + ts + ty / 2).velocity == Approx(v - j * ty * ty / 8).epsilon(1e-14));
}

TEST_CASE("the four kinds of Fig. 5") {
  SECTION("all phases") { CHECK(profile::five_phase(10.0, {5.0, 5.0}, kk22)->parts().cruise > 0.1); }
  SECTION("no cruise: the top speed is lowered") {
    const auto p = profile::five_phase(1.0, {0.0, 5.0}, kk22);
    CHECK(p->parts().cruise < 1e-12);
    CHECK(p->top_velocity() > 5.0);
    CHECK(p->top_velocity() < 30.0);
  }
  SECTION("acceleration only, deceleration only") {
    const double ramp = (3.0 + 8.0) * std::sqrt(5.0 / 10000.0);
    const auto up = profile::five_phase(ramp, {3.0, 8.0}, kk22);
    const auto down = profile::five_phase(ramp, {8.0, 3.0}, kk22);
    REQUIRE(up);
    REQUIRE(down);
    CHECK(up->duration() == Approx(2 * std::sqrt(5.0 / 10000.0)).epsilon(1e-7));
    CHECK(down->duration() == Approx(up->duration()).epsilon(1e-14));
    CHECK(up->peak().velocity == Approx(8.0).epsilon(1e-7));
  }
}

TEST_CASE("a ramp that the acceleration limit binds keeps its shape at lower jerk") {
  const Limits bound{30.0, 200.0, 10000.0};
  const auto p = profile::five_phase(100.0, {0.0, 0.0}, bound);
  REQUIRE(p);
  CHECK(p->parts().up.jerk == Approx(200.0 * 200.0 / 30.0).epsilon(1e-14));
  CHECK(p->parts().up.hold == 0.0);
  CHECK(p->parts().up.duration() == Approx(2 * 30.0 / 200.0).epsilon(1e-14));
  CHECK(p->peak().acceleration == Approx(200.0).epsilon(1e-14));
}

TEST_CASE("no limit on acceleration or jerk means what it says") {
  const auto no_acceleration = profile::five_phase(100.0, {0.0, 0.0}, Limits{30.0, infinity, 10000.0});
  CHECK(*no_acceleration == *profile::five_phase(100.0, {0.0, 0.0}, Limits{30.0, 1e9, 10000.0}));
  const auto no_jerk = profile::five_phase(100.0, {0.0, 10.0}, Limits{30.0, 200.0, infinity});
  REQUIRE(no_jerk);
  CHECK(no_jerk->parts().up.duration() == Approx(0.3).epsilon(1e-14));  // triangles of the same peak
  CHECK(no_jerk->at(0.15).acceleration == Approx(200.0));
  CHECK(profile::five_phase(60.0, {10.0, 0.0}, Limits{30.0, infinity, infinity}).error() ==
        Error{ErrorCode::not_finite, "acceleration and jerk limit", infinity, 0.0});
}

TEST_CASE("what cannot be asked for is refused by name, value and bound") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto error = [](double length, profile::BoundarySpeeds speeds, const Limits& limits = kk22) {
    const auto p = profile::five_phase(length, speeds, limits);
    REQUIRE_FALSE(p);
    return p.error();
  };
  CHECK(error(-1.0, {0, 0}) == Error{ErrorCode::negative, "length", -1.0, 0.0});
  CHECK(error(nan, {0, 0}).code == ErrorCode::not_finite);
  CHECK(error(infinity, {0, 0}) == Error{ErrorCode::not_finite, "length", infinity, 0.0});
  CHECK(error(1.0, {-2.0, 0}) == Error{ErrorCode::negative, "start speed", -2.0, 0.0});
  CHECK(error(1.0, {0, 31.0}) == Error{ErrorCode::above_limit, "end speed", 31.0, 30.0});
  CHECK(error(1.0, {nan, 0}).field == "start speed");
  CHECK(error(1.0, {0, nan}).field == "end speed");
  CHECK(error(1.0, {0, 0}, {0.0, 1.0, 1.0}).field == "velocity limit");
  CHECK(error(1.0, {0, 0}, {1.0, nan, 1.0}).field == "acceleration limit");
  CHECK(error(0.0, {1.0, 2.0}).code == ErrorCode::end_speed_unreachable);
}

TEST_CASE("an end speed out of reach is refused with the nearest one within it") {
  const auto start = GENERATE(0.0, 1.0, 12.0, 30.0);
  const auto end = GENERATE(0.0, 2.0, 29.0, 30.0);
  const auto length = GENERATE(1e-6, 1e-3, 0.1, 0.6);
  for (const Limits& limits : {kk22, Limits{30.0, 100.0, 10000.0}}) {
    const auto p = profile::five_phase(length, {start, end}, limits);
    if (p) continue;
    CAPTURE(start, end, length, limits.acceleration);
    CHECK(p.error().code == ErrorCode::end_speed_unreachable);
    const double reachable = p.error().bound;
    CHECK(p.error().value == end);
    CHECK(profile::five_phase(length, {start, reachable}, limits));
    const double farther = reachable + (end - reachable) * 1e-6 + (end > start ? 1e-9 : -1e-9);
    CHECK(test::ramp_distance(start, farther, limits.acceleration, limits.jerk, false) > length);
  }
}

TEST_CASE("float profiles are those of double to float's digits") {
  const auto f = profile::five_phase(7.5f, {2.0f, 11.0f}, BasicLimits<float>{30.0f, 300.0f, 10000.0f});
  const auto d = profile::five_phase(7.5, {2.0, 11.0}, Limits{30.0, 300.0, 10000.0});
  REQUIRE(f);
  CHECK(f->duration() == Approx(d->duration()).epsilon(1e-6));
  CHECK(f->at(0.1f).position == Approx(d->at(0.1).position).epsilon(1e-5));
  CHECK(f->at(f->duration()).position == 7.5f);
}
