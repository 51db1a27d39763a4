#include "cncplan/profile/seven_phase.hpp"

#include <cmath>
#include <limits>

#include "cncplan/profile/five_phase.hpp"
#include "support/catch.hpp"

using namespace cncplan;

TEST_CASE("seven phases are five where the acceleration limit does not bind") {
  const Limits limits{30.0, 1000.0, 10000.0};
  for (const double length : {0.01, 1.0, 50.0})
    CHECK(profile::seven_phase(length, {0.0, 0.0}, limits)->parts() ==
          profile::five_phase(length, {0.0, 0.0}, limits)->parts());
}

TEST_CASE("a ramp that the acceleration limit binds holds it at full jerk") {
  const auto p = profile::seven_phase(100.0, {0.0, 10.0}, Limits{30.0, 200.0, 10000.0});
  REQUIRE(p);
  const auto& up = p->parts().up;
  CHECK(up.first == Approx(0.02).epsilon(1e-14));
  CHECK(up.hold == Approx(30.0 / 200.0 - 0.02).epsilon(1e-13));
  CHECK(up.jerk == Approx(10000.0).epsilon(1e-14));
  CHECK(p->at(0.1).acceleration == Approx(200.0).epsilon(1e-14));
  CHECK(p->duration() < profile::five_phase(100.0, {0.0, 10.0}, Limits{30.0, 200.0, 10000.0})->duration());
  // mm, by the area of the trapezoids
  CHECK(p->phases()[3].position == Approx(15.0 * (0.15 + 0.02)).epsilon(1e-13));
}

TEST_CASE("without a jerk limit the acceleration steps") {
  const double infinity = std::numeric_limits<double>::infinity();
  const auto p = profile::seven_phase(100.0, {0.0, 0.0}, Limits{30.0, 200.0, infinity});
  REQUIRE(p);
  CHECK(p->duration() == Approx(100.0 / 30.0 + 30.0 / 200.0).epsilon(1e-14));
  CHECK(p->at(0.05).acceleration == 200.0);
  CHECK(p->at(0.05).velocity == Approx(10.0).epsilon(1e-14));
  const auto peak = profile::seven_phase(2.0, {0.0, 0.0}, Limits{30.0, 200.0, infinity});
  CHECK(peak->top_velocity() == Approx(20.0).epsilon(1e-14));
}

TEST_CASE("peaks on both sides of every regime have the length they should") {
  // acceleration limit bound on neither side, on the longer side, on both
  const Limits limits{1000.0, 200.0, 10000.0};  // binds above a change of 4 mm/s
  for (const double length : {0.3, 0.9, 1.2, 5.0, 300.0})
    for (const double end : {0.0, 1.0, 3.9, 4.1, 9.0}) {
      CAPTURE(length, end);
      const auto p = profile::seven_phase(length, {0.0, end}, limits);
      if (!p) continue;
      const auto& [up, down] = std::pair(p->parts().up, p->parts().down);
      const double top = p->top_velocity();
      const double covered = (0.0 + top) / 2 * up.duration() + (top + end) / 2 * down.duration();
      CHECK(covered == Approx(length).epsilon(1e-13));
      CHECK(p->parts().cruise == Approx(0.0).margin(1e-12));
    }
}
