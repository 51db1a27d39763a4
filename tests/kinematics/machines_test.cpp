// The ready-made machines: there and back again, against formulas written anew, derivatives by differences,
// and bounds that hold them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

#include "cncplan/kinematics/core_xy.hpp"
#include "cncplan/kinematics/delta.hpp"
#include "cncplan/kinematics/five_bar.hpp"
#include "cncplan/kinematics/polar.hpp"
#include "cncplan/kinematics/scara.hpp"
#include "cncplan/kinematics/table_table.hpp"
#include "cncplan/kinematics/tilting_head.hpp"
#include "cncplan/kinematics/wrist_arm.hpp"
#include "cncplan/path/map.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using namespace cncplan::kinematics;

namespace {

constexpr double pi = std::numbers::pi;

template <class M>
using Joints = path::MapJoints<M, double>;
template <class M>
using Point = path::MapPoint<M, double>;

// The worst of all draws.
struct Worst {
  double joints = 0;   // of the round trip, over the size of the machine, or rad
  double point = 0;    // the same from the program's side
  double rates = 0;    // of jets against differences, over the largest of each order
  double outside = 0;  // by which a jet leaves its bounds, over its size
};

double turned(double angle) { return std::remainder(angle, 2 * pi); }

// A cubic through a point, as fast as the machine is large.
template <class T, std::size_t N>
std::array<T, N> curve(const std::array<std::array<double, N>, 4>& c, const T& t) {
  std::array<T, N> x;
  for (std::size_t i = 0; i < N; ++i)
    x[i] = T(c[0][i]) + t * (T(c[1][i]) + t * (T(c[2][i]) + t * T(c[3][i])));
  return x;
}

// `low` and `high`: of each joint. `size`: mm, of the machine; `angles`: which joints turn.
template <class M, class L>
Worst examine(const M& map, const L& exact, const Joints<M>& low, const Joints<M>& high, double size,
              unsigned angles, unsigned coordinate_angles, int rounds = 2000) {
  test::Random random;
  Worst worst;
  constexpr std::size_t n = std::tuple_size_v<Joints<M>>, m = std::tuple_size_v<Point<M>>;
  for (int round = 0; round < rounds; ++round) {
    Joints<M> q;
    for (std::size_t i = 0; i < n; ++i) q[i] = random.uniform(low[i], high[i]);
    const auto p = map.point(q);
    const auto back = map.joints(p);
    for (std::size_t i = 0; i < n; ++i)
      worst.joints = std::max(worst.joints, ((angles >> i) & 1U) != 0 ? std::abs(turned(back[i] - q[i]))
                                                                      : std::abs(back[i] - q[i]) / size);
    const auto again = map.point(back);
    for (std::size_t i = 0; i < m; ++i)
      worst.point =
          std::max(worst.point, ((coordinate_angles >> i) & 1U) != 0 ? std::abs(turned(again[i] - p[i]))
                                                                     : std::abs(again[i] - p[i]) / size);
    if (round >= 200) continue;

    // Along a curve through the point.
    std::array<std::array<double, m>, 4> c{};
    for (std::size_t i = 0; i < m; ++i) {
      const double unit = ((coordinate_angles >> i) & 1U) != 0 ? 0.05 : 0.02 * size;
      c[0][i] = p[i];
      for (std::size_t k = 1; k < 4; ++k) c[k][i] = random.uniform(-unit, unit);
    }
    const auto jets = map.joints(curve(c, Jet(0.0, 1.0, 0.0, 0.0)));
    const auto f = [&](int steps) { return exact.joints(curve(c, static_cast<long double>(steps) * 1e-3L)); };
    std::array<decltype(f(0)), 7> at;
    for (int k = -3; k <= 3; ++k) at[static_cast<std::size_t>(k + 3)] = f(k);
    constexpr long double h = 1e-3L;
    for (std::size_t i = 0; i < n; ++i) {
      const auto g = [&](int k) {
        const long double raw = at[static_cast<std::size_t>(k + 3)][i] - at[3][i];
        return ((angles >> i) & 1U) != 0 ? std::remainder(raw, 2 * std::numbers::pi_v<long double>) : raw;
      };
      const long double d1 = (45 * (g(1) - g(-1)) - 9 * (g(2) - g(-2)) + (g(3) - g(-3))) / (60 * h);
      const long double d2 =
          (270 * (g(1) + g(-1)) - 27 * (g(2) + g(-2)) + 2 * (g(3) + g(-3))) / (180 * h * h);
      const long double d3 = (g(-3) - 8 * g(-2) + 13 * g(-1) - 13 * g(1) + 8 * g(2) - g(3)) / (8 * h * h * h);
      const long double unit = ((angles >> i) & 1U) != 0 ? 1.0L : size;
      const long double scale = unit + std::abs(d1) + std::abs(d2) + std::abs(d3);
      for (const long double gap : {jets[i].first - d1, jets[i].second - d2, jets[i].third - d3})
        worst.rates = std::max(worst.rates, static_cast<double>(std::abs(gap) / scale));
    }

    const Interval piece(0.0, 1e-3);
    const auto bounds =
        map.joints(curve(c, BasicJet<Interval>(piece, Interval(1), Interval(0), Interval(0))));
    for (const double t : {0.0, 3e-4, 1e-3}) {
      const auto inside = map.joints(curve(c, Jet(t, 1.0, 0.0, 0.0)));
      for (std::size_t i = 0; i < n; ++i) {
        const auto out = [&](const Interval& bound, double value) {
          const double scale =
              size + std::abs(value) + (std::isfinite(bound.largest()) ? bound.largest() : 0);
          worst.outside = std::max(worst.outside, std::max(bound.low - value, value - bound.high) / scale);
        };
        out(bounds[i].value, inside[i].value);
        out(bounds[i].first, inside[i].first);
        out(bounds[i].second, inside[i].second);
        out(bounds[i].third, inside[i].third);
      }
    }
  }
  return worst;
}

void check(const Worst& worst, double rates = 1e-6) {
  CHECK(worst.joints < 1e-12);
  CHECK(worst.point < 1e-12);
  CHECK(worst.rates < rates);
  CHECK(worst.outside < 1e-12);
}

using Turn = Eigen::AngleAxisd;
using Rotation = Eigen::Matrix3d;

Rotation about(const Vector3& axis, double angle) { return Turn(angle, axis).toRotationMatrix(); }
const Vector3 ex = Vector3::UnitX(), ey = Vector3::UnitY(), ez = Vector3::UnitZ();

template <std::size_t N>
Vector3 first_three(const std::array<double, N>& x) {
  return {x[0], x[1], x[2]};
}

// The place of the axes by rotations of Eigen's, and the tool's direction in the part.
template <class M, class At, class Along>
void check_five_axes(const M& map, const At& at, const Along& along) {
  test::Random random;
  double place = 0, direction = 0, angles = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vector3 p(random.uniform(-200, 200), random.uniform(-200, 200), random.uniform(-200, 200));
    const double tilt = random.uniform(-pi, pi), c = random.uniform(-2 * pi, 2 * pi);
    const auto q = map.joints(std::array{p.x(), p.y(), p.z(), tilt, c});
    place = std::max(place, (first_three(q) - at(p, tilt, c)).norm());
    CHECK((q[3] == tilt && q[4] == c));
    const auto d = map.direction(q);
    direction = std::max(direction, (first_three(d) - along(tilt, c)).norm());
    for (const auto& [one, other] : map.angles(d))
      angles = std::max(angles, (along(one, other) - along(tilt, c)).norm());
  }
  CHECK(place < 1e-11);
  CHECK(direction < 1e-14);
  CHECK(angles < 1e-7);  // near upright an angle is known by its cosine
  const auto upright = map.angles({0, 0, 1});
  CHECK((upright[0][0] == 0 && upright[0][1] == 0));
}

constexpr std::array<double, 5> low5{-300, -300, -300, -1.9, -9}, high5{300, 300, 300, 1.9, 9};

}  // namespace

TEST_CASE("table-table machines hold the part under the tip", "[machines]") {
  const BasicTableTableAC<double> ac{.center = {3, -4, -60}, .apart = {0, 5, -7}, .tool_length = 80};
  const BasicTableTableAC<long double> exact_ac{
      .center = {3, -4, -60}, .apart = {0, 5, -7}, .tool_length = 80};
  check(examine(ac, exact_ac, low5, high5, 300, 0b11000, 0b11000));
  const Vector3 center(3, -4, -60), apart(0, 5, -7);
  check_five_axes(
      ac,
      [&](const Vector3& p, double a, double c) -> Vector3 {
        return center + apart + about(ex, a) * (about(ez, c) * (p - center) - apart) + 80 * ez;
      },
      [&](double a, double c) -> Vector3 { return (about(ex, a) * about(ez, c)).transpose() * ez; });
  const BasicTableTableBC<double> bc{.center = {3, -4, -60}, .apart = {5, 0, -7}, .tool_length = 80};
  const BasicTableTableBC<long double> exact_bc{
      .center = {3, -4, -60}, .apart = {5, 0, -7}, .tool_length = 80};
  check(examine(bc, exact_bc, low5, high5, 300, 0b11000, 0b11000));
  const Vector3 aside(5, 0, -7);
  check_five_axes(
      bc,
      [&](const Vector3& p, double b, double c) -> Vector3 {
        return center + aside + about(ey, b) * (about(ez, c) * (p - center) - aside) + 80 * ez;
      },
      [&](double b, double c) -> Vector3 { return (about(ey, b) * about(ez, c)).transpose() * ez; });
}

TEST_CASE("tilting heads hold the tip where it is", "[machines]") {
  const BasicHeadTable<double> mixed{.center = {3, -4, -60}, .pivot_length = 150, .tool_length = 80};
  const BasicHeadTable<long double> exact_mixed{
      .center = {3, -4, -60}, .pivot_length = 150, .tool_length = 80};
  check(examine(mixed, exact_mixed, low5, high5, 300, 0b11000, 0b11000));
  const Vector3 center(3, -4, -60);
  check_five_axes(
      mixed,
      [&](const Vector3& p, double b, double c) -> Vector3 {
        return center + about(ez, c) * (p - center) + 230 * about(ey, b) * ez - 150 * ez;
      },
      [&](double b, double c) -> Vector3 { return about(ez, -c) * about(ey, b) * ez; });
  const BasicHeadHeadAC<double> ac{.pivot_length = 150, .tool_length = 80};
  check(examine(ac, BasicHeadHeadAC<long double>{.pivot_length = 150, .tool_length = 80}, low5, high5, 300,
                0b11000, 0b11000));
  check_five_axes(
      ac,
      [&](const Vector3& p, double a, double c) -> Vector3 {
        return p + 230 * about(ez, c) * about(ex, a) * ez - 150 * ez;
      },
      [&](double a, double c) -> Vector3 { return about(ez, c) * about(ex, a) * ez; });
  const BasicHeadHeadBC<double> bc{.pivot_length = 150, .tool_length = 80};
  check(examine(bc, BasicHeadHeadBC<long double>{.pivot_length = 150, .tool_length = 80}, low5, high5, 300,
                0b11000, 0b11000));
  check_five_axes(
      bc,
      [&](const Vector3& p, double b, double c) -> Vector3 {
        return p + 230 * about(ez, c) * about(ey, b) * ez - 150 * ez;
      },
      [&](double b, double c) -> Vector3 { return about(ez, c) * about(ey, b) * ez; });
}

TEST_CASE("nutating heads turn about an axis that leans", "[machines]") {
  for (const double lean : {pi / 4, 0.6, pi / 2}) {
    const BasicNutatingHead<double> head{.lean = lean, .pivot_length = 150, .tool_length = 80};
    check(examine(head, BasicNutatingHead<long double>{.lean = lean, .pivot_length = 150, .tool_length = 80},
                  low5, high5, 300, 0b11000, 0b11000));
    const Vector3 axis(0, std::sin(lean), std::cos(lean));
    check_five_axes(
        head,
        [&](const Vector3& p, double b, double c) -> Vector3 {
          return p + 230 * about(ez, c) * about(axis, b) * ez - 150 * ez;
        },
        [&](double b, double c) -> Vector3 { return about(ez, c) * about(axis, b) * ez; });
  }
  const auto beyond = NutatingHead{.lean = 0.4}.angles({std::sin(0.9), 0, std::cos(0.9)});
  CHECK(std::isnan(beyond[0][0]));
}

TEST_CASE("CoreXY, the table of slides, and SCARA arms", "[machines]") {
  check(examine(CoreXY{}, BasicCoreXY<long double>{}, {-300, -300, -50}, {300, 300, 50}, 300, 0, 0));
  check(examine(PolarMap{}, BasicPolarMap<long double>{}, {40, -50, -3}, {300, 50, 3}, 300, 0b100, 0));
  for (const bool left : {false, true}) {
    const double from = left ? -2.8 : 0.3, to = left ? -0.3 : 2.8;
    const Scara arm{.upper = 220, .fore = 160, .left = left};
    check(examine(arm, BasicScara<long double>{.upper = 220, .fore = 160, .left = left}, {-3, from, 0},
                  {3, to, 200}, 300, 0b11, 0));
    const ScaraWrist wrist{.arm = arm};
    check(examine(wrist, BasicScaraWrist<long double>{.arm = {.upper = 220, .fore = 160, .left = left}},
                  {-3, from, 0, -3}, {3, to, 200, 3}, 300, 0b1011, 0b1000));
    const auto p = arm.point(std::array{0.3, left ? -0.5 : 0.5, 7.0});
    CHECK(p[0] == Approx(220 * std::cos(0.3) + 160 * std::cos(left ? -0.2 : 0.8)));
    CHECK(p[1] == Approx(220 * std::sin(0.3) + 160 * std::sin(left ? -0.2 : 0.8)));
    // The elbow's side of the way to the tool.
    const double side = 220 * std::cos(0.3) * p[1] - 220 * std::sin(0.3) * p[0];
    CHECK((side > 0) == !left);
  }
  CHECK(std::isnan(Scara{}.joints(std::array{350.1, 0.0, 0.0})[1]));
  CHECK(std::isnan(Scara{}.joints(std::array{49.9, 0.0, 0.0})[1]));
}

TEST_CASE("rods of deltas and five-bars keep their length", "[machines]") {
  test::Random random;
  const LinearDelta linear{.radius = 140, .rod = 300};
  check(examine(linear, BasicLinearDelta<long double>{.radius = 140, .rod = 300}, {200, 200, 200},
                {280, 280, 280}, 300, 0, 0));
  const RotaryDelta rotary{};
  check(examine(rotary, BasicRotaryDelta<long double>{}, {-0.4, -0.4, -0.4}, {1, 1, 1}, 300, 0b111, 0));
  const FiveBar bar{};
  check(examine(bar, BasicFiveBar<long double>{}, {1.7, 0.3, 0}, {2.6, 1.4, 50}, 300, 0b11, 0));
  double off = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vector3 p(random.uniform(-80, 80), random.uniform(-80, 80), random.uniform(-300, -200));
    const std::array at{p.x(), p.y(), p.z()};
    const auto heights = linear.joints(at), arms = rotary.joints(at);
    for (int k = 0; k < 3; ++k) {
      const auto j = static_cast<std::size_t>(k);
      const double angle = pi / 2 + k * 2 * pi / 3;
      const Vector3 out(std::cos(angle), std::sin(angle), 0);
      off = std::max(off, std::abs((140 * out + heights[j] * ez - p).norm() - 300));
      CHECK(heights[j] > p.z());
      const Vector3 elbow = (120 + 150 * std::cos(arms[j])) * out - 150 * std::sin(arms[j]) * ez;
      off = std::max(off, std::abs((elbow - p - 40 * out).norm() - 320));
    }
    const Vector3 tool(random.uniform(-60, 60), random.uniform(180, 260), 5);
    const auto motors = bar.joints(std::array{tool.x(), tool.y(), 5.0});
    for (int k = 0; k < 2; ++k) {
      const double at_x = k == 0 ? -60 : 60, q = motors[static_cast<std::size_t>(k)];
      const Vector3 elbow(at_x + 150 * std::cos(q), 150 * std::sin(q), 5);
      off = std::max(off, std::abs((elbow - tool).norm() - 200));
    }
    CHECK(60 + 150 * std::cos(motors[1]) > -60 + 150 * std::cos(motors[0]));
  }
  CHECK(off < 1e-10);
  CHECK(std::isnan(linear.joints(std::array{500.0, 0.0, 0.0})[0]));
}

TEST_CASE("the arm with a wrist is a chain of six rotations", "[machines]") {
  for (const bool down : {false, true})
    for (const bool turned_wrist : {false, true}) {
      const WristArm arm{.elbow_down = down, .wrist_turned = turned_wrist};
      BasicWristArm<long double> exact{.elbow_down = down, .wrist_turned = turned_wrist};
      const double bend = turned_wrist ? -1 : 1, fold = down ? -1.6 : 0.3;
      Joints<WristArm> low{-2, -0.2, fold - 0.3, -2, 0.4 * bend, -2},
          high{2, 0.9, fold + 0.5, 2, 1.2 * bend, 2};
      if (down) low = {-2, 0.8, -2.6, -2, 0.4 * bend, -2}, high = {2, 1.5, -1.9, 2, 1.2 * bend, 2};
      check(examine(arm, exact, low, high, 1000, 0b111111, 0b111000), 1e-5);
    }
  const WristArm arm{};
  test::Random random;
  double place = 0, orientation = 0;
  for (int i = 0; i < 1000; ++i) {
    std::array<double, 6> q{};
    for (double& angle : q) angle = random.uniform(-1.4, 1.4);
    const auto p = arm.point(q);
    const Rotation base = about(ez, q[0]), upper = base * about(ey, q[1]), fore = upper * about(ey, q[2]);
    const Rotation flange = fore * about(ex, q[3]) * about(ey, q[4]) * about(ey, pi / 2) * about(ez, q[5]);
    const Vector3 tip =
        400 * ez + base * (25 * ex) + upper * (560 * ez) + fore * (515 * ex + 35 * ez) + flange * (80 * ez);
    place = std::max(place, (tip - first_three(p)).norm());
    const Rotation told = about(ez, p[5]) * about(ey, p[4]) * about(ex, p[3]);
    orientation = std::max(orientation, (told - flange).norm());
  }
  CHECK(place < 1e-11);
  CHECK(orientation < 1e-12);
}

TEST_CASE("ready-made machines are maps with an inverse, of any number", "[machines]") {
  using path::InvertibleMap, path::switchable;
  STATIC_REQUIRE(InvertibleMap<TableTableAC> && InvertibleMap<BasicTableTableAC<float>>);
  STATIC_REQUIRE(InvertibleMap<TableTableBC> && InvertibleMap<HeadTable> && InvertibleMap<NutatingHead>);
  STATIC_REQUIRE(InvertibleMap<HeadHeadAC> && InvertibleMap<HeadHeadBC> && InvertibleMap<CoreXY>);
  STATIC_REQUIRE(InvertibleMap<Scara> && InvertibleMap<ScaraWrist> && InvertibleMap<LinearDelta>);
  STATIC_REQUIRE(InvertibleMap<RotaryDelta> && InvertibleMap<FiveBar> && InvertibleMap<WristArm>);
  STATIC_REQUIRE(InvertibleMap<PolarMap> && InvertibleMap<BasicWristArm<float>>);
  STATIC_REQUIRE(switchable<TableTableAC> && switchable<NutatingHead> && !switchable<Scara>);
  STATIC_REQUIRE(path::check_map<TableTableAC>() && path::check_map<WristArm>());
}
