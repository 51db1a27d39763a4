// The fastest motion along one path: closed forms, limits by differences of places, ends, refusals.
#include "cncplan/time_optimal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "cncplan/interpolate/detail/travel.hpp"
#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/path/cubic.hpp"
#include "cncplan/path/line.hpp"
#include "cncplan/path/measured.hpp"
#include "support/catch.hpp"
#include "support/half_ellipse.hpp"
#include "support/random.hpp"

using namespace cncplan;
using cncplan::MotionLimits;

namespace {

constexpr Limits mill{.velocity = 30, .acceleration = 1000, .jerk = 1e4};

static_assert(interpolate::PhasedProfile<PhaseProfile>);

MotionLimits<3> of_tool(const Limits& tool) {
  MotionLimits<3> limits;
  limits.tool = tool;
  return limits;
}

// The largest shares of their limits, by differences of positions. The jerk's difference over three steps is
// a mean of the jerk, which is never above its limit.
template <class P>
void check_limits(const P& path, const PhaseProfile& motion, const MotionLimits<3>& limits) {
  const double step = std::max(motion.duration() / 20000, 1e-4);
  const auto place = [&](double t) -> Vector3 { return path.position_at(motion.at(t).position); };
  double velocity = 0, acceleration = 0, jerk = 0;
  for (double t = 0; t + 3 * step <= motion.duration(); t += step) {
    const Vector3 a = place(t), b = place(t + step), c = place(t + 2 * step), d = place(t + 3 * step);
    const auto add = [](double& most, const Vector3& value, const MotionLimits<3>& all, double Limits::*of) {
      most = std::max(most, value.norm() / (all.tool.*of));
      for (int axis = 0; axis < 3; ++axis)
        most = std::max(most, std::abs(value[axis]) / (all.axes[static_cast<std::size_t>(axis)].*of));
    };
    add(velocity, (b - a) / step, limits, &Limits::velocity);
    add(acceleration, (a - 2 * b + c) / (step * step), limits, &Limits::acceleration);
    add(jerk, (d - 3 * c + 3 * b - a) / (step * step * step), limits, &Limits::jerk);
  }
  CHECK(velocity < 1 + 1e-9);
  CHECK(acceleration < 1 + 1e-6);
  CHECK(jerk < 1 + 1e-3);  // by rounding of the positions
  CHECK(std::max({velocity, acceleration, jerk}) > 0.98);
}

// Of a path's length and one motion along it.
void check_ends(const PhaseProfile& motion, double length, double start, double end) {
  const State first = motion.at(0), last = motion.at(motion.duration());
  CHECK(first.position == 0);
  CHECK(std::abs(first.velocity - start) < 1e-9);
  CHECK(std::abs(last.position - length) < 1e-9 * length);
  CHECK(std::abs(last.velocity - end) < 1e-7);
  CHECK(std::abs(last.acceleration) < 1e-4);
  State before = first;
  for (const Phase& phase : motion.phases()) {
    const State now = phase.at(0);
    CHECK(std::abs(now.position - before.position) < 1e-10 * length);
    CHECK(std::abs(now.velocity - before.velocity) < 1e-8);
    CHECK(std::abs(now.acceleration - before.acceleration) < 1e-5);
    before = phase.at(phase.duration);
  }
  for (const double share : {0.1, 0.5, 0.93})
    CHECK(std::abs(motion.at(motion.time_at(share * length)).position - share * length) < 1e-9 * length);
}

}  // namespace

TEST_CASE("time optimal: lines take the time of closed forms") {
  const struct {
    double length, time;
  } cases[] = {{0.01, std::cbrt(32 * 0.01 / 1e4)},
               {1, std::cbrt(32 * 1 / 1e4)},
               {10, 10.0 / 30 + 2 * std::sqrt(30 / 1e4)},
               {1000, 1000.0 / 30 + 2 * std::sqrt(30 / 1e4)}};
  for (const auto& [length, time] : cases) {
    CAPTURE(length);
    const auto motion = time_optimal(path::Line<3>({1, 2, 3}, {1 + length, 2, 3}), of_tool(mill));
    REQUIRE(motion);
    check_ends(*motion, length, 0, 0);
    CHECK(motion->duration() >= time * (1 - 1e-9));
    CHECK(motion->duration() < time * 1.005);
  }
}

TEST_CASE("time optimal: limits of tool and axes hold on curves, from rest and at speeds") {
  const auto circle =
      path::arc_from_center(Vector3(0, 0, 0), {100, 0, 0}, {50, 0, 0}, Turn::clockwise, Plane::xy);
  REQUIRE(circle);
  const auto slow = of_tool({.velocity = 50, .acceleration = 500, .jerk = 50});
  const auto half = time_optimal(*circle, slow);
  REQUIRE(half);
  check_ends(*half, circle->length(), 0, 0);
  check_limits(*circle, *half, slow);
  CHECK(half->duration() < 5.72);  // the level best, from a search with other cells: 5.70

  MotionLimits<3> of_axes;
  of_axes.tool = {1e9, 1e12, 1e15};
  of_axes.axes = {mill, {.velocity = 15, .acceleration = 200, .jerk = 5e3}, mill};
  for (const double height : {3.0, 8.0, 20.0})
    for (const auto& limits : {of_tool(mill), of_axes})
      for (const double speed : {0.0, 2.0}) {
        CAPTURE(height, speed, limits.tool.velocity);
        const auto path = path::measured(test::HalfEllipse{20, height});
        REQUIRE(path);
        const auto motion = time_optimal(*path, limits, {.start_velocity = speed, .end_velocity = speed / 2});
        REQUIRE(motion);
        check_ends(*motion, path->length(), speed, speed / 2);
        check_limits(*path, *motion, limits);
      }
}

TEST_CASE(
    "time optimal: limits hold along random cubics, whose parameter is no length, from any feasible ends") {
  test::Random random;
  for (int i = 0; i < 60; ++i) {
    CAPTURE(test::seed(), i);
    PathPoint<Vector3> start;
    start.position.setZero();
    for (int axis = 0; axis < 3; ++axis) {
      start.first[axis] = random.uniform(-2, 2);
      start.second[axis] = random.uniform(-1, 1) / 5;
      start.third[axis] = random.uniform(-1, 1) / 50;
    }
    const path::Cubic<3> path(start, random.log_uniform(0.01, 10));
    MotionLimits<3> limits;
    limits.tool = {random.log_uniform(5, 100), random.log_uniform(50, 5000), random.log_uniform(500, 1e5)};
    if (random.coin())
      for (Limits& own : limits.axes)
        own = {limits.tool.velocity * random.uniform(0.4, 1.5),
               limits.tool.acceleration * random.uniform(0.4, 1.5),
               limits.tool.jerk * random.uniform(0.4, 1.5)};
    CAPTURE(path.length(), limits.tool.velocity, limits.tool.acceleration, limits.tool.jerk);
    const auto motion = time_optimal(path, limits);
    REQUIRE(motion);
    check_ends(*motion, path.length(), 0, 0);
    check_limits(path, *motion, limits);
  }
}

TEST_CASE("time optimal: a feed holds, and looser limits are no slower") {
  const auto path = path::measured(test::HalfEllipse{20, 8});
  REQUIRE(path);
  const auto free = time_optimal(*path, of_tool(mill)),
             fed = time_optimal(*path, of_tool(mill), {.feed = 12});
  const auto loose = time_optimal(*path, of_tool({.velocity = 30, .acceleration = 1000, .jerk = 2e4}));
  REQUIRE((free && fed && loose));
  CHECK(loose->duration() < free->duration());
  double fastest = 0;
  for (double t = 0; t < fed->duration(); t += 1e-3) fastest = std::max(fastest, fed->at(t).velocity);
  CHECK(fastest <= 12);
  CHECK(fastest > 11.99);
}

TEST_CASE("time optimal: what cannot be is refused by name") {
  const path::Line<3> line({0, 0, 0}, {1, 0, 0});
  const auto code = [&](const MotionLimits<3>& limits, const TimeOptimalOptions& options = {}) {
    const auto motion = time_optimal(line, limits, options);
    REQUIRE(!motion);
    return motion.error();
  };
  constexpr double infinity = std::numeric_limits<double>::infinity();
  CHECK(code(of_tool({30, 1000, infinity})).code == ErrorCode::not_finite);
  CHECK(code(of_tool({30, -1, 1e4})).code == ErrorCode::not_positive);
  CHECK(code(of_tool(mill), {.start_velocity = -1}).code == ErrorCode::negative);
  CHECK(code(of_tool(mill), {.end_velocity = 31}).field == "end_velocity");
  CHECK(code(of_tool(mill), {.feed = 0}).field == "feed");
  CHECK(code(of_tool(mill), {.gap = 0}).field == "gap");
  CHECK(code(of_tool(mill), {.start_velocity = 29}).code == ErrorCode::end_speed_unreachable);
  CHECK(!time_optimal(path::Line<3>({0, 0, 0}, {0, 0, 0}), of_tool(mill)));
  PathPoint<Vector3> unknown;
  unknown.position.setZero(), unknown.first.setOnes(), unknown.second.setZero();
  unknown.third.setConstant(std::numeric_limits<double>::quiet_NaN());
  const auto motion = time_optimal(path::Cubic<3>(unknown, 1), of_tool(mill));
  REQUIRE(!motion);
  CHECK(motion.error().code == ErrorCode::not_finite);
}

TEST_CASE("time optimal: huge and tiny paths, and ends next to a limit") {
  for (const double length : {1e-6, 1e6}) {
    CAPTURE(length);
    const auto motion = time_optimal(path::Line<3>({0, 0, 0}, {length, 0, 0}), of_tool(mill));
    REQUIRE(motion);
    const double least = length > 1 ? length / 30 + 2 * std::sqrt(30 / 1e4) : std::cbrt(32 * length / 1e4);
    CHECK(motion->duration() >= least * (1 - 1e-9));
    CHECK(motion->duration() < least * 1.005);
    CHECK(motion->phases().size() < 100000);
  }
  for (const double speed : {1e-9, 29.9}) {
    CAPTURE(speed);
    const path::Line<3> line({0, 0, 0}, {50, 0, 0});
    const auto motion = time_optimal(line, of_tool(mill), {.start_velocity = speed});
    REQUIRE(motion);
    check_ends(*motion, 50, speed, 0);
    check_limits(line, *motion, of_tool(mill));
  }
}

TEST_CASE("time optimal: a rotary axis alone, and float") {
  MotionLimits<4> joints;
  for (Limits& own : joints.axes) own = {.velocity = 2, .acceleration = 10, .jerk = 100};
  const auto turn = time_optimal(path::Line<4>({0, 0, 0, 0}, {0, 0, 0, 3}), joints);
  REQUIRE(turn);
  CHECK(turn->duration() >= 1.8 * (1 - 1e-9));  // 3 / 2 + 2 / 10 + 10 / 100
  CHECK(turn->duration() < 1.8 * 1.005);

  cncplan::BasicMotionLimits<float, 3> limits;
  limits.tool = {30, 1000, 10000};
  const auto line = time_optimal(path::BasicLine<float, 3>({0, 0, 0}, {10, 0, 0}), limits);
  REQUIRE(line);
  CHECK(std::abs(line->duration() - 0.44288F) < 0.005F * 0.44288F);
}
