// Whole runs of a motion executor without requests against the plan of the whole, within a tolerance, where
// cells are short.
#include "../../../apps/simulate/simulate_motion.hpp"

#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "../../../apps/generate/programs.hpp"
#include "cncplan/plan_blocks.hpp"
#include "cncplan/plan_program.hpp"
#include "support/catch.hpp"
#include "support/shared.hpp"

using namespace cncplan;

namespace {

constexpr Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
using Block = ProgramBlock<Machine<3>>;

std::string first_lines(std::istream& program, int count) {
  std::string text, line;
  for (int i = 0; i < count && std::getline(program, line); ++i) text += line + '\n';
  return text;
}

// Seconds as planned, then as played.
std::pair<double, double> durations(const std::string& text, double tolerance) {
  const auto exact = plan_text(text, mill, {.tolerance = 0});
  REQUIRE(exact);
  std::vector<Block> blocks(exact->program().begin(), exact->program().end());
  merge_lines(std::span(blocks), mill, detail::SmoothingRules<double>{tolerance, 1e-3});
  const auto planned = plan_blocks(blocks, mill, {.tolerance = tolerance, .level = SmoothLevel::fast});
  REQUIRE(planned);
  const std::span<const Block> all(blocks);
  detail::BasicSmoothing<double, 3> smoothing;
  if (tolerance > 0)
    smoothing = detail::smoothing(all, mill, detail::SmoothingRules<double>{tolerance, 1e-3});
  const junction::Deviation policy{0.01};
  const detail::JunctionRules rules{policy, 0.01, 1e-3};
  auto cells = detail::make_cells(all, mill, rules, smoothing);
  REQUIRE(cells);
  const auto of_blocks = simulate::motion_blocks(all, *cells, [](const Block& block) {
    return block.rapid ? rapid_speed(mill) : std::isfinite(block.feed) ? block.feed : feed_speed(mill);
  });
  const auto played = simulate::simulate_motion(of_blocks, cells->blocks, {}, 1e-3);
  REQUIRE(played);
  const auto& last = played->back().phase;
  return {planned->duration(), last.time + last.duration};
}

}  // namespace

TEST_CASE("short blocks within a tolerance are played in the time that is planned", "[motion_executor]") {
  std::stringstream program;
  generate::write(program, generate::Kind::finishing);
  const std::string text = first_lines(program, 400);
  for (const double tolerance : {0.0, 0.01, 0.02}) {
    CAPTURE(tolerance);
    const auto [planned, played] = durations(text, tolerance);
    CHECK(played == Approx(planned).epsilon(1e-3));
  }
}

TEST_CASE("programs of others are played in the time that is planned", "[motion_executor][slow]") {
  const auto shared = test::shared();
  if (!shared) {
    WARN("SKIPPED: CNCPLAN_SHARED is not set");
    return;
  }
  for (const char* name : {"ball.nc", "ngc/3dtest.ngc", "ngc/51MeanderAve.ngc", "ngc/arcspiral.ngc",
                           "ngc/cds.ngc", "ngc/lathe_pawn.ngc", "ngc/test_12mmflat.ngc", "ngc/tort.ngc"}) {
    CAPTURE(name);
    std::ifstream file(*shared + "/data/" + name);
    const auto [planned, played] = durations(first_lines(file, 700), 0.01);
    CHECK(played < planned * (1 + 1e-3));
    // The last way down may begin where the plan has no junction, and go past a steady one of the plan.
    CHECK(played > planned * (1 - 2e-3));
  }
}
