#include "cncplan/published/planar_length.hpp"

#include <cmath>
#include <iterator>
#include <numbers>
#include <span>
#include <vector>

#include "cncplan/plan_program.hpp"
#include "cncplan/published/block_planning.hpp"
#include "cncplan/published/junction_table.hpp"
#include "support/catch.hpp"

using namespace cncplan;

TEST_CASE("helices planned by R theta keep Vmax in their plane", "[published]") {
  // KK22 Fig. 9 as it is reconstructed, and a line and a flat quarter behind it
  const Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  const auto whole = plan_text(
      "G03 X20 Y0 Z10 R10\nX0 Y0 Z20 R10\nX20 Y0 Z30 R10\nX0 Y0 Z40 R10\nX20 Y0 Z50 R10\nX0 Y0 Z60 R10\n"
      "G01 X-10\nG03 X-20 Y-10 R10\n",
      mill, {.tolerance = 0});
  REQUIRE(whole);
  const std::vector<ProgramBlock<Machine<3>>> blocks(whole->program().begin(), whole->program().end());
  const std::span<const ProgramBlock<Machine<3>>> all(blocks);
  const published::JunctionTable table;
  const detail::JunctionRules rules{table, -1.0, -1.0};
  auto cells = detail::make_cells<published::ToolLimits>(all, mill, rules).value();
  published::to_plane(all, cells);
  REQUIRE(cells.segment_limits.size() == 8);
  for (std::size_t i = 0; i < 6; ++i)
    CHECK(cells.segment_limits[i].length == Approx(10 * std::numbers::pi).epsilon(1e-14));
  CHECK(cells.segment_limits[6].length == 10);
  std::vector<double> speeds(cells.segment_limits.size() + 1);
  std::vector<detail::Span> spans;
  REQUIRE(published::plan_blocks(std::span<const detail::SegmentLimits>(cells.segment_limits),
                                 profile::FivePhase{}, std::span(speeds), std::back_inserter(spans)));
  auto phases = detail::block_phases(std::span<const detail::Span>(spans), cells);
  published::to_space(all, std::span(phases));
  const Trajectory<Machine<3>, ProgramBlock<Machine<3>>> planned(mill, {blocks.begin(), blocks.end()},
                                                                 std::move(phases));
  // the helices from rest to rest at constant speed, then the stop before the line (Table 3)
  const double ramp = 2 * std::sqrt(30.0 / 10000.0);
  const auto motions = planned.blocks();
  double helices = 0;
  for (std::size_t i = 0; i < 6; ++i) helices += motions[i].duration;
  CHECK(helices == Approx(60 * std::numbers::pi / 30 + ramp).epsilon(1e-12));
  // in space the helix is longer, and so faster
  const double share = std::hypot(10 * std::numbers::pi, 10.0) / (10 * std::numbers::pi);
  CHECK(motions[2].entry == Approx(30 * share).epsilon(1e-12));
  CHECK(motions[2].peak == Approx(30 * share).epsilon(1e-12));
  const auto middle = planned.at(helices / 2);
  CHECK(middle.velocity.head<2>().norm() == Approx(30).epsilon(1e-12));
  CHECK(middle.position.z() == Approx(30).epsilon(1e-9));
  CHECK((planned.at(planned.duration()).position - Vector3(-20, -10, 60)).norm() < 1e-9);
}
