#include "cncplan/plan/caps.hpp"

#include <cmath>

#include "cncplan/junction/deviation.hpp"
#include "cncplan/junction/exact_stop.hpp"
#include "cncplan/path/arc_from_center.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

// Gives the junction's limits back, to see what policies are shown.
struct Shown {
  double BasicLimits<double>::*member;
  double speed_sq(const junction::Geometry& junction) const {
    return junction.limits.*member * (junction.limits.*member);
  }
};

plan::Block line(const Vector3& from, const Vector3& to, const Limits& limits) {
  return {path::Line<3>(from, to), limits, junction::Kind::line};
}

const plan::Block first = line({0, 0, 0}, {10, 0, 0}, {20, 500, 30000});
const plan::Block second = line({10, 0, 0}, {10, 5, 0}, {25, 800, 10000});

}  // namespace

TEST_CASE("a policy's speed that is negative or not a number is a stop") {
  struct Fixed {
    double value;
    double speed_sq(const junction::Geometry&) const { return value; }
  };
  const plan::Block block{path::Line<3>({0, 0, 0}, {10, 0, 0}), {30, 1000, 10000}, junction::Kind::line};
  for (const double value : {-1.0, std::numeric_limits<double>::quiet_NaN(), 0.0})
    CHECK(plan::caps(block, block, Fixed{value}, plan::ShareLimits{}).entry == 0.0);
  CHECK(plan::caps(block, block, Fixed{9.0}, plan::ShareLimits{}).entry == 3.0);
}

TEST_CASE("a junction is judged under the lower limits of both blocks") {
  const plan::CapSpeed rule;
  CHECK(plan::caps(first, second, Shown{&Limits::velocity}, rule).entry == 20.0);
  CHECK(plan::caps(first, second, Shown{&Limits::acceleration}, rule).entry == 500.0);
  CHECK(plan::caps(first, second, Shown{&Limits::jerk}, rule).entry == 10000.0);
  const double half = std::sqrt(0.5);
  CHECK(plan::caps(first, second, junction::Deviation{0.01}, rule).entry ==
        Approx(std::sqrt(5.0 * half / (1.0 - half))).epsilon(1e-14));
}

TEST_CASE("a block's caps are its length, its limits on its curve, and its pause") {
  plan::Block paused = second;
  paused.pause = 0.5;
  const auto caps = plan::caps(first, paused, junction::Deviation{0.01}, plan::ShareLimits{});
  CHECK(caps.length == 5.0);
  CHECK(caps.limits == second.limits);
  CHECK(caps.pause == 0.5);
  const auto arc = path::arc_from_center(Vector3(10, 0, 0), Vector3(11, 1, 0), Vector3(10, 1, 0),
                                         Turn::counterclockwise, Plane::xy);
  REQUIRE(arc);
  const plan::Block curve{*arc, {30, 1000, 10000}, junction::Kind::arc};
  const auto curved = plan::caps(first, curve, junction::Deviation{0.01}, plan::ShareLimits{});
  CHECK(curved.limits == plan::ShareLimits{}({1.0, 0.0, curve.segment.length()}, curve.limits));
  CHECK(std::isinf(curved.entry));  // the line runs into it tangentially
}

TEST_CASE("behind a stop, a pause, and at the start, motion begins at rest") {
  const plan::CapSpeed rule;
  const Shown fast{&Limits::velocity};
  plan::Block stopped = first;
  stopped.stop_at_end = true;
  plan::Block paused = first;
  paused.pause = 0.1;
  CHECK(plan::caps(stopped, second, fast, rule).entry == 0.0);
  CHECK(plan::caps(paused, second, fast, rule).entry == 0.0);
  CHECK(plan::caps(first, second, junction::ExactStop{}, rule).entry == 0.0);
  CHECK(plan::caps_from_rest(first, rule).entry == 0.0);
}
