#include "cncplan/kinematics/tire_mold/sidewall.hpp"

#include <Eigen/Geometry>

#include "cncplan/kinematics/tire_mold/profile_chain.hpp"
#include "cncplan/kinematics/tire_mold/tire_mold.hpp"
#include "cncplan/path/mapped.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace cncplan::kinematics;

static_assert(path::Map<SidewallMap> && path::Map<BasicSidewallMap<float>>);

namespace {

constexpr double pi = std::numbers::pi;

// Outwards up a flat shoulder, over a convex arc, down a slope: with a kink before the slope.
ProfileChain wall() {
  const std::vector<Drawn> drawn{DrawnLine{{200, 100}, {160, 100}}, DrawnArc{{160, 60}, 40, pi / 2, pi / 4},
                                 DrawnLine{{160 - 20 * std::sqrt(2), 60 + 20 * std::sqrt(2)}, {120, 60}}};
  return *chain_profile(std::span<const Drawn>(drawn));
}

// The same wall written out: the place after q mm, and the unit normal there.
struct Place {
  double r, z, normal_r, normal_z;
};
const double arc_from = 40, slope_from = 40 + 10 * pi;
const double slope_r = 160 - 20 * std::sqrt(2) - 120, slope_z = 20 * std::sqrt(2);  // right and up to its top
const double slope = std::hypot(slope_r, slope_z);

Place place(double q) {
  if (q < arc_from) return {200 - q, 100, 0, 1};
  if (q < slope_from) {
    const double angle = pi / 2 + (q - arc_from) / 40;
    return {160 + 40 * std::cos(angle), 60 + 40 * std::sin(angle), std::cos(angle), std::sin(angle)};
  }
  const double left = 1 - (q - slope_from) / slope;
  return {120 + left * slope_r, 60 + left * slope_z, -slope_z / slope, slope_r / slope};
}

}  // namespace

TEST_CASE("the machine's forward kinematics lead back to the wall", "[sidewall]") {
  test::Random random;
  const auto chain = wall();
  const Sidewall sidewall(chain.pieces, 50, 20.8);
  const TireMold machine{.tool_length = 20.8};
  double tip = 0, along = 0;
  for (int i = 0; i < 100000; ++i) {
    const double r = random.uniform(50, 50 + slope_from + slope), c = random.uniform(-pi, pi);
    const double z = random.uniform(-1, 20);
    const auto joints = sidewall.joints({r * std::cos(c), r * std::sin(c), z});
    if (!joints) FAIL("refused");
    const Pose pose = machine.forward(*joints);
    const Place p = place(r - 50);
    const double radius = p.r + z * p.normal_r;
    const Vector3 expected(radius * std::cos(c), radius * std::sin(c), p.z + z * p.normal_z);
    const Vector3 normal(p.normal_r * std::cos(c), p.normal_r * std::sin(c), p.normal_z);
    tip = std::max(tip, (pose.position - expected).norm());
    along = std::max(along, (pose.direction - normal).norm());
  }
  CHECK(tip < 1e-12 * 500);
  CHECK(along < 1e-13);
}

// Flat text is read from above. Seen from the tool it stays as it is where the tool stands on the left, and
// is mirrored on the right: there it is read on what the mold presses.
TEST_CASE("text on the left of a profile is legible on the piece, on the right on its cast", "[sidewall]") {
  test::Random random;
  const TireMold machine{.tool_length = 20};
  const std::vector<Drawn> disc{DrawnLine{{0, 50}, {80, 50}}}, sphere{DrawnArc{{0, 40}, 60, pi / 6, pi / 3}};
  int wrong = 0;
  double worst = 0;
  for (const bool ball : {false, true})
    for (const Side side : {Side::left, Side::right}) {
      const std::span<const Drawn> drawn = ball ? sphere : disc;
      const auto chain = chain_profile(drawn, {.reverse = ball, .side = side});
      REQUIRE(chain);
      const Sidewall sidewall(chain->pieces, 0, 20);
      const double up = side == Side::left ? 1 : -1;
      for (int i = 0; i < 1000; ++i) {
        const double r = random.uniform(5, 60), c = random.uniform(-3, 3), z = random.uniform(-1, 5);
        const Vector3 point(r * std::cos(c), r * std::sin(c), z);
        const auto pose = [&](double x, double y) {
          return machine.forward(*sidewall.joints(point + Vector3(x, y, 0)));
        };
        const Pose here = pose(0, 0);
        const Vector3 to_x = pose(1e-3, 0).position - here.position;
        const Vector3 to_y = pose(0, 1e-3).position - here.position;
        wrong += to_x.cross(to_y).dot(here.direction) * up > 0 ? 0 : 1;
        // the tool stands away from the sphere's centre, or towards it; up from the disc, or down
        const double angle = ball ? r / 60 : 0;
        const Vector3 outward(std::sin(angle) * std::cos(c), std::sin(angle) * std::sin(c), std::cos(angle));
        worst = std::max(worst, (here.direction - up * outward).norm());
        const Vector3 on = ball ? Vector3(0, 0, 40) + 60 * outward : Vector3(point.x(), point.y(), 50);
        worst = std::max(worst, (here.position - on - z * up * outward).norm());
      }
    }
  CHECK(wrong == 0);
  CHECK(worst < 1e-12);
}

TEST_CASE("the wall ends somewhere, and the origin has no angle", "[sidewall]") {
  const auto chain = wall();
  const Sidewall sidewall(chain.pieces, 50, 20.8);
  CHECK(sidewall.joints({49, 0, 0}).error() == Error{ErrorCode::below_limit, "radius", 49, 50});
  CHECK(sidewall.joints({0, 500, 0}).error() ==
        Error{ErrorCode::above_limit, "radius", 500, sidewall.end_radius()});
  CHECK(sidewall.joints({std::nan(""), 0, 0}).error().field == "radius");
  const Sidewall from_center(chain.pieces, 0, 20.8);
  CHECK(from_center.joints({0, 0, 0}).error().code == ErrorCode::not_positive);
}

TEST_CASE("jets of the mapping are its derivatives", "[sidewall]") {
  const auto chain = wall();
  const Sidewall sidewall(chain.pieces, 50, 20.8);
  const auto map = sidewall.map(1, Azimuth(0.6, 0.8, 0));
  // along a line over the arc piece
  const auto point = [](double t) { return std::array<double, 3>{62 + 3 * t, 75 - 2 * t, 1 + 0.5 * t}; };
  const auto joints = map.joints(std::array<Jet, 3>{Jet(62, 3, 0, 0), Jet(75, -2, 0, 0), Jet(1, 0.5, 0, 0)});
  const auto tip = map.tip(std::array<Jet, 3>{Jet(62, 3, 0, 0), Jet(75, -2, 0, 0), Jet(1, 0.5, 0, 0)});
  const double h = 0.02;
  const auto check = [&](auto at, const Jet& jet) {
    CHECK(jet.value == Approx(at(0.0)));
    CHECK(jet.first == Approx((8 * (at(h) - at(-h)) - at(2 * h) + at(-2 * h)) / (12 * h)).epsilon(1e-9));
    CHECK(
        jet.second ==
        Approx((16 * (at(h) + at(-h)) - at(2 * h) - at(-2 * h) - 30 * at(0.0)) / (12 * h * h)).epsilon(1e-6));
    CHECK(jet.third == Approx((at(2 * h) - 2 * at(h) + 2 * at(-h) - at(-2 * h)) / (2 * h * h * h))
                           .epsilon(1e-3)
                           .margin(1e-8));
  };
  for (std::size_t i = 0; i < 4; ++i) check([&](double t) { return map.joints(point(t))[i]; }, joints[i]);
  for (std::size_t i = 0; i < 3; ++i) check([&](double t) { return map.tip(point(t))[i]; }, tip[i]);
}

TEST_CASE("over a kink the tip stands still and the tool turns", "[sidewall]") {
  const auto chain = wall();
  const Sidewall sidewall(chain.pieces, 50, 20.8);
  const double angle = kink_angle(chain.pieces[1], chain.pieces[2]);
  REQUIRE(std::abs(angle) > 0.2);
  const double c = 2.5, begins = sidewall.begins(2);
  const auto map = sidewall.kink_map(1, Azimuth(std::cos(c), std::sin(c), 0));
  const TireMold machine{.tool_length = 20.8};
  const auto at = [&](double turned) {
    const double r = begins + turned;
    return std::array<double, 3>{r * std::cos(c), r * std::sin(c), 0};
  };
  double worst = 0;
  for (int k = 0; k <= 10; ++k) {
    const auto q = map.joints(at(std::abs(angle) * k / 10));
    const auto p = chain.pieces[2].start;
    worst = std::max(worst, (machine.forward({q[0], q[1], q[2], q[3]}).position -
                             Vector3(p.x() * std::cos(c), p.x() * std::sin(c), p.y()))
                                .norm());
  }
  CHECK(worst < 1e-12 * 500);
  const auto before = sidewall.map(1).joints(at(0)), after = sidewall.map(2).joints(at(0));
  const auto first = map.joints(at(0)), last = map.joints(at(std::abs(angle)));
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(std::abs(first[i] - before[i]) < 1e-12 * 500);
    CHECK(std::abs(last[i] - after[i]) < 1e-12 * 500);
  }
}

TEST_CASE("mapping a point allocates nothing", "[sidewall]") {
  const auto chain = wall();
  const Sidewall sidewall(chain.pieces, 50, 20.8);
  CHECK(test::heap_allocations_of([&] { (void)sidewall.joints({60, 10, 1}); }) == 0);
}
