// Motion of the four axes on a wall, and round a table: what the axes do, held against their limits by
// oracles that share nothing with the bounds: differences of positions, and the wall itself.
#include <algorithm>
#include <limits>
#include <vector>

#include "cncplan/junction/deviation.hpp"
#include "cncplan/kinematics/polar.hpp"
#include "cncplan/kinematics/tire_mold/tire_mold.hpp"
#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/peaks.hpp"
#include "cncplan/plan_program.hpp"
#include "cncplan/tire_mold/wall_program.hpp"
#include "machine.hpp"
#include "maps/maps.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"
#include "support/random.hpp"
#include "wall.hpp"

using namespace cncplan;
using namespace cncplan::kinematics;

namespace {

constexpr double pi = std::numbers::pi;

tire_mold::ArtworkPath line(const Vector3& a, const Vector3& b) { return path::Line<3>(a, b); }

template <int N>
struct Worst {
  VectorN<double, N> velocity = VectorN<double, N>::Zero();
  VectorN<double, N> acceleration = VectorN<double, N>::Zero();
  VectorN<double, N> jerk = VectorN<double, N>::Zero();
};

// Differences of sampled positions: a difference is a mean of the derivative, so it may not exceed the limit
// either. They are taken where the motion is smooth, `together` on both sides: at corners the velocity jumps.
template <class T, class Together>
auto measure(const T& trajectory, double step, const Together& together) {
  constexpr int n = T::MachineType::axis_count;
  Worst<n> worst;
  std::vector<typename T::SetPoint> last;
  for (const auto& point : trajectory.samples(step)) {
    if (!last.empty() && !together(last.back(), point)) last.clear();
    last.push_back(point);
    const auto q = [&](std::size_t k) { return last[last.size() - 1 - k].position; };
    if (last.size() < 2 || point.time >= trajectory.duration()) continue;  // the last is not on the grid
    worst.velocity = worst.velocity.cwiseMax(((q(0) - q(1)) / step).cwiseAbs());
    if (last.size() < 3) continue;
    worst.acceleration = worst.acceleration.cwiseMax(((q(0) - 2 * q(1) + q(2)) / (step * step)).cwiseAbs());
    if (last.size() < 4) continue;
    worst.jerk = worst.jerk.cwiseMax(((q(0) - 3 * q(1) + 3 * q(2) - q(3)) / (step * step * step)).cwiseAbs());
  }
  return worst;
}

template <int N, class M>
void check_within(const Worst<N>& worst, const M& machine, double rounding) {
  for (int i = 0; i < N; ++i) {
    INFO("axis " << i);
    const Axis& axis = machine.axes[static_cast<std::size_t>(i)];
    CHECK(worst.velocity[i] <= axis.velocity * (1 + rounding));
    CHECK(worst.acceleration[i] <= axis.acceleration * (1 + rounding));
    CHECK(worst.jerk[i] <= axis.jerk * (1 + rounding));
  }
}

// Flat blocks at 60 mm/s on the wall, each a motion of its own.
tire_mold::WallProgram on_wall(const Sidewall& sidewall, const std::vector<tire_mold::ArtworkPath>& art,
                               bool stops) {
  tire_mold::WallProgram program(sidewall, 1.0);
  int number = 0;
  for (const auto& segment : art)
    REQUIRE(program.append({.path = segment, .feed = 60, .exact_stop = stops, .line = ++number}));
  return program;
}

}  // namespace

TEST_CASE("axes keep their limits over wall, kink and corners", "[motion]") {
  const auto chain = test::wall<double>();
  const Sidewall sidewall(chain.pieces, 50, 20.8);
  const auto art = test::wall_artwork<double>();
  // once the jerks bind, once the accelerations, once the speeds
  auto machine = test::wall_machine<double>();
  const int binding = GENERATE(0, 1, 2);
  const bool stops = GENERATE(true, false);
  CAPTURE(binding, stops);
  for (Axis& axis : machine.axes) {
    if (binding > 0) axis.jerk *= 100;
    if (binding == 1) axis.acceleration /= 10;
    if (binding == 2) {
      axis.velocity /= 10;
      axis.acceleration *= 4;
    }
  }
  const auto program = on_wall(sidewall, art, stops);
  // the kink is crossed twice, and each time the tool stops before it and behind it
  int kinks = 0, resting = 0;
  for (std::size_t i = 1; i < program.blocks().size(); ++i) {
    const auto kink = [&](std::size_t k) {
      return program.blocks()[k].path.as<tire_mold::WallPath>()->curve().kink;
    };
    if (kink(i - 1) == kink(i)) continue;
    ++kinks;
    if (program.blocks()[i - 1].exact_stop) ++resting;
  }
  CHECK(kinks == 4);
  CHECK(resting == kinks);
  const auto trajectory = plan_blocks(program.blocks(), machine, junction::Deviation{0.01});
  REQUIRE(trajectory);
  const auto piece = [&](const auto& point) {
    return trajectory->program()[point.block].path.template as<tire_mold::WallPath>()->curve().map.piece;
  };
  const auto worst = measure(*trajectory, 1e-3, [&](const auto& before, const auto& after) {
    return before.line == after.line && piece(before) == piece(after);
  });
  check_within(worst, machine, 1e-4);
  // one axis at least comes near to what binds: the limits are used
  double velocity = 0, acceleration = 0, jerk = 0;
  for (int i = 0; i < 4; ++i) {
    const Axis& axis = machine.axes[static_cast<std::size_t>(i)];
    velocity = std::max(velocity, worst.velocity[i] / axis.velocity);
    acceleration = std::max(acceleration, worst.acceleration[i] / axis.acceleration);
    jerk = std::max(jerk, worst.jerk[i] / axis.jerk);
  }
  if (binding == 0) CHECK(jerk > 0.9);
  if (binding == 1) CHECK(acceleration > 0.9);
  if (binding == 2) CHECK(velocity > 0.9);
  // what the search finds is no less than the differences, and within the limits
  const auto peaks = cncplan::peaks(*trajectory);
  for (int i = 0; i < 4; ++i) {
    const Axis& axis = machine.axes[static_cast<std::size_t>(i)];
    CHECK(peaks.velocity[i] <= axis.velocity * (1 + 1e-9));
    CHECK(peaks.acceleration[i] <= axis.acceleration * (1 + 1e-9));
    CHECK(peaks.jerk[i] <= axis.jerk * (1 + 1e-9));
    CHECK(peaks.velocity[i] >= worst.velocity[i] * (1 - 1e-4));
    CHECK(peaks.acceleration[i] >= worst.acceleration[i] * (1 - 1e-4));
  }
  if (stops) {
    const auto blocks = trajectory->blocks();
    for (std::size_t i = 1; i < blocks.size(); ++i)
      if (blocks[i - 1].line != blocks[i].line) CHECK(blocks[i].entry == 0);
    const auto passing =
        plan_blocks(on_wall(sidewall, art, false).blocks(), machine, junction::Deviation{0.01});
    REQUIRE(passing);
    CHECK(passing->duration() < trajectory->duration());
  }
}

TEST_CASE("every sample of the plan stands on the wall, and C goes on without a jump", "[motion]") {
  const auto chain = test::wall<double>();
  const Sidewall sidewall(chain.pieces, 50, 20.8);
  // twice round the mold
  const auto arc = path::arc_from_center<double>({100, 0, 0.5}, {100, 0, 0.5}, {0, 0, 0},
                                                 Turn::counterclockwise, Plane::xy, {}, 1);
  REQUIRE(arc);
  const auto program = on_wall(
      sidewall, {line({60, 0, 0.5}, {100, 0, 0.5}), *arc, line({100, 0, 0.5}, {80, -30, 0.5})}, false);
  const auto trajectory =
      plan_blocks(program.blocks(), test::wall_machine<double>(), junction::Deviation{0.01});
  REQUIRE(trajectory);
  const TireMold machine{.tool_length = 20.8};
  double off_wall = 0, jump = 0, last = 0, highest = 0;
  for (const auto& point : trajectory->samples(1e-3)) {
    const auto& path = *trajectory->program()[point.block].path.as<tire_mold::WallPath>();
    const double s = point.along.position - trajectory->start_length(point.block);
    const auto flat = path.curve().flat(path.parameter_at(s));
    const auto& q = point.position;
    const Pose pose = machine.forward(q);
    const double r = std::hypot(flat[0], flat[1]);
    const auto& piece = chain.pieces[sidewall.piece_at(r)];
    const auto p = piece.point(r - 50 - piece.from);
    const auto n = piece.normal(r - 50 - piece.from);
    const double tip = p.r + flat[2] * n.r;
    off_wall =
        std::max(off_wall,
                 (pose.position - Vector3(tip * flat[0] / r, tip * flat[1] / r, p.z + flat[2] * n.z)).norm());
    if (point.time > 0) jump = std::max(jump, std::abs(q[3] - last));
    last = q[3];
    highest = std::max(highest, q[3]);
  }
  CHECK(off_wall < 1e-9);
  CHECK(jump <= 60 * pi / 180 * 1e-3 * (1 + 1e-9));
  CHECK(highest == Approx(4 * pi).epsilon(0.01));
}

TEST_CASE("paths on the wall measure themselves", "[motion]") {
  const auto chain = test::wall<double>();
  const Sidewall sidewall(chain.pieces, 50, 20.8);
  tire_mold::WallProgram program(sidewall, 1.0);
  test::Random random;
  Vector3 at(60, 20, 0);
  int splines = 0;
  for (int i = 0; i < 50; ++i) {
    const double r = random.uniform(55, 130), c = random.uniform(-pi, pi);
    const Vector3 to(r * std::cos(c), r * std::sin(c), random.uniform(-1, 10));
    tire_mold::ArtworkPath way = line(at, to);
    if (i % 3 == 0) {  // a piece of a spline instead, bent to the side
      const Vector3 chord = to - at, aside(-chord.y(), chord.x(), 0.0);
      const double bend = random.uniform(-0.6, 0.6), other = random.uniform(-0.6, 0.6);
      way = path::spline(path::RationalCubic<3>({at, Vector3(at + 0.3 * chord + bend * aside),
                                                 Vector3(at + 0.7 * chord + other * aside), to},
                                                random.uniform(0.5, 2), random.uniform(0.5, 2)))
                .value();
    }
    if (!program.append({.path = way, .feed = 60, .line = i})) continue;
    splines += i % 3 == 0;
    at = to;
  }
  CHECK(splines > 3);
  double length = 0, inverse = 0, first = 0, second = 0, joined = 0, below = 0;
  for (std::size_t i = 0; i < program.blocks().size(); ++i) {
    const auto& path = *program.blocks()[i].path.as<tire_mold::WallPath>();
    const double end = path.parameter_end();
    const auto tip = [&](double u) {
      const auto p = path.curve().travelled(u);
      return Vector3(p[0], p[1], p[2]);
    };
    // the length of the polygon, made as exact by Richardson's rule as so many chords allow
    const auto polygon = [&](int n) {
      double sum = 0;
      for (int k = 0; k < n; ++k) sum += (tip(end * (k + 1) / n) - tip(end * k / n)).norm();
      return sum;
    };
    const double exact = polygon(400) + (polygon(400) - polygon(200)) / 3;
    length = std::max(length, std::abs(path.length() - exact) / exact);
    const double s = path.length() * 0.37, h = path.length() * 1e-3;
    inverse = std::max(inverse, std::abs(path.length_at(path.parameter_at(s)) - s));
    const auto q = [&](double by) { return path.position_at(s + by); };
    const auto d1 = ((q(h) - q(-h)) / (2 * h)).eval();
    const auto d2 = ((q(h) - 2 * q(0) + q(-h)) / (h * h)).eval();
    const auto point = path.point_at(s);
    first = std::max(first, (d1 - point.first).norm() / (1 + d1.norm()));
    second = std::max(second, (d2 - point.second).norm() * path.length() / (1 + d1.norm()));
    // the bounds hold at places of their own
    const auto bounds = path.bounds(0.2 * path.length(), 0.6 * path.length());
    for (int k = 0; k <= 10; ++k) {
      const auto place = path.point_at((0.2 + 0.04 * k) * path.length());
      below = std::max({below, (place.first.cwiseAbs() - bounds.first).maxCoeff(),
                        (place.second.cwiseAbs() - bounds.second).maxCoeff(),
                        (place.third.cwiseAbs() - bounds.third).maxCoeff()});
    }
    if (i > 0 && program.blocks()[i - 1].line == program.blocks()[i].line) {
      const auto& before = program.blocks()[i - 1].path;
      joined = std::max(joined, (before.position_at(before.length()) - path.position_at(0)).norm());
    }
  }
  CHECK(program.blocks().size() > 100);
  const auto& any = *program.blocks().front().path.as<tire_mold::WallPath>();
  CHECK(test::heap_allocations_of([&] {
          (void)any.point_at(any.length() / 3);
          (void)any.bounds(0.0, any.length());
        }) == 0);
  CHECK(length < 1e-7);
  CHECK(inverse < 1e-11);
  CHECK(first < 1e-5);
  CHECK(second < 1e-3);
  CHECK(below < 1e-12);
  CHECK(joined < 1e-9);
}

TEST_CASE("polar: a path near the axis is slowed", "[motion]") {
  MappedMachine<ThreeJoints> machine{.map = ThreeJoints(PolarMap{}), .limits = {.velocity = 150}};
  const auto slides_and_table = test::table_machine<double>().axes;
  std::copy(slides_and_table.begin(), slides_and_table.end(), machine.axes.begin());
  const auto trajectory = plan_text("F1800 G61.1 G1 X40 Z2\nY-20\nG3 X-40 Z0 I-40\n", machine,
                                    {.tolerance = 0, .start = {-40, 1.5, 0}});
  REQUIRE(trajectory);
  const auto worst = measure(*trajectory, 1e-3,
                             [](const auto& before, const auto& after) { return before.line == after.line; });
  check_within(worst, machine, 1e-4);
  // At 1.5 mm from the axis, 60 degrees a second are pi/2 mm/s, and the path rises by 2 on 80.
  double nearest = 100, speed = 0, off = 0;
  for (const auto& point : trajectory->samples(1e-3)) {
    off = std::max(off, std::abs(std::hypot(point.tool.x(), point.tool.y()) - point.position[0]));
    if (point.line == 1 && point.position[0] < nearest) {
      nearest = point.position[0];
      speed = point.along.velocity;
    }
  }
  CHECK(off < 1e-9);
  CHECK(nearest == Approx(1.5).epsilon(1e-5));
  CHECK(speed < pi / 2 * std::hypot(80, 2) / 80 * (1 + 1e-9));
  CHECK(speed > 0.3);
}
