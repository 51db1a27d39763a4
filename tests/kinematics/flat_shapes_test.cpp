// Maps of two coordinates, and to two joints.
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "support/catch.hpp"
#include "support/plan_exactly.hpp"

using namespace cncplan;

namespace {

// Two slides of which the shorter one is on the longer one: three coordinates to two joints.
struct Planar {
  using Scalar = double;
  static constexpr int axis_count = 2;
  template <class T>
  [[nodiscard]] std::array<T, 2> joints(const std::array<T, 3>& point) const {
    return {point[0] + point[1], point[0] - point[1]};
  }
};

// The same of two coordinates.
struct Turned {
  using Scalar = double;
  static constexpr int axis_count = 2;
  static constexpr std::string_view coordinates = "XY";
  template <class T>
  [[nodiscard]] std::array<T, 2> joints(const std::array<T, 2>& point) const {
    return {point[0] + point[1], point[0] - point[1]};
  }
};

}  // namespace

TEST_CASE("a map of two coordinates follows arcs", "[maps]") {
  const MappedMachine<Turned> machine{.axes = {{{.letter = 'U'}, {.letter = 'V'}}},
                                      .limits = {.velocity = 100, .acceleration = 1000, .jerk = 20000}};
  const auto trajectory = test::plan_exactly("G2 X20 Y20 R20 F1200\n", machine);
  REQUIRE(trajectory);
  double worst = 0;
  for (const auto& point : trajectory->samples(0.001)) {
    const auto& q = point.position;
    worst = std::max(worst, (point.tool - Vector3((q[0] + q[1]) / 2, (q[0] - q[1]) / 2, 0)).norm());
    worst = std::max(worst, std::abs((point.tool - Vector3(20, 0, 0)).norm() - 20));
  }
  CHECK(worst < 1e-9);
}

TEST_CASE("a map of three coordinates to two joints plans what the joints can do", "[maps]") {
  const MappedMachine<Planar> machine{.axes = {{{.letter = 'U'}, {.letter = 'V'}}},
                                      .limits = {.velocity = 100, .acceleration = 1000, .jerk = 20000}};
  const auto trajectory = test::plan_exactly("G1 X30 Y40 Z7 F3000\nG0 X0 Y80\n", machine);
  REQUIRE(trajectory);
  const auto end = trajectory->at(trajectory->duration());
  CHECK(end.position[0] == Approx(80));
  CHECK(end.position[1] == Approx(-80));
}
