// Programs within a tolerance on machines behind a map: joints and tool by differences, distances by brute
// force.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iomanip>
#include <numbers>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "cncplan/junction/exact_stop.hpp"
#include "cncplan/kinematics/polar.hpp"
#include "cncplan/plan_blocks.hpp"
#include "cncplan/plan_program.hpp"
#include "maps/maps.hpp"
#include "plan/at_level.hpp"
#include "plan/mapped_motion.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace cncplan::test;

namespace {

using Table = MappedMachine<kinematics::ThreeJoints>;

// KK22's table: R, Z and C.
Table table() {
  Table machine;
  machine.map = kinematics::PolarMap{};
  machine.axes = {
      {{.letter = 'R', .velocity = 100, .acceleration = 500, .jerk = 5000},
       {.letter = 'Z', .velocity = 100, .acceleration = 500, .jerk = 5000},
       {.letter = 'C', .kind = AxisKind::rotary, .velocity = 1, .acceleration = 10, .jerk = 100}}};
  machine.limits = {.velocity = 150, .acceleration = 2000, .jerk = 20000};
  return machine;
}
Vector3 table_tip(const Vector3& q) { return {q[0] * std::cos(q[2]), q[0] * std::sin(q[2]), q[1]}; }

// Programmed points, arcs by many, of lines in the program's coordinates.
template <class Blocks>
Polyline programmed_tip(const Blocks& blocks) {
  Polyline result;
  for (const auto& block : blocks) {
    using Kind = std::variant_alternative_t<2, typename std::remove_cvref_t<decltype(block.path)>::Shape>;
    const int parts = block.path.template as<Kind>()->programmed().line() != nullptr ? 1 : 400;
    for (int i = 0; i <= parts; ++i)
      result.push_back(tool_point(block.path, block.path.length() * i / parts, {-1, -1, -1}).position);
  }
  return result;
}

// How far two directions are apart, rad.
double turn_between(const Vector3& a, const Vector3& b) {
  return 2 * std::atan2((a.normalized() - b.normalized()).norm(), (a.normalized() + b.normalized()).norm());
}

// A table that tilts by A about X and turns by C about Z; the program has the tip in the part and both
// angles.
struct TiltingTable {
  using Scalar = double;
  static constexpr int axis_count = 5;
  static constexpr std::string_view coordinates = "XYZAB";

  double z = -20, y = 5;  // of the tilting axis

  template <class T>
  [[nodiscard]] std::array<T, 5> joints(const std::array<T, 5>& p) const {
    using std::cos, std::sin;
    const T ca = cos(p[3]), sa = sin(p[3]), cc = cos(p[4]), sc = sin(p[4]);
    const T u = cc * p[0] - sc * p[1], v = sc * p[0] + cc * p[1] - T(y), w = p[2] - T(z);
    return {u, ca * v - sa * w + T(y), sa * v + ca * w + T(z), p[3], p[4]};
  }
  // The tip in the part, and the tool's direction there.
  [[nodiscard]] Vector3 tip(const VectorN<double, 5>& q) const {
    return turned_back(q, Vector3(q[0], q[1] - y, q[2] - z), Vector3(0, y, z));
  }
  [[nodiscard]] Vector3 direction(const VectorN<double, 5>& q) const {
    return turned_back(q, Vector3::UnitZ(), Vector3::Zero());
  }

 private:
  static Vector3 turned_back(const VectorN<double, 5>& q, const Vector3& p, const Vector3& centre) {
    const double ca = std::cos(q[3]), sa = std::sin(q[3]), cc = std::cos(q[4]), sc = std::sin(q[4]);
    const Vector3 tilted(p[0], ca * p[1] + sa * p[2], -sa * p[1] + ca * p[2]);
    const Vector3 part = tilted + centre;
    return {cc * part[0] + sc * part[1], -sc * part[0] + cc * part[1], part[2]};
  }
};

MappedMachine<TiltingTable> five_axes() {
  MappedMachine<TiltingTable> machine;
  machine.axes = {
      {{.letter = 'X', .velocity = 100, .acceleration = 1000, .jerk = 10000},
       {.letter = 'Y', .velocity = 100, .acceleration = 1000, .jerk = 10000},
       {.letter = 'Z', .velocity = 100, .acceleration = 1000, .jerk = 10000},
       {.letter = 'A', .kind = AxisKind::rotary, .velocity = 2, .acceleration = 20, .jerk = 200},
       {.letter = 'C', .kind = AxisKind::rotary, .velocity = 3, .acceleration = 30, .jerk = 300}}};
  machine.limits = {.velocity = 100, .acceleration = 2000, .jerk = 20000};
  return machine;
}

// Plans blocks and holds joints, tool and distances against what they may be.
template <class Blocks, class M, class Forward>
auto smooth_within(const Blocks& blocks, const M& machine, const Forward& tip, const PlanOptions& options,
                   SmoothLevel level) {
  const auto smooth = plan_blocks(blocks, machine, at_level(level, options));
  REQUIRE(smooth);
  const Used most = used_under_map(*smooth, machine, tip);
  CHECK(most.velocity <= 1 + 1e-9);
  CHECK(most.acceleration <= 1 + 1e-9);
  CHECK(most.jerk <= 1 + 1e-9);
  const Polyline path = programmed_tip(blocks), curve = tip_line(*smooth, tip, 1e-3);
  CHECK(farthest(curve, path) <= options.tolerance * (1 + 1e-6));
  CHECK(farthest(path, curve) <= options.tolerance * (1 + 1e-2));  // chords of the samples
  CHECK((curve.back() - path.back()).norm() < 1e-9);
  CHECK(smooth->completed());
  return std::pair(*smooth, most);
}

template <class M, class Forward>
void check(const std::string& text, const M& machine, const Forward& tip, const PlanOptions& options,
           SmoothLevel level) {
  INFO("level " << to_text(level) << "\n" << text);
  auto program = read_text(text, machine, options);
  REQUIRE_FALSE(program.failed());
  const auto blocks = std::move(program).take_blocks();
  const auto [smooth, most] = smooth_within(blocks, machine, tip, options, level);
  CHECK(smooth.fallbacks().empty());
  CHECK(std::max({most.velocity, most.acceleration, most.jerk}) > 0.97);
  const auto exact = plan_blocks(blocks, machine, {.tolerance = 0});
  const auto stops = plan_blocks(blocks, machine, junction::ExactStop{});
  REQUIRE(exact);
  REQUIRE(stops);
  CHECK(smooth.duration() < 1.03 * exact->duration());
  CHECK(smooth.duration() < stops->duration());
}

TEST_CASE("under a map: corners on a rotary table are driven round within tolerance and limits") {
  const std::string text =
      "F3000\nG1 X120 Y10 Z0\nX120 Y40\nX80 Y40\nX80 Y5\nX60 Y-20 Z5\nG3 X90 Y-20 I15 J0\nG1 X70 Y30\n";
  for (const SmoothLevel level : {SmoothLevel::fast, SmoothLevel::good, SmoothLevel::best})
    check(text, table(), table_tip, {.tolerance = 0.01, .start = {100, -10, 0}}, level);
}

TEST_CASE("under a map: the tool's point and its direction are smoothed, each within its tolerance") {
  const auto machine = five_axes();
  const std::string text =
      "F3000\nG1 X10 Y0 Z0 A10 B5\nX30 Y10 Z2 A20 B30\nX35 Y30 Z5 A15 B60\nX20 Y35 Z4 A-10 B50\n"
      "X0 Y20 Z0 A-20 B20\nX-10 Y0 Z-2 A0 B0\n";
  const PlanOptions options{.tolerance = 0.01, .rotary_tolerance = 5e-4};
  const auto tip = [&](const VectorN<double, 5>& q) { return machine.map.tip(q); };
  for (const SmoothLevel level : {SmoothLevel::good, SmoothLevel::best}) {
    check(text, machine, tip, options, level);
    // The direction of the tool, against that of the program at the place nearest to the tip.
    auto program = read_text(text, machine, options);
    const auto blocks = std::move(program).take_blocks();
    const auto smooth = plan_blocks(blocks, machine, at_level(level, options));
    REQUIRE(smooth);
    double most = 0;
    for (const auto& point : smooth->samples(2e-3)) {
      const Vector3 at = machine.map.tip(point.position), way = machine.map.direction(point.position);
      double least = 1e9;
      for (const auto& block : blocks)
        for (int i = 0; i <= 2000; ++i) {
          const VectorN<double, 5> q = block.path.position_at(block.path.length() * i / 2000.0);
          if ((machine.map.tip(q) - at).norm() < options.tolerance + 0.02)
            least = std::min(least, turn_between(machine.map.direction(q), way));
        }
      most = std::max(most, least);
    }
    CHECK(most <= options.rotary_tolerance);
    CHECK(most > 0.3 * options.rotary_tolerance);
  }
}

std::string line_to(const std::vector<double>& point, const char* letters) {
  std::ostringstream out;
  out << std::fixed << std::setprecision(6) << "G1";
  for (std::size_t i = 0; i < point.size(); ++i) out << ' ' << letters[i] << point[i];
  return out.str() + "\n";
}

TEST_CASE("under a map: random programs keep limits and tolerance") {
  Random random;
  double faster = 0, of_stops = 0;
  for (int run = 0; run < 12; ++run) {
    const auto level = run % 2 == 0 ? SmoothLevel::good : SmoothLevel::best;
    const double tolerance = random.log_uniform(0.003, 0.1), stride = random.log_uniform(0.3, 10);
    std::ostringstream feed;
    feed << "F" << random.log_uniform(300, 6000) << "\n";
    std::string text = feed.str();
    INFO(to_text(level) << ", tolerance " << tolerance);
    if (run % 3 == 0) {
      auto machine = five_axes();
      for (auto& axis : machine.axes) axis.jerk *= random.log_uniform(0.3, 10);
      std::vector<double> at{0, 0, 0, 0, 0};
      for (int i = 0; i < 12; ++i) {
        for (std::size_t k = 0; k < 3; ++k) at[k] += stride * random.uniform(-1, 1);
        for (std::size_t k = 3; k < 5; ++k) at[k] += 2 * stride * random.uniform(-1, 1);
        text += line_to(at, "XYZAB");
      }
      INFO(text);
      auto program = read_text(text, machine);
      REQUIRE_FALSE(program.failed());
      const auto blocks = std::move(program).take_blocks();
      const auto [smooth, most] = smooth_within(
          blocks, machine, [&](const VectorN<double, 5>& q) { return machine.map.tip(q); },
          {.tolerance = tolerance}, level);
      faster += smooth.duration();
      of_stops += plan_blocks(blocks, machine, junction::ExactStop{})->duration();
    } else {
      auto machine = table();
      for (auto& axis : machine.axes) axis.jerk *= random.log_uniform(0.3, 10);
      const double radius = random.log_uniform(5, 150);
      std::vector<double> at{radius, 0, 0};
      for (int i = 0; i < 15; ++i) {
        for (double& x : at) x += stride * random.uniform(-1, 1);
        at[0] = std::max(at[0], 0.2 * radius);  // not across the axis
        text += line_to(at, "XYZ");
      }
      INFO(text);
      const PlanOptions options{.tolerance = tolerance, .start = {radius, 0, 0}};
      auto program = read_text(text, machine, options);
      REQUIRE_FALSE(program.failed());
      const auto blocks = std::move(program).take_blocks();
      const auto [smooth, most] = smooth_within(blocks, machine, table_tip, options, level);
      faster += smooth.duration();
      of_stops += plan_blocks(blocks, machine, junction::ExactStop{})->duration();
    }
  }
  CHECK(faster < 0.9 * of_stops);
}

TEST_CASE("under a map: near a singular place the motion slows down") {
  const auto machine = table();
  for (const double beside : {1.0, 0.1, 0.02}) {
    std::ostringstream text;
    text << "F3000\nG1 X20 Y" << beside << "\nX-20 Y" << beside << "\nX-25 Y5\n";
    INFO(text.str());
    const PlanOptions options{.tolerance = 0.01, .start = {20, -5, 0}};
    auto program = read_text(text.str(), machine, options);
    REQUIRE_FALSE(program.failed());
    const auto blocks = std::move(program).take_blocks();
    const auto [smooth, most] = smooth_within(blocks, machine, table_tip, options, SmoothLevel::good);
    CHECK(smooth.duration() > std::numbers::pi);  // of half a turn of C
    CHECK(smooth.duration() < plan_blocks(blocks, machine, junction::ExactStop{})->duration() + 1e-9);
    for (const auto& part : smooth.fallbacks()) CHECK(part.reason == FallbackReason::fast_is_faster);
    CHECK((smooth.fallbacks().empty() || beside < 0.05));
  }
}

// One joint more that tilts beyond an edge of the part, as the axis A of a mold does.
struct Edge {
  using Scalar = double;
  static constexpr int axis_count = 4;

  double tilts = 0;  // rad per mm of X beyond 10

  template <class T>
  [[nodiscard]] std::array<T, 4> joints(const std::array<T, 3>& p) const {
    return {p[0], p[1], p[2], T(tilts) * (p[0] - T(10))};
  }
};

TEST_CASE("under a map: motion rests where one block's map does not go on in the next one's") {
  MappedMachine<Edge> machine;
  for (auto& axis : machine.axes) axis.velocity = 100, axis.acceleration = 1000, axis.jerk = 10000;
  machine.limits = {.velocity = 50, .acceleration = 1000, .jerk = 10000};
  using Line = path::Mapped<Edge, path::Line<3>>;
  const auto blocks_of = [](double tilts) {
    const Edge before{tilts}, beyond{0.1};
    return std::vector<Block<4, Line>>{
        {.path = Line(before, path::Line<3>({0, 0, 0}, {10, 0, 0})), .feed = 30},
        {.path = Line(beyond, path::Line<3>({10, 0, 0}, {20, 0, 0})), .feed = 30},
        {.path = Line(beyond, path::Line<3>({20, 0, 0}, {20, 10, 0})), .feed = 30}};
  };
  for (const bool same : {false, true}) {
    const auto planned = plan_blocks(blocks_of(same ? 0.1 : 0.0), machine, {.tolerance = 0.01});
    REQUIRE(planned);
    const double edge = planned->at(planned->start_time(1)).along.velocity;
    const double corner = planned->at(planned->start_time(2)).along.velocity;
    CHECK((same ? edge == Approx(30).epsilon(1e-3) : edge < 1e-9));
    CHECK(corner > 1);
    const Used most =
        used_under_map(*planned, machine, [](const auto& q) { return Vector3(q[0], q[1], q[2]); });
    CHECK(most.velocity <= 1 + 1e-9);
    CHECK(most.acceleration <= 1 + 1e-9);
    CHECK(most.jerk <= 1 + 1e-9);
  }
}

}  // namespace
