// Drive rules: each broken once, by a known amount, at a known time.
#include "cncplan/step/drive.hpp"

#include <cmath>

#include "support/catch.hpp"

using namespace cncplan;
using step::Drive;
using step::Edge;
using step::Violation;

namespace {

const Drive drive{.steps_per_unit = 400,
                  .high_time = 2e-6,
                  .low_time = 3e-6,
                  .direction_setup = 4e-6,
                  .direction_hold = 6e-6,
                  .max_rate = 100e3};

}  // namespace

TEST_CASE("a drive's data are refused by name") {
  CHECK(validate(Drive{}));
  CHECK(validate(drive));
  const auto code = [](auto change) {
    Drive d = drive;
    change(d);
    return validate(d).error();
  };
  CHECK(code([](Drive& d) { d.steps_per_unit = 0; }) ==
        Error{ErrorCode::not_positive, "steps per unit", 0, 0});
  CHECK(code([](Drive& d) { d.steps_per_unit = INFINITY; }).code == ErrorCode::not_finite);
  CHECK(code([](Drive& d) { d.high_time = -1; }) == Error{ErrorCode::negative, "pulse high time", -1, 0});
  CHECK(code([](Drive& d) { d.low_time = NAN; }).field == "pulse low time");
  CHECK(code([](Drive& d) { d.direction_setup = -1; }).field == "direction set-up time");
  CHECK(code([](Drive& d) { d.direction_hold = INFINITY; }).field == "direction hold time");
  CHECK(code([](Drive& d) { d.max_rate = 0; }).field == "maximum step rate");
  CHECK(code([](Drive& d) { d.backlash = -0.1; }).field == "backlash");
}

TEST_CASE("what a drive takes limits the axis' speed") {
  CHECK(step::max_step_rate(Drive{}) == INFINITY);
  CHECK(step::max_step_rate(drive) == 100e3);
  CHECK(step::max_speed(drive) == 250.0);
  Drive slow = drive;
  slow.low_time = 18e-6;
  CHECK(step::max_step_rate(slow) == Approx(50e3));
  slow.backlash = 0.0137;
  CHECK(step::backlash_steps(slow) == 5);
}

TEST_CASE("edges that keep the rules pass, the first that does not is named") {
  step::DriveCheck check(std::array{drive, Drive{}});
  REQUIRE(check.accept({0.0, 0, 1}));
  REQUIRE(check.accept({0.0, 1, 1}));
  REQUIRE(check.accept({1e-6, 1, -1}));  // the second drive asks for nothing
  REQUIRE(check.accept({10e-6, 0, 1}));
  REQUIRE(check.accept({20e-6, 0, -1}));  // hold 6 + set-up 4
  const auto rate = check.accept({29.9e-6, 0, -1});
  REQUIRE_FALSE(rate);
  CHECK(rate.error().axis == 0);
  CHECK(rate.error().time == 29.9e-6);
  CHECK(rate.error().error.code == ErrorCode::above_limit);
  CHECK(rate.error().error.field == "step rate");
  CHECK(rate.error().error.value == Approx(1 / 9.9e-6));
  CHECK(rate.error().error.bound == 100e3);
  CHECK(check.peak_rate(0) == Approx(1 / 9.9e-6));
}

TEST_CASE("pulse and direction times have their own names") {
  Drive any_rate = drive;
  any_rate.max_rate = INFINITY;
  const auto broken = [&](double gap, int direction) {
    step::DriveCheck check(std::array{any_rate});
    (void)check.accept({1.0, 0, 1});
    return check.accept({1.0 + gap, 0, direction});
  };
  CHECK(broken(5e-6, 1));
  CHECK(broken(4e-6, 1).error().error.field == "pulse high and low time");
  CHECK(broken(4e-6, 1).error().error.bound == Approx(5e-6));
  CHECK(broken(10e-6, -1));
  CHECK(broken(9e-6, -1).error().error.field == "direction hold and set-up time");
  CHECK(broken(9e-6, -1).error().error.value == Approx(9e-6).epsilon(1e-6));
  CHECK(broken(9e-6, -1).error().error.bound == Approx(10e-6));
}

TEST_CASE("backlash takes an edge more than its steps, each as long as pulse, rate and direction need") {
  Drive d = drive;
  CHECK(step::backlash_time(d) == 0.0);
  CHECK(step::hysteresis(d) == 1e-4);
  d.backlash = 0.0125;  // five steps
  CHECK(step::backlash_time(d) == Approx(6 * 10e-6));
  d.direction_setup = 20e-6;
  CHECK(step::backlash_time(d) == Approx(6 * 26e-6));
  CHECK(step::hysteresis(d) == 0.1);
}
