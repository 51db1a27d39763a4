// YO04's worked numbers, and timers against exact crossing on a straight move.
#include "cncplan/published/axis_timer.hpp"

#include "cncplan/step/crossing.hpp"
#include "step/doubles.hpp"
#include "support/catch.hpp"

using namespace cncplan;

static_assert(step::EdgeSource<published::AxisTimer<double>>);

TEST_CASE("the worked numbers of YO04") {
  const double ratio = 78.0 / 18.0 * 54.0 / 14.0;
  CHECK(ratio == Approx(16.714286).epsilon(1e-7));
  CHECK(published::geared_steps(48.0, ratio) == Approx(802.285714).epsilon(1e-8));
  CHECK(published::geared_steps(48.0, 16.71) == Approx(802.08).epsilon(1e-12));
  CHECK(published::drum_steps_per_unit(802.08, 94.5) == Approx(8.48762).epsilon(1e-6));  // printed: 8.487
  CHECK(published::chord_angle(1.0, 1.0) == Approx(std::acos(-1.0) / 3));
  CHECK(published::chords_per_circle(1.0, 1.0) == Approx(6.0));
  CHECK(published::move_time(100.0, 2000.0 / 60.0) == Approx(3.0));
}

TEMPLATE_TEST_CASE("a timer's edges are the exact crossings of a straight move of whole steps", "", float,
                   double) {
  using S = TestType;
  const auto timer = published::AxisTimer<S>::make(2, S(-10), S(4), S(5), S(1));
  REQUIRE(timer);
  CHECK(timer->steps() == -40);
  CHECK(timer->period() == S(0.125));
  auto edges = *timer;
  const test::Straight<S> line{S(0), S(-10)};
  const auto phases = test::steady(S(10), S(2));
  step::StepCursor cursor(line, step::PhaseClock(phases, S(1)), 0, S(4), 0);
  int count = 0;
  while (const auto edge = edges.next()) {
    const auto exact = cursor.next();
    REQUIRE(exact);
    CHECK(edge->axis == 2);
    CHECK(edge->direction == exact->direction);
    CHECK(edge->time == Approx(exact->time));
    ++count;
  }
  CHECK(count == 40);
  CHECK_FALSE(cursor.next());
}

TEST_CASE("an axis at rest has no timer, a move in no time is refused") {
  auto rest = published::AxisTimer<double>::make(0, 0.0, 100.0, 0.0);
  REQUIRE(rest);
  CHECK(rest->period() == INFINITY);
  CHECK_FALSE(rest->next());
  CHECK(published::AxisTimer<double>::make(0, 1.0, 100.0, 0.0).error() ==
        Error{ErrorCode::not_positive, "duration", 0.0, 0.0});
  CHECK(published::AxisTimer<double>::make(0, 1.0, 100.0, NAN).error().field == "duration");
}

TEST_CASE("a timer of more steps than can be counted is refused") {
  const double most = std::ldexp(1.0, 53);
  CHECK(published::AxisTimer<double>::make(0, 1e15, 1e5, 1.0).error() ==
        Error{ErrorCode::above_limit, "steps", 1e20, most});
  CHECK(published::AxisTimer<double>::make(0, -1e15, 1e5, 1.0).error().value == -1e20);
  CHECK(published::AxisTimer<double>::make(0, NAN, 100.0, 1.0).error().code == ErrorCode::not_finite);
  CHECK(published::AxisTimer<double>::make(0, 1.0, INFINITY, 1.0).error().field == "steps");
  CHECK(published::AxisTimer<float>::make(0, 1e20F, 1e5F, 1.0F).error().bound == most);
  CHECK(published::AxisTimer<double>::make(0, -most, 1.0, 1.0)->steps() == -(std::int64_t{1} << 53));
}
