// Everything of the machines in float, held against the same in double: as exact as float allows, and the
// same pieces, kinks and stops.
#include <iterator>
#include <vector>

#include "cncplan/kinematics/cartesian.hpp"
#include "cncplan/kinematics/polar.hpp"
#include "cncplan/kinematics/tire_mold.hpp"
#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/plan/joint/caps.hpp"
#include "cncplan/plan/joint/course.hpp"
#include "cncplan/plan/joint/polar_guide.hpp"
#include "cncplan/plan/joint/sidewall_guide.hpp"
#include "cncplan/plan/joint/sidewall_rows.hpp"
#include "laws.hpp"
#include "support/random.hpp"
#include "wall.hpp"

using namespace cncplan;
using namespace cncplan::kinematics;

namespace {

template <class S>
path::BasicSegment<S> line(S x0, S y0, S z0, S x1, S y1, S z1) {
  return path::BasicLine<S>({x0, y0, z0}, {x1, y1, z1});
}

// Over the shoulder, round the arc and across the kink, there and back.
template <class S>
std::vector<path::BasicSegment<S>> artwork() {
  const auto arc = path::arc_from_center<S>({S(70), S(30), S(0)}, {S(70), S(30), S(0)}, {S(80), S(30), S(0)},
                                            Turn::clockwise, Plane::xy);
  return {line<S>(60, 0, 5, 70, 30, 5),
          line<S>(70, 30, 5, 70, 30, 0),
          *arc,
          line<S>(70, 30, 0, 40, 80, 0),
          line<S>(40, 80, 0, -30, 90, 0),
          line<S>(-30, 90, 0, -60, 60, 0),
          line<S>(-60, 60, 0, -60, -40, 0),
          line<S>(-60, -40, 0, -125, -20, 0),
          line<S>(-125, -20, 0, -60, -30, 2)};
}

// What a course comes to, as doubles: lengths, stops, joints at a hundred places, and the caps.
struct Summary {
  double length = 0;
  std::size_t kinks = 0;
  std::vector<Eigen::VectorXd> joints;
  double slowest = 1e9, slowest_corner = 1e9, least_acceleration = 1e9, least_jerk = 1e9;
};

template <class Guide, class S, int N>
Summary summary(Guide guide, const BasicJointLimits<S, N>& limits) {
  plan::JointCourse<Guide> course{std::move(guide)};
  std::size_t number = 0;
  for (const auto& segment : artwork<S>()) {
    const auto appended = course.append(segment, S(60), number++);
    CAPTURE(number, appended ? 0.0 : appended.error().value, appended ? 0.0 : appended.error().bound);
    REQUIRE(appended);
  }
  Summary result;
  const auto& blocks = course.blocks();
  for (const auto& block : blocks) {
    result.length += static_cast<double>(block.path.length());
    if (block.stop_at_end) ++result.kinks;
  }
  double origin = 0;
  int next = 0;
  for (const auto& block : blocks) {
    const double length = static_cast<double>(block.path.length());
    for (; next <= 100 && next / 100.0 * result.length <= origin + length; ++next) {
      const double along = next / 100.0 * result.length - origin;
      result.joints.push_back(
          block.path.position(block.path.parameter_at(static_cast<S>(along))).template cast<double>());
    }
    origin += length;
  }
  std::vector<plan::BasicBlockCaps<S>> caps;
  using Block = typename plan::JointCourse<Guide>::Block;
  plan::joint_caps(std::span<const Block>(blocks), limits, S(0.001), std::back_inserter(caps));
  for (std::size_t i = 0; i < caps.size(); ++i) {
    const auto least = [](double& worst, S value) { worst = std::min(worst, static_cast<double>(value)); };
    least(result.slowest, caps[i].limits.velocity);
    least(result.least_acceleration, caps[i].limits.acceleration);
    least(result.least_jerk, caps[i].limits.jerk);
    if (i > 0 && !blocks[i - 1].stop_at_end) least(result.slowest_corner, caps[i].entry);
  }
  return result;
}

void compare(const Summary& single, const Summary& exact) {
  CHECK(single.length == Approx(exact.length).epsilon(1e-6));
  CHECK(single.kinks == exact.kinks);
  REQUIRE(single.joints.size() >= 100);
  double worst = 0;
  for (std::size_t i = 0; i < std::min(single.joints.size(), exact.joints.size()); ++i)
    worst = std::max(worst, (single.joints[i] - exact.joints[i]).cwiseAbs().maxCoeff());
  CHECK(worst < 1e-3);  // a path of 500 mm and more, and its rounding
  // speeds come in steps of 2 %
  CHECK(single.slowest == Approx(exact.slowest).epsilon(0.05));
  CHECK(single.slowest_corner == Approx(exact.slowest_corner).epsilon(0.05));
  CHECK(single.least_acceleration == Approx(exact.least_acceleration).epsilon(0.1));
  CHECK(single.least_jerk == Approx(exact.least_jerk).epsilon(0.1));
}

template <class S>
Summary on_the_wall() {
  const auto chain = test::wall<S>();
  const BasicSidewall<S> sidewall(chain.pieces, S(50), S(20.8));
  BasicJointLimits<S, 4> limits;
  limits.velocity << 100, 100, 1, 1;
  limits.acceleration << 500, 500, 5, 10;
  limits.jerk << 5000, 5000, 50, 100;
  return summary(plan::BasicSidewallGuide<S>(sidewall, S(1)), limits);
}

template <class S>
Summary round_the_table() {
  BasicJointLimits<S, 3> limits;
  limits.velocity << 100, 100, 1;
  limits.acceleration << 500, 500, 10;
  limits.jerk << 5000, 5000, 100;
  return summary(plan::BasicPolarGuide<S>(S(1)), limits);
}

// The largest error of joints there and back, over their scale.
template <class K>
double round_trip(const K& machine, const typename K::Joints& low, const typename K::Joints& high) {
  test::Random random;
  test::KinematicErrors worst;
  for (int i = 0; i < 10000; ++i) {
    typename K::Joints joints;
    for (int k = 0; k < joints.size(); ++k)
      joints[k] = static_cast<typename K::Scalar>(
          random.uniform(static_cast<double>(low[k]), static_cast<double>(high[k])));
    test::examine(machine, joints, high, worst);
  }
  CHECK(worst.refused == 0);
  return worst.round_trip;
}

}  // namespace

TEST_CASE("float: machines there and back", "[float]") {
  const float turn = 3.1F;
  CHECK(round_trip(BasicCartesian<float>{}, {-500, -500, -500}, {500, 500, 500}) == 0.0);
  CHECK(round_trip(BasicPolar<float>{}, {1, -600, -turn}, {900, 600, turn}) < 1e-6);
  BasicTireMold<float> machine;
  machine.tool_length = 20.8F;
  machine.smallest_radius = 1;
  CHECK(round_trip(machine, BasicTireMold<float>::Joints(30, 0, -1.5F, -turn),
                   BasicTireMold<float>::Joints(900, 600, 1.5F, turn)) < 1e-5);
}

TEST_CASE("float: the profile is chained and mapped as in double", "[float]") {
  const auto single = test::wall<float>();
  const auto exact = test::wall<double>();
  REQUIRE(single.pieces.size() == exact.pieces.size());
  CHECK(single.entities == exact.entities);
  CHECK(static_cast<double>(single.length()) == Approx(exact.length()).epsilon(1e-6));
  const BasicSidewall<float> flat(single.pieces, 50, 20.8F);
  const Sidewall sidewall(exact.pieces, 50, 20.8);
  test::Random random;
  double worst = 0;
  for (int i = 0; i < 10000; ++i) {
    const double r = random.uniform(51, 140), c = random.uniform(-3, 3);
    const Vector3 point(r * std::cos(c), r * std::sin(c), random.uniform(-1, 5));
    const double border = std::abs(r - sidewall.begins(sidewall.piece_at(r)));
    if (border < 1e-3) continue;  // on a kink either piece is right
    const auto q = flat.joints(point.cast<float>());
    const auto truth = sidewall.joints(point);
    REQUIRE((q && truth));
    worst = std::max(worst, (q->cast<double>() - *truth).cwiseAbs().maxCoeff());
  }
  CHECK(worst < 2e-4);  // mm at 200 mm, and rad
}

TEST_CASE("float: a program over the wall, its kinks and its caps as in double", "[float]") {
  const Summary exact = on_the_wall<double>();
  CHECK(exact.kinks == 4);
  compare(on_the_wall<float>(), exact);
}

TEST_CASE("float: a program round the table and its caps as in double", "[float]") {
  compare(round_the_table<float>(), round_the_table<double>());
}

TEST_CASE("float: rows of a stretch keep the tolerance", "[float]") {
  const auto chain = test::wall<float>();
  const BasicSidewall<float> sidewall(chain.pieces, 50, 20.8F);
  plan::BasicSidewallGuide<float> guide(sidewall, 1);
  std::vector<plan::SidewallStretch<float>> stretches;
  REQUIRE(guide.follow(line<float>(60, 0, 0, 0, 110, 0), stretches));
  for (const auto& stretch : stretches) {
    const auto division = plan::divide(stretch, 0.01F);
    CHECK(division.error <= 0.01F);
    CHECK(division.rows < 100);
  }
}
