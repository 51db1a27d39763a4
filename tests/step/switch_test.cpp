#include "cncplan/step/switch.hpp"

#include "cncplan/step/backend.hpp"
#include "support/catch.hpp"

using namespace cncplan;
using step::SwitchInput;

TEST_CASE("a switch closes at its position and opens behind its differential") {
  for (const int direction : {1, -1}) {
    SwitchInput input({.position = 5.0 * direction, .direction = direction, .differential = 0.25}, 0.0);
    const auto at = [&](double place, double time) {
      input.follow(place * direction, time);
      return input.level(time);
    };
    CHECK_FALSE(input.level(0.0));
    CHECK_FALSE(at(4.99, 1.0));
    CHECK(at(5.0, 2.0));
    CHECK(at(7.0, 3.0));
    CHECK(at(4.75, 4.0));
    CHECK_FALSE(at(4.74, 5.0));
    CHECK_FALSE(at(4.99, 6.0));
  }
  CHECK(SwitchInput({.position = 5.0, .bounce_time = 1.0}, 6.0).level(0.0));  // closed for long
}

TEST_CASE("a contact bounces for its time, and ends at its new level") {
  SwitchInput input({.position = 1.0, .bounce_time = 0.0025, .bounce_period = 0.001}, 0.0);
  input.follow(1.0, 10.0);
  // by hand: half a millisecond each, the new level first
  for (const auto& [after, closed] : {std::pair{0.0, true},
                                      {0.0004, true},
                                      {0.0006, false},
                                      {0.0011, true},
                                      {0.0016, false},
                                      {0.0024, true},
                                      {0.0026, true},
                                      {1.0, true}})
    CHECK(input.level(10.0 + after) == closed);
  input.follow(0.5, 20.0);
  CHECK_FALSE(input.level(20.0001));
  CHECK(input.level(20.0007));
  CHECK_FALSE(input.level(20.003));
}

TEST_CASE("a switch follows the steps of a simulated axis") {
  step::SimulatedBackend<double, 1> backend(VectorN<double, 1>(10.0), {8});
  SwitchInput input({.position = 1.0}, backend.position()(0));
  for (const double time : {1.0, 2.0}) {
    CHECK_FALSE(input.level(time));
    REQUIRE(backend.accept({time, 0, 1}));
    input.follow(backend.position()(0), time);
  }
  CHECK(input.level(2.0));  // 0.8 and two steps of 0.1
}
