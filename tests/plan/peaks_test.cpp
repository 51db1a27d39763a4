#include "cncplan/peaks.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "cncplan/junction_jumps.hpp"
#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/plan_blocks.hpp"
#include "cncplan/plan_program.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

const Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};

template <int N>
using Most = Eigen::Array<double, 3 * N + 3, 1>;

// At many instants of every phase, its ends but for a billionth among them.
template <class T>
auto by_brute_force(const T& trajectory, int instants) {
  constexpr int n = T::MachineType::axis_count;
  const auto tool = tool_axes(trajectory.machine());
  Most<n> most = Most<n>::Zero();
  for (const auto& [phase, block] : trajectory.phases()) {
    const auto path = trajectory.path(block);
    if (!(phase.duration > 0 && path.length() > 0)) continue;
    for (int k = 0; k <= instants; ++k) {
      const double share = std::clamp(static_cast<double>(k) / instants, 1e-9, 1 - 1e-9);
      const State along = phase.at(share * phase.duration);
      const auto axes = motion(path.point_at(std::clamp(along.position, 0.0, path.length())), along);
      Most<n> here;
      here << axes.velocity, axes.acceleration, axes.jerk, in_space(axes.velocity, tool).norm(),
          in_space(axes.acceleration, tool).norm(), in_space(axes.jerk, tool).norm();
      most = most.max(here.abs());
    }
  }
  return most;
}

template <int N>
Most<N> in_one(const BasicPeaks<double, N>& peaks) {
  Most<N> all;
  all << peaks.velocity, peaks.acceleration, peaks.jerk, peaks.tool.velocity, peaks.tool.acceleration,
      peaks.tool.jerk;
  return all;
}

// Rings that climb a ball, of short lines.
std::string rings(int lines) {
  std::string text = "G21 G90 F1800\n";
  for (int i = 0; i < lines; ++i) {
    const double share = i / 36000.0, angle = i * 0.35, radius = 10 * std::sin(3 * share + 0.01);
    text += "G1 X" + std::to_string(radius * std::cos(angle)) + " Y" +
            std::to_string(radius * std::sin(angle)) + " Z" + std::to_string(10 * std::cos(3 * share)) + "\n";
  }
  return text;
}

}  // namespace

TEST_CASE("peaks of any path are no lower than brute force finds and are reached") {
  test::Random random;
  const auto number = [&](double low, double high) { return random.uniform(low, high); };
  const auto place = [&] {
    return " X" + std::to_string(number(-5, 5)) + " Y" + std::to_string(number(-5, 5)) + " Z" +
           std::to_string(number(-2, 2));
  };
  for (int round = 0; round < 12; ++round) {
    std::string text = "G21 G90 G17 F" + std::to_string(number(200, 4000)) + "\nG64 P" +
                       std::to_string(round % 4 == 0 ? 0.0 : number(0.001, 0.1)) + "\n";
    const int motions = 2 + static_cast<int>(number(0, 12));
    for (int i = 0; i < motions; ++i) {
      const double kind = number(0, 4);
      if (kind < 2)
        text += "G1" + place() + (kind < 1 ? " A" + std::to_string(number(-90, 90)) : "") + "\n";
      else if (kind < 3)
        text += "G2 I" + std::to_string(number(0.2, 8)) + " J" + std::to_string(number(-3, 3)) + " Z" +
                std::to_string(number(-2, 2)) + " P" + std::to_string(1 + static_cast<int>(number(0, 30))) +
                "\n";
      else
        text += "G5 I1 J2 P" + std::to_string(number(-4, 4)) + " Q3" + place().substr(0, place().find(" Z")) +
                "\n";
    }
    INFO(text);
    Machine<4> machine{.limits = {.velocity = 60, .acceleration = 1000, .jerk = number(5e3, 1e5)}};
    machine.axes[3] = {
        .letter = 'A', .kind = AxisKind::rotary, .velocity = 3, .acceleration = 30, .jerk = 500};
    const auto trajectory = plan_text(text, machine, {.tolerance = 0.01, .level = SmoothLevel::fast});
    REQUIRE(trajectory);
    const Most<4> found = in_one(peaks(*trajectory)), seen = by_brute_force(*trajectory, 2000);
    for (int i = 0; i < found.size(); ++i) {
      INFO("value " << i << ": " << found[i] << ", by brute force " << seen[i]);
      CHECK(found[i] >= seen[i] * (1 - 1e-6) - 1e-8);
      CHECK(found[i] <= seen[i] * (1 + 1e-3) + 1e-6);
    }
  }
}

TEST_CASE("the search for peaks takes a few looks at each phase, in short and in long programs") {
  for (const int lines : {500, 4000}) {
    const auto trajectory = plan_text(rings(lines), mill, {.tolerance = 0.01, .level = SmoothLevel::fast});
    REQUIRE(trajectory);
    detail::PeakSearch search(*trajectory);
    const auto found = search.search();
    CHECK(search.looks() <= 12 * trajectory->phases().size());
    const Most<3> all = in_one(found), seen = by_brute_force(*trajectory, 20);
    for (int i = 0; i < all.size(); ++i) {
      INFO("value " << i);
      CHECK(all[i] >= seen[i] * (1 - 1e-6) - 1e-8);
    }
  }
}

TEST_CASE("a thousand turns have the peaks of a hundred") {
  const auto trajectory = plan_text("F1800\nG2 I1 P1000\nG1 X1\n", mill, {.tolerance = 0});
  REQUIRE(trajectory);
  detail::PeakSearch search(*trajectory);
  const auto found = search.search();
  CHECK(search.looks() <= 1000 * trajectory->phases().size());
  const auto fewer = peaks(*plan_text("F1800\nG2 I1 P100\nG1 X1\n", mill, {.tolerance = 0}));
  CHECK(found.tool.velocity == Approx(fewer.tool.velocity).epsilon(1e-6));
  CHECK(found.tool.acceleration == Approx(fewer.tool.acceleration).epsilon(1e-6));
  CHECK(found.tool.jerk == Approx(fewer.tool.jerk).epsilon(1e-6));
}

TEST_CASE("peaks are no lower than dense samples, and hardly higher") {
  const auto arc = path::arc_from_center(Vector3(20, 0, 0), Vector3(20, 0, 4), Vector3(20, 3, 0),
                                         Turn::counterclockwise, Plane::xy);
  REQUIRE(arc);
  const std::vector<Block<3>> blocks{{.path = path::Line<3>({0, 0, 0}, {20, 0, 0})},
                                     {.path = *arc},
                                     {.path = path::Line<3>({20, 0, 4}, {40, 0, 4}), .feed = 10}};
  const auto trajectory = plan_blocks(blocks, mill, {.tolerance = 0});
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
    const auto trajectory = plan_text(text, machine, {.tolerance = 0.01, .level = SmoothLevel::fast});
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
  const auto trajectory = plan_blocks(blocks, mill, {.tolerance = 0, .junction_deviation = 0.01});
  REQUIRE(trajectory);
  const double speed = trajectory->blocks()[1].entry;
  REQUIRE(speed > 1);
  const double jump = speed * std::max(std::sin(angle), 1 - std::cos(angle));
  CHECK(corner_velocity_step(*trajectory) == Approx(jump).epsilon(1e-9));
  CHECK(corner_velocity_step(*plan_blocks(blocks, mill, {.tolerance = 0, .junction_deviation = 0})) ==
        0);  // a stop
}
