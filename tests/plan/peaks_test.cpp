#include "cncplan/plan/peaks.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/plan/plan_blocks.hpp"
#include "cncplan/plan/plan_program.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

const Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};

}  // namespace

TEST_CASE("peaks are no lower than dense samples, and hardly higher") {
  const auto arc = path::arc_from_center(Vector3(20, 0, 0), Vector3(20, 0, 4), Vector3(20, 3, 0),
                                         Turn::counterclockwise, Plane::xy);
  REQUIRE(arc);
  const std::vector<Block<3>> blocks{{.path = path::Line<3>({0, 0, 0}, {20, 0, 0})},
                                     {.path = *arc},
                                     {.path = path::Line<3>({20, 0, 4}, {40, 0, 4}), .feed = 10}};
  const auto trajectory = plan_blocks(blocks, mill);
  REQUIRE(trajectory);
  const auto found = peaks(*trajectory);
  Vector3 velocity = Vector3::Zero(), acceleration = Vector3::Zero(), jerk = Vector3::Zero();
  double tool = 0;
  for (const auto& point : trajectory->samples(2e-5)) {
    velocity = velocity.cwiseMax(point.velocity.cwiseAbs());
    acceleration = acceleration.cwiseMax(point.acceleration.cwiseAbs());
    jerk = jerk.cwiseMax(point.jerk.cwiseAbs());
    tool = std::max(tool, point.jerk.norm());
  }
  for (int axis = 0; axis < 3; ++axis) {
    INFO("axis " << axis);
    CHECK(found.velocity[axis] >= velocity[axis] * (1 - 2e-5));
    CHECK(found.velocity[axis] <= velocity[axis] * (1 + 1e-3));
    CHECK(found.acceleration[axis] >= acceleration[axis] * (1 - 2e-5));
    CHECK(found.acceleration[axis] <= acceleration[axis] * (1 + 1e-3));
    CHECK(found.jerk[axis] >= jerk[axis] * (1 - 2e-5));
    CHECK(found.jerk[axis] <= jerk[axis] * (1 + 1e-2));
  }
  CHECK(found.tool.jerk >= tool * (1 - 2e-5));
  CHECK(found.tool.jerk <= 10000 * (1 + 1e-9));
}

TEST_CASE("peaks of a smoothed path are those inside cells, not of the cell beside") {
  constexpr std::string_view text = R"(G21 G90 G17
G1 X2.9768 Y-2.2540 Z0.3969
G1 X2.8339 Y-2.4709 Z-0.4981
G1 X3.1778 Y-2.4017 Z-1.0277
G3 X3.19556 Y-2.50895 Z-1.0277 I-0.23921 J-0.09481 F2202.7
M2)";
  for (const double jerk : {3000.0, 10000.0, 30000.0, 100000.0}) {
    const Machine<3> machine{.limits = {.velocity = 30, .acceleration = 1000, .jerk = jerk}};
    const auto trajectory = plan_text(text, machine, {.tolerance = 0.01});
    REQUIRE(trajectory);
    INFO("jerk " << jerk);
    CHECK(peaks(*trajectory).tool.jerk <= jerk * (1 + 1e-9));
  }
}

TEST_CASE("the jump of velocity at a corner is the speed there times the jump of direction") {
  const double angle = 0.4;
  const std::vector<Block<3>> blocks{
      {.path = path::Line<3>({0, 0, 0}, {20, 0, 0})},
      {.path = path::Line<3>({20, 0, 0}, {20 + 20 * std::cos(angle), 20 * std::sin(angle), 0})}};
  const auto trajectory = plan_blocks(blocks, mill, {.junction_deviation = 0.01});
  REQUIRE(trajectory);
  const double speed = trajectory->blocks()[1].entry;
  REQUIRE(speed > 1);
  const double jump = speed * std::max(std::sin(angle), 1 - std::cos(angle));
  CHECK(corner_velocity_step(*trajectory) == Approx(jump).epsilon(1e-9));
  CHECK(corner_velocity_step(*plan_blocks(blocks, mill, {.junction_deviation = 0})) == 0);  // a stop
}
