#include "cncplan/published/plan_program.hpp"

#include <string>

#include "cncplan/junction/deviation.hpp"
#include "cncplan/junction/exact_stop.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

const Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};

}  // namespace

// From outside: `cncplan_simulate --plan block` of 2026-11-25, which put its plan together by itself.
TEST_CASE("a program is planned block by block", "[published]") {
  const auto program =
      read_text("G21 G90 F1200\nG1 X1\nX2\nX3 Y0.1\nG2 X6 Y0.1 I1.5\nG1 X20\nG4 P0.5\nX0 Y10\nM30\n", mill);
  const junction::Deviation policy{0.01};
  for (const auto& planned : {published::plan_program(program, mill, policy),
                              published::plan_program(program, mill, policy, profile::FivePhase{})}) {
    REQUIRE(planned);
    CHECK(planned->duration() == Approx(2.9952031312581022).epsilon(1e-12));
    REQUIRE(planned->words().size() == 1);
    CHECK(planned->words()[0].time == planned->duration());
    // No acceleration where a block ends.
    for (std::size_t i = 1; i < planned->blocks().size(); ++i)
      CHECK(planned->at(planned->start_time(i)).along.acceleration == Approx(0).margin(1e-6));
  }
  // At rest at each corner: L/v + v/a + a/j for each move that reaches its feed and full acceleration.
  const Machine<3> slow{.limits = {.velocity = 30, .acceleration = 100, .jerk = 1000}};
  const auto square = read_text("G1 X50 F1200\nX100\nY50\n", slow);
  const auto stops = published::plan_program(square, slow, junction::ExactStop{});
  REQUIRE(stops);
  CHECK(stops->duration() == Approx(3 * (50.0 / 20 + 20.0 / 100 + 0.1)));
  CHECK_FALSE(published::plan_program(read_text("Y\n", mill), mill, policy));
}
