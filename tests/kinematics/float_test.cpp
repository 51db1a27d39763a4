// Everything of the machines in float, held against the same in double: as exact as float allows, and the
// same pieces, kinks and stops.
#include <algorithm>
#include <vector>

#include "cncplan/junction/deviation.hpp"
#include "cncplan/kinematics/polar.hpp"
#include "cncplan/kinematics/tire_mold/tire_mold.hpp"
#include "cncplan/plan_blocks.hpp"
#include "cncplan/tire_mold/wall_program.hpp"
#include "cncplan/tire_mold/wall_rows.hpp"
#include "laws.hpp"
#include "machine.hpp"
#include "support/random.hpp"
#include "wall.hpp"

using namespace cncplan;
using namespace cncplan::kinematics;

namespace {

// What a trajectory comes to, as doubles: length, time, stops, and the axes at a hundred places of its way.
struct Summary {
  double length = 0, duration = 0;
  long stops = 0;
  std::vector<Eigen::VectorXd> places;
};

template <class M, class B>
Summary summary(const std::vector<B>& blocks, const M& machine) {
  Summary result;
  for (const B& block : blocks) result.length += static_cast<double>(block.path.length());
  result.stops = std::count_if(blocks.begin(), blocks.end(), [](const B& block) { return block.exact_stop; });
  double origin = 0;
  int next = 0;
  for (const B& block : blocks) {
    const double length = static_cast<double>(block.path.length());
    for (; next <= 100 && next / 100.0 * result.length <= origin + length; ++next)
      result.places.push_back(
          block.path.position_at(static_cast<typename M::Scalar>(next / 100.0 * result.length - origin))
              .template cast<double>());
    origin += length;
  }
  using S = typename M::Scalar;
  const auto trajectory = plan_blocks(blocks, machine, junction::BasicDeviation<S>{S(0.01)});
  REQUIRE(trajectory);
  result.duration = static_cast<double>(trajectory->duration());
  return result;
}

void compare(const Summary& single, const Summary& exact) {
  CHECK(single.length == Approx(exact.length).epsilon(1e-6));
  CHECK(single.stops == exact.stops);
  CHECK(single.duration == Approx(exact.duration).epsilon(0.01));
  REQUIRE(single.places.size() >= 100);
  double worst = 0;
  for (std::size_t i = 0; i < std::min(single.places.size(), exact.places.size()); ++i)
    worst = std::max(worst, (single.places[i] - exact.places[i]).cwiseAbs().maxCoeff());
  CHECK(worst < 1e-3);  // a path of 500 mm and more, and its rounding
}

template <class S>
Summary on_the_wall() {
  const auto chain = test::wall<S>();
  const BasicSidewall<S> sidewall(chain.pieces, S(50), S(20.8));
  tire_mold::BasicWallProgram<S> program(sidewall, S(1));
  for (const auto& segment : test::wall_artwork<S>())
    REQUIRE(program.append({.path = segment, .feed = S(60)}));
  return summary(program.blocks(), test::wall_machine<S>());
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

TEST_CASE("float: a program over the wall and its kinks as in double", "[float]") {
  const Summary exact = on_the_wall<double>();
  CHECK(exact.stops == 4);  // before and behind the kink, there and back
  compare(on_the_wall<float>(), exact);
}

TEST_CASE("float: rows of a part keep the tolerance", "[float]") {
  const auto chain = test::wall<float>();
  const BasicSidewall<float> sidewall(chain.pieces, 50, 20.8F);
  tire_mold::BasicWallCutter<float> cutter(sidewall, 1);
  std::vector<tire_mold::BasicWallPart<float>> parts;
  REQUIRE(
      cutter.cut(tire_mold::BasicArtworkPath<float>(path::BasicLine<float>({60, 0, 0}, {0, 110, 0})), parts));
  for (const auto& part : parts) {
    const auto division = tire_mold::divide(part, 0.01F);
    CHECK(division.error <= 0.01F);
    CHECK(division.rows < 100);
  }
}
