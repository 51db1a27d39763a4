// Whole programs through an executor, against their plans.
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>

#include "cncplan/block_reader.hpp"
#include "cncplan/executor.hpp"
#include "cncplan/plan_program.hpp"
#include "support/catch.hpp"
#include "support/shared.hpp"

using namespace cncplan;

namespace {

constexpr double period = 1e-3;
using Runner = Executor<Machine<3>, 256>;

}  // namespace

TEST_CASE("programs of others take as long as their plans", "[executor]") {
  const auto shared = test::shared();
  if (!shared) {
    std::puts("SKIPPED: CNCPLAN_SHARED is not set");
    return;
  }
  constexpr Machine<3> free{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  const double tolerance = GENERATE(0.0, 0.01);
  for (const char* name :
       {"ball.nc", "ngc/3dtest.ngc", "ngc/51MeanderAve.ngc", "ngc/Cereal.ngc", "ngc/arcspiral.ngc",
        "ngc/cds.ngc", "ngc/lathe_pawn.ngc", "ngc/test_12mmflat.ngc", "ngc/tort.ngc"}) {
    const std::string path = *shared + "/data/" + name;
    const auto planned = plan_file(path, free, {.tolerance = tolerance, .level = SmoothLevel::fast});
    REQUIRE(planned);
    std::ifstream file(path);
    BlockReader reader(free);
    const auto executor = std::make_unique<Runner>(free, Runner::Options{.tolerance = tolerance});
    executor->program_stop(false);
    int ticks = 0;
    const auto tick = [&] { return ++ticks, executor->tick(period); };
    for (std::string line; std::getline(file, line);) {
      const auto blocks = reader.read_line(line);
      REQUIRE(blocks);
      for (const auto& block : *blocks)
        while (!executor->push(block)) tick();
    }
    executor->end_of_program();
    while (!executor->finished()) tick();
    CAPTURE(name, tolerance);
    CHECK_FALSE(executor->error());
    CHECK(ticks * period - executor->rested() ==
          Approx(planned->duration()).epsilon(tolerance > 0 ? 1e-3 : 1e-4));
    CHECK((tick().position - planned->at(planned->duration()).position).norm() < 1e-9);
  }
}
