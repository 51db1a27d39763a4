// Motion in machine space: what the joints do, held against their limits by oracles that share nothing with
// the caps: differences of joint positions, and the wall itself.
#include <iterator>
#include <vector>

#include "cncplan/interpolate/exact.hpp"
#include "cncplan/kinematics/tire_mold.hpp"
#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/plan/cursor.hpp"
#include "cncplan/plan/joint/caps.hpp"
#include "cncplan/plan/joint/course.hpp"
#include "cncplan/plan/joint/polar_guide.hpp"
#include "cncplan/plan/joint/sidewall_guide.hpp"
#include "cncplan/plan/whole_plan.hpp"
#include "cncplan/profile/seven_phase.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"
#include "support/random.hpp"
#include "wall.hpp"

using namespace cncplan;
using namespace cncplan::kinematics;

namespace {

constexpr double pi = std::numbers::pi;

path::Segment<3> line(const Vector3& a, const Vector3& b) { return path::Line<3>(a, b); }

template <class Course, class Joints>
plan::Plan planned(const Course& course, const Joints& limits, double corner_time) {
  const auto plan = plan::whole_plan(course.blocks(), limits, corner_time);
  REQUIRE(plan);
  return *plan;
}

template <int N>
struct Worst {
  VectorN<double, N> velocity = VectorN<double, N>::Zero();
  VectorN<double, N> acceleration = VectorN<double, N>::Zero();
  VectorN<double, N> jerk = VectorN<double, N>::Zero();
};

// Differences of sampled joint positions over a step so short that they are the derivatives, and no longer
// than the time between places where the jerk may jump: a difference is a mean of the derivative, so it may
// not exceed the limit either.
template <int N, class Course>
Worst<N> measure(const Course& course, const plan::Plan& plan, double step) {
  plan::Cursor cursor(plan.spans, plan.lengths);
  Worst<N> worst;
  std::vector<VectorN<double, N>> last;
  const auto joints = [&](double t) {
    const auto place = cursor.at(t);
    const auto& path = course.blocks()[place.block].path;
    return VectorN<double, N>(path.position(path.parameter_at(place.along)));
  };
  for (double t = 0; t < plan.duration; t += step) {
    last.push_back(joints(t));
    const auto n = last.size();
    if (n >= 2) worst.velocity = worst.velocity.cwiseMax(((last[n - 1] - last[n - 2]) / step).cwiseAbs());
    if (n >= 3)
      worst.acceleration = worst.acceleration.cwiseMax(
          ((last[n - 1] - 2 * last[n - 2] + last[n - 3]) / (step * step)).cwiseAbs());
    if (n >= 4)
      worst.jerk = worst.jerk.cwiseMax(
          ((last[n - 1] - 3 * last[n - 2] + 3 * last[n - 3] - last[n - 4]) / (step * step * step))
              .cwiseAbs());
  }
  return worst;
}

template <int N>
void check_within(const Worst<N>& worst, const BasicJointLimits<double, N>& limits, double rounding) {
  for (int i = 0; i < N; ++i) {
    INFO("joint " << i);
    CHECK(worst.velocity[i] <= limits.velocity[i] * (1 + rounding));
    CHECK(worst.acceleration[i] <= limits.acceleration[i] * (1 + rounding));
    CHECK(worst.jerk[i] <= limits.jerk[i] * (1 + rounding));
  }
}

BasicJointLimits<double, 4> tire_limits() {
  BasicJointLimits<double, 4> limits;
  limits.velocity << 100, 100, 1, 60 * pi / 180;  // C: 10 rpm
  limits.acceleration << 500, 500, 5, 10;
  limits.jerk << 5000, 5000, 50, 100;
  return limits;
}

}  // namespace

TEST_CASE("joints keep their limits over wall, kink and corners", "[motion]") {
  const auto chain = test::wall<double>();
  const Sidewall sidewall(chain.pieces, 50, 20.8);
  plan::JointCourse course{plan::SidewallGuide(sidewall, 1.0)};
  const auto arc =
      path::arc_from_center<double>({70, 30, 0}, {70, 30, 0}, {80, 30, 0}, Turn::clockwise, Plane::xy);
  REQUIRE(arc);
  std::vector<path::Segment<3>> art{line({60, 0, 5}, {70, 30, 5}),
                                    line({70, 30, 5}, {70, 30, 0}),
                                    *arc,
                                    line({70, 30, 0}, {40, 80, 0}),
                                    line({40, 80, 0}, {-30, 90, 0}),
                                    line({-30, 90, 0}, {-60, 60, 0}),
                                    line({-60, 60, 0}, {-60, -40, 0}),
                                    line({-60, -40, 0}, {-125, -20, 0}),
                                    line({-125, -20, 0}, {-60, -30, 2})};
  for (std::size_t i = 0; i < art.size(); ++i) REQUIRE(course.append(art[i], 60, i));
  // the kink is crossed twice, and each time the tool stops before it and behind it
  int kinks = 0, stops = 0;
  for (std::size_t i = 1; i < course.blocks().size(); ++i) {
    const bool before = course.blocks()[i - 1].path.chart().piece.is_kink();
    const bool after = course.blocks()[i].path.chart().piece.is_kink();
    if (before == after) continue;
    ++kinks;
    if (course.blocks()[i - 1].stop_at_end) ++stops;
  }
  CHECK(kinks == 4);
  CHECK(stops == kinks);
  // once the jerks bind, once the accelerations, once the speeds
  auto limits = tire_limits();
  const int binding = GENERATE(0, 1, 2);
  CAPTURE(binding);
  if (binding > 0) limits.jerk *= 100;
  if (binding == 1) limits.acceleration /= 10;
  if (binding == 2) {
    limits.velocity /= 10;
    limits.acceleration *= 4;
  }
  for (const auto& block : course.blocks()) CHECK(block.path.length() <= 2.0 * 1.3);
  SECTION("with a stop at every corner") {
    const auto plan = planned(course, limits, 0.0);
    const auto worst = measure<4>(course, plan, 1e-3);
    check_within(worst, limits, 1e-4);
    // one axis at least comes near to what binds: the limits are used
    const auto used = [](const auto& reached, const auto& limit) {
      return reached.cwiseQuotient(limit).maxCoeff();
    };
    if (binding == 0) CHECK(used(worst.jerk, limits.jerk) > 0.9);
    if (binding == 1) CHECK(used(worst.acceleration, limits.acceleration) > 0.9);
    if (binding == 2) CHECK(used(worst.velocity, limits.velocity) > 0.9);
  }
  SECTION("with corners within one period") {
    const auto stopping = planned(course, limits, 0.0);
    const auto plan = planned(course, limits, 1e-3);
    CHECK(plan.duration < stopping.duration);
    const auto worst = measure<4>(course, plan, 1e-3);
    for (int i = 0; i < 4; ++i) {
      CHECK(worst.velocity[i] <= limits.velocity[i] * (1 + 1e-6));
      CHECK(worst.acceleration[i] <= 2 * limits.acceleration[i]);  // the corner's jump and what surrounds it
    }
  }
}

TEST_CASE("every sample of the plan stands on the wall, and C goes on without a jump", "[motion]") {
  const auto chain = test::wall<double>();
  const Sidewall sidewall(chain.pieces, 50, 20.8);
  plan::JointCourse course{plan::SidewallGuide(sidewall, 1.0)};
  // twice round the mold
  const auto arc = path::arc_from_center<double>({100, 0, 0.5}, {100, 0, 0.5}, {0, 0, 0},
                                                 Turn::counterclockwise, Plane::xy, {}, 1);
  REQUIRE(arc);
  REQUIRE(course.append(line({60, 0, 0.5}, {100, 0, 0.5}), 60, 0));
  REQUIRE(course.append(*arc, 60, 1));
  REQUIRE(course.append(line({100, 0, 0.5}, {80, -30, 0.5}), 60, 2));
  const auto plan = planned(course, tire_limits(), 1e-3);
  plan::Cursor cursor(plan.spans, plan.lengths);
  const TireMold machine{.tool_length = 20.8};
  double off_wall = 0, jump = 0, last = 0, highest = 0;
  for (double t = 0; t < plan.duration; t += 1e-3) {
    const auto place = cursor.at(t);
    const auto& path = course.blocks()[place.block].path;
    const double u = path.parameter_at(place.along);
    const auto q = path.position(u);
    const auto flat = path.point(u);
    const Pose pose = machine.forward(q);
    const double r = std::hypot(flat[0], flat[1]);
    const auto& piece = chain.pieces[sidewall.piece_at(r)];
    const auto p = piece.point(r - 50 - piece.from);
    const auto n = piece.normal(r - 50 - piece.from);
    const double tip = p.r + flat[2] * n.r;
    off_wall =
        std::max(off_wall,
                 (pose.position - Vector3(tip * flat[0] / r, tip * flat[1] / r, p.z + flat[2] * n.z)).norm());
    if (t > 0) jump = std::max(jump, std::abs(q[3] - last));
    last = q[3];
    highest = std::max(highest, q[3]);
  }
  CHECK(off_wall < 1e-9);
  CHECK(jump <= 60 * pi / 180 * 1e-3 * (1 + 1e-9));
  CHECK(highest == Approx(4 * pi).epsilon(0.01));
}

TEST_CASE("mapped paths measure themselves", "[motion]") {
  const auto chain = test::wall<double>();
  const Sidewall sidewall(chain.pieces, 50, 20.8);
  plan::JointCourse course{plan::SidewallGuide(sidewall, 1.0)};
  test::Random random;
  Vector3 at(60, 20, 0);
  for (std::size_t i = 0; i < 50; ++i) {
    const double r = random.uniform(55, 130), c = random.uniform(-pi, pi);
    const Vector3 to(r * std::cos(c), r * std::sin(c), random.uniform(-1, 10));
    const auto ok = course.append(line(at, to), 60, i);
    if (ok) at = to;
  }
  double length = 0, inverse = 0, first = 0, second = 0, joined = 0;
  for (std::size_t i = 0; i < course.blocks().size(); ++i) {
    const auto& path = course.blocks()[i].path;
    const double end = path.parameter_end();
    const auto tip = [&](double u) {
      const auto p = path.chart().measured(path.point(u));
      return Vector3(p[0], p[1], p[2]);
    };
    // the length of the polygon, made as exact by Richardson's rule as eight and sixteen chords allow
    const auto polygon = [&](int n) {
      double sum = 0;
      for (int k = 0; k < n; ++k) sum += (tip(end * (k + 1) / n) - tip(end * k / n)).norm();
      return sum;
    };
    const double exact = polygon(16) + (polygon(16) - polygon(8)) / 3;
    length = std::max(length, std::abs(path.length() - exact) / exact);
    const double s = path.length() * 0.37;
    inverse = std::max(inverse, std::abs(path.length_at(path.parameter_at(s)) - s));
    const double h = end * 1e-3, u = end * 0.4;
    const auto d1 = ((path.position(u + h) - path.position(u - h)) / (2 * h)).eval();
    const auto d2 = ((path.position(u + h) - 2 * path.position(u) + path.position(u - h)) / (h * h)).eval();
    first = std::max(first, (d1 - path.derivative(u)).norm() / (1 + d1.norm()));
    second = std::max(second, (d2 - path.second_derivative(u)).norm() * end / (1 + d1.norm()));
    if (i > 0 && course.blocks()[i - 1].motion == course.blocks()[i].motion) {
      const auto& before = course.blocks()[i - 1].path;
      joined = std::max(joined, (before.position(before.parameter_end()) - path.position(0)).norm());
    }
  }
  CHECK(course.blocks().size() > 500);
  const auto& any = course.blocks().front().path;
  CHECK(test::heap_allocations_of([&] {
          (void)any.position(any.parameter_at(any.length() / 3));
          (void)plan::rate_bounds(any);
        }) == 0);
  CHECK(length < 1e-7);
  CHECK(inverse < 1e-11);
  CHECK(first < 1e-6);
  CHECK(second < 1e-4);
  CHECK(joined < 1e-9);
}

TEST_CASE("polar: a path near the axis is slowed, inside the radius refused", "[motion]") {
  BasicJointLimits<double, 3> limits;
  limits.velocity << 100, 100, 60 * pi / 180;
  limits.acceleration << 500, 500, 10;
  limits.jerk << 5000, 5000, 100;
  plan::JointCourse course{plan::PolarGuide(1.0)};
  REQUIRE(course.append(line({-40, 1.5, 0}, {40, 1.5, 2}), 30, 0));
  REQUIRE(course.append(line({40, 1.5, 2}, {40, -20, 2}), 30, 1));
  const auto arc = path::arc_from_center<double>({40, -20, 2}, {-40, -20, 0}, {0, -20, 2},
                                                 Turn::counterclockwise, Plane::xy);
  REQUIRE(course.append(*arc, 30, 2));
  const auto refused = course.append(line({-40, -20, 0}, {40, 21, 0}), 30, 3);
  REQUIRE(!refused);
  CHECK(refused.error().code == ErrorCode::below_limit);
  CHECK(refused.error().field == "radius");
  CHECK(refused.error().value ==
        Approx(std::abs(40 * -41 + 80 * 20) / std::hypot(80, 41)));  // by cross product
  CHECK(refused.error().bound == 1.0);

  const auto plan = planned(course, limits, 0.0);
  check_within(measure<3>(course, plan, 1e-3), limits, 1e-4);
  // at 1.5 mm from the axis, 60 degrees a second are pi/2 mm/s
  double slowest = 100;
  std::vector<plan::BlockCaps> caps;
  plan::joint_caps(std::span(course.blocks()), limits, 0.0, std::back_inserter(caps));
  for (const auto& block : caps) slowest = std::min(slowest, block.limits.velocity);
  CHECK(slowest < pi / 2);
  CHECK(slowest > 0.3);
}

// Faults of joint-space planning that go with it: `Trajectory` over `path::Mapped` and `Machine` has neither
// (tests/path/path_concept_test.cpp, tests/plan/trajectory_test.cpp, tests/plan/plan_program_test.cpp).
TEST_CASE("samples of a mapped path have the speed that differences give", "[!shouldfail]") {
  kinematics::PolarChart chart;
  chart.azimuth = {30.0, 0.0, 0.0};
  const plan::MappedPath<kinematics::PolarChart> path(line({20, -10, 0}, {20, 10, 0}), chart, 0.0, 20.0);
  const auto profile =
      profile::seven_phase(path.length(), {.start = 0.0, .end = 0.0}, Limits{30.0, 1000.0, 10000.0});
  REQUIRE(profile);
  const auto samples = interpolate::samples(path, *profile, 1e-4);
  const auto middle = samples.size() / 2;
  const VectorN<double, 3> difference =
      (samples[middle + 1].position - samples[middle - 1].position) / (2 * 1e-4);
  CHECK((samples[middle].velocity - difference).norm() < 1e-3);
}

TEST_CASE("a plan within the limits of joints keeps their travel", "[!shouldfail]") {
  plan::JointCourse course{plan::PolarGuide(1.0)};
  REQUIRE(course.append(line({20, 0, 0}, {60, 0, 0}), 30.0));
  BasicJointLimits<double, 3> limits;
  limits.velocity.setConstant(100.0);
  limits.acceleration.setConstant(1000.0);
  limits.jerk.setConstant(10000.0);
  limits.high[0] = 50.0;
  CHECK_FALSE(plan::whole_plan(course.blocks(), limits, 0.001).has_value());
}
