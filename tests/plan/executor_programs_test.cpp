// Whole programs through an executor, against their plans.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>

#include "cncplan/block_reader.hpp"
#include "cncplan/executor.hpp"
#include "cncplan/plan_program.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"
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

// What it takes beside: the rest before all blocks are cut, at most `longest_wait` and here some ticks.
TEST_CASE("random programs of some lines take as long as their plans", "[executor]") {
  constexpr Machine<3> free{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  test::Random random;
  for (int draw = 0; draw < 100; ++draw) {
    std::string text = "F1200\n";
    double x = 0, y = 0;
    const int lines = random.integer(3, 10);
    for (int i = 0; i < lines; ++i) {
      const double length = random.log_uniform(0.14, 12), angle = random.uniform(0, 6.28);
      x += length * std::cos(angle);
      y += length * std::sin(angle);
      char line[80];
      std::snprintf(line, sizeof line, "G1 X%.3f Y%.3f F%.0f\n", x, y, random.uniform(500, 2000));
      text += line;
    }
    if (draw == 0) text = "F1200\nG1 X0.869 Y-2.613 F1783\nX0.958 Y-3.716 F986\nX0.818 Y-3.985 F1245\n";
    INFO("seed " << test::seed() << ", draw " << draw << '\n' << text);
    const auto program = read_text(text, free);
    for (const double tolerance : {0.0, 0.01}) {
      CAPTURE(tolerance);
      const auto planned = plan_program(program, free, {.tolerance = tolerance, .level = SmoothLevel::fast});
      REQUIRE(planned);
      Runner executor(free, {.tolerance = tolerance});
      for (const auto& block : program.blocks()) REQUIRE(executor.push(block));
      executor.end_of_program();
      int ticks = 0;
      while (!executor.finished()) executor.tick(period), ++ticks;
      const double takes = ticks * period - executor.rested();
      CHECK(takes >= planned->duration() * 0.975);
      CHECK(takes <= planned->duration() * 1.025 + 0.015);
    }
  }
}
