// Maps of any shape: more joints than coordinates, fewer, other letters; what a map that is none is told.
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "support/catch.hpp"
#include "support/plan_exactly.hpp"

using namespace cncplan;

namespace {

// A palletising robot, whose wrist keeps the tool upright.
struct Palletizer {
  using Scalar = double;
  static constexpr int axis_count = 4;
  double upper = 700, fore = 600;

  template <class T>
  [[nodiscard]] std::array<T, 4> joints(const std::array<T, 3>& point) const {
    using std::atan2, std::sqrt;
    const auto& [x, y, z] = point;
    const T reach = sqrt(x * x + y * y);
    const T cosine = (reach * reach + z * z - T(upper * upper + fore * fore)) / T(2 * upper * fore);
    const T sine = -sqrt(T(1) - cosine * cosine);
    const T elbow = atan2(sine, cosine);
    const T shoulder = atan2(z, reach) - atan2(T(fore) * sine, T(upper) + T(fore) * cosine);
    return {atan2(y, x), shoulder, elbow, -shoulder - elbow};
  }
  [[nodiscard]] Vector3 tip(const VectorN<double, 4>& q) const {
    const double reach = upper * std::cos(q[1]) + fore * std::cos(q[1] + q[2]);
    return {reach * std::cos(q[0]), reach * std::sin(q[0]),
            upper * std::sin(q[1]) + fore * std::sin(q[1] + q[2])};
  }
};

MappedMachine<Palletizer> robot() {
  return {
      .map = {},
      .axes = {{{.letter = 'A', .kind = AxisKind::rotary, .velocity = 2, .acceleration = 10, .jerk = 100},
                {.letter = 'B', .kind = AxisKind::rotary, .velocity = 2, .acceleration = 10, .jerk = 100},
                {.letter = 'C', .kind = AxisKind::rotary, .velocity = 3, .acceleration = 15, .jerk = 150},
                {.letter = 'U', .kind = AxisKind::rotary, .velocity = 5, .acceleration = 30, .jerk = 300}}},
      .limits = {.velocity = 500, .acceleration = 4000, .jerk = 80000}};
}

// A slide with a gantry of two motors: two coordinates, written Y before X, to three joints.
struct Gantry {
  using Scalar = double;
  static constexpr int axis_count = 3;
  static constexpr std::string_view coordinates = "YX";
  template <class T>
  [[nodiscard]] std::array<T, 3> joints(const std::array<T, 2>& point) const {
    return {point[0], point[0], T(2) * point[1]};
  }
};

double past(const VectorN<double, 4>& value, const std::array<double, 4>& limit) {
  double worst = 0;
  for (int i = 0; i < 4; ++i)
    worst = std::max(worst, std::abs(value[i]) / limit[static_cast<std::size_t>(i)]);
  return worst;
}

}  // namespace

TEST_CASE("a map of three coordinates to four joints plans feeds and rapids", "[maps]") {
  const auto machine = robot();
  const auto trajectory = test::plan_exactly(
      "G21 G90 F24000\nG1 X900 Y0 Z200\nG1 X700 Y400 Z200\nG3 X500 Y600 I-200 J0\nG0 X800 Y-200 Z50\n"
      "G1 Z-100\nM30\n",
      machine, {.start = {900, -300, 100}});
  REQUIRE(trajectory);
  double tip = 0, speed = 0, acceleration = 0, jerk = 0, off = 0, straight = 0, feed = 0;
  VectorN<double, 4> from = VectorN<double, 4>::Zero(), to = from;
  for (const auto& block : trajectory->program())
    if (block.rapid) from = block.path.start(), to = block.path.end();
  for (const auto& point : trajectory->samples(0.002)) {
    tip = std::max(tip, (machine.map.tip(point.position) - point.tool).norm());
    off = std::max(off, std::abs(point.position[1] + point.position[2] + point.position[3]));
    speed = std::max(speed, past(point.velocity, {2, 2, 3, 5}));
    acceleration = std::max(acceleration, past(point.acceleration, {10, 10, 15, 30}));
    jerk = std::max(jerk, past(point.jerk, {100, 100, 150, 300}));
    if (point.line == 2) {
      const Vector3 a(900, -300, 100), b(900, 0, 200);
      const Vector3 way = (b - a).normalized(), gap = point.tool - a;
      straight = std::max(straight, (gap - way.dot(gap) * way).norm());
      feed = std::max(feed, point.along.velocity);
    }
    if (point.line == 5) {
      const VectorN<double, 4> way = (to - from).normalized(), gap = point.position - from;
      straight = std::max(straight, (gap - way.dot(gap) * way).norm());
    }
  }
  CHECK(tip < 1e-9);
  CHECK(off < 1e-12);
  CHECK(straight < 1e-9);
  CHECK(speed < 1 + 1e-9);
  CHECK(acceleration < 1 + 1e-9);
  CHECK(jerk < 1 + 1e-9);
  CHECK(feed > 300);
  CHECK(feed <= 400 * (1 + 1e-12));
}

TEST_CASE("a map names its coordinates, in any order", "[maps]") {
  const MappedMachine<Gantry> machine{.axes = {{{.letter = 'Y'}, {.letter = 'V'}, {.letter = 'X'}}},
                                      .limits = {.velocity = 100, .acceleration = 1000, .jerk = 20000}};
  const auto trajectory = test::plan_exactly("G1 X30 Y40 F3000\nG0 X0 Y80\n", machine);
  REQUIRE(trajectory);
  double worst = 0, fastest = 0;
  for (const auto& point : trajectory->samples(0.001)) {
    const auto& q = point.position;
    worst = std::max(worst, (point.tool - Vector3(q[2] / 2, q[0], 0)).norm() + std::abs(q[0] - q[1]));
    if (point.line == 1) fastest = std::max(fastest, point.along.velocity);
  }
  CHECK(worst < 1e-9);
  CHECK(fastest == Approx(50));
  const auto unknown = read_text("G1 X3 Z4 F600\n", machine);  // Z is a letter, but no coordinate
  CHECK(!unknown.problems().empty());
}
