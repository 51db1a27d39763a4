#include <array>
#include <cmath>
#include <numbers>

#include "cncplan/path/mapped.hpp"
#include "cncplan/path/measured.hpp"
#include "cncplan/path/part.hpp"
#include "cncplan/path/segment.hpp"
#include "cncplan/path/straight_in_joints.hpp"
#include "random_arcs.hpp"
#include "support/catch.hpp"
#include "support/curves.hpp"
#include "support/path_by_length_laws.hpp"

using namespace cncplan;
using namespace cncplan::path;

namespace {

template <class S>
constexpr double rounding = sizeof(S) == 4 ? 2e-4 : 1e-11;
template <class S>
constexpr double difference = sizeof(S) == 4 ? 2e-3 : 1e-7;

template <class S, int N>
VectorN<S, N> place(test::Random& random, double size = 100) {
  VectorN<S, N> result;
  for (int i = 0; i < N; ++i) result[i] = static_cast<S>(random.uniform(-size, size));
  return result;
}

template <class S, int N>
void check_lines() {
  test::Random random;
  test::PathByLengthErrors worst;
  for (int i = 0; i < 30; ++i) {
    const auto start = place<S, N>(random), end = place<S, N>(random);
    const BasicLine<S, N> line(start, end);
    REQUIRE(line.position_at(S(0)) == start);
    REQUIRE(line.position_at(line.length()) == end);
    worst.worst_of(test::path_by_length_errors(line, static_cast<double>(line.length()), random));
  }
  test::check_path_by_length(worst, "lines of " + std::to_string(N), rounding<S>, difference<S>);
}

}  // namespace

static_assert(Path<BasicLine<float, 1>> && Path<BasicArc<float>> && Path<BasicArcAlong<float, 6>>);
static_assert(Path<Measured<test::Ellipse>> && Path<Mapped<test::Scara, Line<3>>>);
static_assert(Path<StraightInJoints<test::Scara>> && Path<Segment<5>>);

TEMPLATE_TEST_CASE("lines keep the laws of paths", "[path]", float, double) {
  check_lines<TestType, 1>();
  check_lines<TestType, 2>();
  check_lines<TestType, 3>();
  check_lines<TestType, 5>();
}

TEST_CASE("a line that only rotary axes move, and one that goes nowhere", "[path]") {
  using V = VectorN<double, 5>;
  test::Random random;
  const Line<5> turns(V(1, 2, 3, 0, 0), V(1, 2, 3, 0.3, -0.4));
  CHECK(turns.length() == Approx(0.5));
  CHECK(turns.bounds(0, 0.5).tool.first == 0);
  test::check_path_by_length(test::path_by_length_errors(turns, 0.5, random, false), "turns", 1e-11, 1e-7);
  const Line<5> nowhere(V(1, 2, 3, 4, 5), V(1, 2, 3, 4, 5));
  CHECK(nowhere.length() == 0);
  CHECK(nowhere.point_at(0).position == V(1, 2, 3, 4, 5));
  CHECK(nowhere.point_at(0).first.isZero());
  CHECK(nowhere.bounds(0, 0).first.isZero());
}

TEMPLATE_TEST_CASE("arcs keep the laws of paths", "[path]", float, double) {
  using S = TestType;
  test::Random random;
  for (const auto kind : {test::ArcKind::circle, test::ArcKind::helix, test::ArcKind::slight_spiral,
                          test::ArcKind::spiral, test::ArcKind::conical_helix}) {
    test::PathByLengthErrors worst;
    for (int i = 0; i < test::cases(40); ++i) {
      const auto arc = test::random_arc<S>(random, kind);
      INFO(test::describe(arc));
      REQUIRE(arc.position_at(S(0)) == arc.start());
      REQUIRE(arc.position_at(arc.length()) == arc.end());
      const double unit = static_cast<double>(std::min(arc.start_radius(), arc.end_radius()));
      worst.worst_of(test::path_by_length_errors(arc, unit, random));
    }
    test::check_path_by_length(worst, "kind of arc " + std::to_string(static_cast<int>(kind)), rounding<S>,
                               difference<S>);
  }
}

namespace {

template <int N>
void check_arcs_along() {
  test::Random random;
  test::PathByLengthErrors worst;
  for (int i = 0; i < test::cases(40); ++i) {
    const auto arc = test::random_arc<double>(
        random, test::arc_kinds[static_cast<std::size_t>(random.integer(0, N == 2 ? 0 : 4))]);
    if (N == 2 && axes(arc.plane()).third != 2) continue;
    auto start = place<double, N>(random), end = place<double, N>(random);
    constexpr int shared = std::min(N, 3);
    start.template head<shared>() = arc.start().template head<shared>();
    end.template head<shared>() = arc.end().template head<shared>();
    const BasicArcAlong<double, N> along(arc, start, end);
    INFO(test::describe(arc));
    REQUIRE(along.position_at(0) == start);
    REQUIRE(along.position_at(along.length()) == end);
    const double unit = std::min(arc.start_radius(), arc.end_radius());
    worst.worst_of(test::path_by_length_errors(along, unit, random));
    // A segment is the same path.
    if constexpr (N != 3) {
      const Segment<N> segment(along);
      const double s = 0.3 * along.length();
      REQUIRE(segment.length() == along.length());
      REQUIRE(segment.point_at(s).third == along.point_at(s).third);
      REQUIRE(segment.bounds(0, s).third == along.bounds(0, s).third);
      REQUIRE(segment.box() == along.box());
    }
  }
  test::check_path_by_length(worst, "arcs with others along, axes: " + std::to_string(N), 1e-11, 1e-7);
}

}  // namespace

TEST_CASE("arcs with other axes along keep the laws of paths", "[path]") {
  check_arcs_along<2>();
  check_arcs_along<4>();
  check_arcs_along<5>();
  check_arcs_along<6>();
}

TEST_CASE("curves of one's own keep the laws of paths", "[path]") {
  test::Random random;
  const auto check = [&](const auto& curve, double unit, const char* what) {
    const auto path = measured(curve);
    REQUIRE(path);
    const auto at = curve.point(0.0);
    const auto start = path->position_at(0);
    for (std::size_t i = 0; i < at.size(); ++i)
      REQUIRE(start[static_cast<Eigen::Index>(i)] == Approx(at[i]).epsilon(1e-15).margin(1e-15));
    const auto last = curve.point(curve.parameter_end());
    const auto end = path->position_at(path->length());
    for (std::size_t i = 0; i < last.size(); ++i)
      REQUIRE(end[static_cast<Eigen::Index>(i)] == Approx(last[i]).epsilon(1e-15).margin(1e-14));
    test::check_path_by_length(test::path_by_length_errors(*path, unit, random), what, 1e-9, 1e-6, 0.1);
    using Curve = std::remove_cvref_t<decltype(curve)>;
    if constexpr (std::same_as<typename Curve::Vector, Vector3>) {
      const Segment<3, Measured<Curve>> segment(*path);
      test::check_path_by_length(test::path_by_length_errors(segment, unit, random), what, 1e-9, 1e-6, 0.1);
    }
  };
  check(test::Ellipse{}, 3.0, "an ellipse");
  check(test::SpaceCurve{}, 3.0, "a space curve");
  check(test::OnTable{}, 3.0, "a curve on a turning table");
}

// From outside: the ellipse's perimeter by the rapidly converging series in h = ((a-b)/(a+b))^2.
TEST_CASE("a measured half ellipse is as long as the series says", "[path]") {
  const long double a = 20, b = 8, h = (a - b) * (a - b) / ((a + b) * (a + b));
  long double sum = 0, term = 1;  // binomial(1/2, n)^2 h^n
  for (int n = 0; n < 60; ++n) {
    sum += term;
    const long double ratio = (0.5L - n) / (n + 1);
    term *= ratio * ratio * h;
  }
  const auto path = measured(test::Ellipse{});
  REQUIRE(path);
  CHECK(path->length() ==
        Approx(static_cast<double>(std::numbers::pi_v<long double> * (a + b) * sum / 2)).epsilon(1e-12));
}

TEST_CASE("curves that are no paths are refused", "[path]") {
  CHECK(measured(test::Cusp{}).error().code == ErrorCode::unreachable);
  CHECK(measured(test::Standing{}).error().code == ErrorCode::not_finite);
  CHECK(measured(test::Ellipse{.end = 0}).error().code == ErrorCode::not_positive);
}

TEST_CASE("parts of paths keep the laws of paths", "[path]") {
  test::Random random;
  const auto table = measured(test::OnTable{});
  REQUIRE(table);
  const double end = table->length();
  const Part<Measured<test::OnTable>> part(*table, 0.2 * end, 0.9 * end);
  CHECK(part.position_at(0) == table->position_at(0.2 * end));
  CHECK(part.tool_point_at(part.length()).position ==
        table->tool_point_at(0.2 * end + part.length()).position);
  test::check_path_by_length(test::path_by_length_errors(part, 3, random), "of a curve", 1e-9, 1e-6, 0.1);
  const auto arc = test::random_arc<double>(random, test::ArcKind::spiral);
  const Part<Arc> of_arc(arc, 0.3 * arc.length(), 0.6 * arc.length());
  const double unit = std::min(arc.start_radius(), arc.end_radius());
  test::check_path_by_length(test::path_by_length_errors(of_arc, unit, random), test::describe(arc), 1e-11,
                             1e-7);
}

namespace {

template <class M, class P>
void check_mapped(const M& map, const P& path, double unit, const char* what) {
  test::Random random;
  const Mapped<M, P> mapped(map, path);
  REQUIRE(mapped.length() == path.length());
  test::check_path_by_length(test::path_by_length_errors(mapped, unit, random), what, 1e-9, 1e-6);
  double worst = 0;
  for (int i = 0; i <= 100; ++i) {
    const double s = mapped.length() * i / 100;
    const auto tool = map.tool(mapped.position_at(s));
    worst = std::max(worst, (tool - mapped.tool_point_at(s).position).norm());
    worst = std::max(worst, (tool - path.position_at(s)).norm());
  }
  INFO(what);
  CHECK(worst < 1e-9);
}

}  // namespace

TEST_CASE("paths through a machine's map keep the laws of paths", "[path]") {
  const Line<3> line({250, -180, 0}, {120, 200, 30});
  check_mapped(test::Scara{}, line, 60, "a line, scara");
  check_mapped(test::TurningTable{}, line, 60, "a line, polar");
  ArcGeometry<double> g{
      .start = {250, 0, 0}, .end = {150, 0, 10}, .center = {200, 0, 0}, .radial = {50, 0, 0}};
  g.start_radius = g.end_radius = 50;
  g.angle = std::numbers::pi;
  for (const Turn turn : {Turn::clockwise, Turn::counterclockwise}) {
    g.turn = turn;
    check_mapped(test::Scara{}, Arc(g), 30, "a helix, scara");
    check_mapped(test::TurningTable{}, Segment<3>(Arc(g)), 30, "a helix, polar");
    auto spiral = g;
    spiral.end = {170, 0, 10};
    spiral.end_radius = 30;
    check_mapped(test::Scara{}, Arc(spiral), 20, "a spiral, scara");
  }
}

TEST_CASE("rapids straight in joints keep the laws of paths", "[path]") {
  test::Random random;
  const auto check = [&](const auto& map, const Vector3& from, const Vector3& to, const char* what) {
    const StraightInJoints path(map, from, to);
    INFO(what);
    CHECK(path.length() == Approx((to - from).norm()).epsilon(1e-14));
    CHECK(path.tool_point_at(path.length()).position == to);
    CHECK((path.tool_point_at(0).position - from).norm() < 1e-12 * from.norm());
    test::check_path_by_length(test::path_by_length_errors(path, 30, random, false), what, 1e-9, 1e-6, 0.1);
    double worst = 0, slope = 0;
    const double h = 1e-3 * path.length();
    for (int i = 0; i <= 100; ++i) {
      const double s = path.length() * i / 100;
      const auto at = path.tool_point_at(s);
      worst = std::max(worst, (map.tool(path.position_at(s)) - at.position).norm());
      if (i < 2 || i > 98) continue;
      const auto tool = [&](double x) { return map.tool(path.position_at(x)); };
      const Vector3 first =
          (8 * (tool(s + h) - tool(s - h)) - (tool(s + 2 * h) - tool(s - 2 * h))) / (12 * h);
      const Vector3 second =
          (16 * (tool(s + h) + tool(s - h)) - tool(s + 2 * h) - tool(s - 2 * h) - 30 * tool(s)) /
          (12 * h * h);
      slope = std::max({slope, (first - at.first).norm(), (second - at.second).norm()});
    }
    CHECK(worst < 1e-9);
    CHECK(slope < 1e-6);
  };
  check(test::Scara{}, {250, -180, 0}, {120, 200, 30}, "scara");
  check(test::Scara{}, {250, -180, 0}, {251, -180, 0}, "scara, a short way");
  check(test::TurningTable{}, {250, -180, 0}, {120, 200, 30}, "polar");
}

TEST_CASE("a rapid in joints that goes nowhere has no length", "[path]") {
  const StraightInJoints path(test::Scara{}, Vector3(250, -180, 0), Vector3(250, -180, 0));
  CHECK(path.length() == 0);
  CHECK((path.tool_point_at(0).position - Vector3(250, -180, 0)).norm() < 1e-12);
}
