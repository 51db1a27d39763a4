#include "cncplan/path/spline.hpp"

#include <array>
#include <cmath>

#include "cncplan/path/segment.hpp"
#include "support/catch.hpp"
#include "support/path_by_length_laws.hpp"

using namespace cncplan;
using namespace cncplan::path;

namespace {

using Wide = long double;

/// The definition, with Bernstein's polynomials.
template <int N>
VectorN<Wide, N> by_definition(const RationalCubic<N>& curve, Wide u) {
  const Wide v = 1 - u;
  const std::array<Wide, 4> bernstein{v * v * v, 3 * u * v * v, 3 * u * u * v, u * u * u};
  const std::array<Wide, 4> weights{1, curve.weights()[0], curve.weights()[1], 1};
  VectorN<Wide, N> sum = VectorN<Wide, N>::Zero();
  Wide weight = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    sum += curve.controls()[i].template cast<Wide>() * bernstein[i] * weights[i];
    weight += bernstein[i] * weights[i];
  }
  return sum / weight;
}

/// Controls near an even run from one place to another, in the first two axes or in all.
template <int N>
RationalCubic<N> random_curve(test::Random& random, bool rational) {
  typename RationalCubic<N>::Controls controls;
  for (int axis = 0; axis < N; ++axis) controls[0][axis] = random.uniform(-100, 100);
  for (std::size_t i = 1; i < 4; ++i) {
    controls[i] = controls[i - 1];
    controls[i][0] += 10;
    for (int axis = 0; axis < N; ++axis) controls[i][axis] += random.uniform(-3, 3);
  }
  const auto weight = [&] { return rational ? random.uniform(0.7, 1.4) : 1.0; };
  const double second = weight(), third = weight();
  return RationalCubic<N>(controls, second, third);
}

template <int N>
void check_splines() {
  test::Random random;
  for (const bool rational : {false, true}) {
    test::PathByLengthErrors worst;
    for (int i = 0; i < 15; ++i) {
      const auto curve = random_curve<N>(random, rational);
      const auto path = spline(curve);
      REQUIRE(path);
      REQUIRE(path->position_at(0) == curve.controls()[0]);
      REQUIRE(path->position_at(path->length()) == curve.controls()[3]);
      Wide length = 0;
      constexpr int chords = 1000;
      for (int k = 0; k < chords; ++k)
        length += (by_definition(curve, Wide(k + 1) / chords) - by_definition(curve, Wide(k) / chords))
                      .template head<std::min(N, 3)>()
                      .norm();
      REQUIRE(path->length() == Approx(static_cast<double>(length)).epsilon(1e-5));
      for (const double part : {0.1, 0.37, 0.5, 0.93}) {
        const double u = path->parameter_at(part * path->length());
        REQUIRE((path->position(u).template cast<Wide>() - by_definition(curve, u)).norm() < 1e-13L * 300);
      }
      worst.worst_of(test::path_by_length_errors(*path, 6, random));
      const BasicSegment<double, N, Spline<N>> segment(*path);
      worst.worst_of(test::path_by_length_errors(segment, 6, random));
    }
    test::check_path_by_length(worst, "splines of " + std::to_string(N), 1e-9, 1e-6, 3);
  }
}

}  // namespace

static_assert(Path<Spline<2>> && Path<BasicSpline<float, 3>> && EnclosedPath<Spline<6>>);
static_assert(sizeof(Spline<3>) <= sizeof(Arc) && sizeof(Spline<6>) <= sizeof(BasicArcAlong<double, 6>),
              "no block is larger for the sake of splines");

TEST_CASE("pieces of splines keep the laws of paths", "[path]") {
  check_splines<2>();
  check_splines<3>();
  check_splines<6>();
}

TEST_CASE("a quarter circle as a rational cubic has its radius everywhere", "[path]") {
  // A quadratic with the weight cos 45 degrees, raised by a degree.
  const double half = std::sqrt(0.5), weight = (1 + 2 * half) / 3;
  const Vector3 a(10, 0, 5), corner(10, 10, 5), b(0, 10, 5);
  const Vector3 second = (a + 2 * half * corner) / (3 * weight),
                third = (b + 2 * half * corner) / (3 * weight);
  const auto path = spline(RationalCubic<3>({a, second, third, b}, weight, weight));
  REQUIRE(path);
  CHECK(path->length() == Approx(5 * 3.14159265358979324).epsilon(1e-13));
  for (double part = 0; part <= 1; part += 0.01) {
    const auto at = path->point_at(part * path->length());
    CHECK(std::hypot(at.position.x(), at.position.y()) == Approx(10).epsilon(1e-14));
    CHECK(at.second.norm() == Approx(0.1).epsilon(1e-11));
  }
  const double length = path->length();
  CHECK(path->bounds(0, length).tool.second_across >= 0.1);
  CHECK(path->bounds(0, length).tool.second_across < 0.6);
  CHECK(path->bounds(0.3 * length, 0.5 * length).tool.second_across < 0.105);
}

TEST_CASE("curves that stand still are refused, and straight ones known", "[path]") {
  const Vector3 a(1, 2, 3), b(2, 3, 3), c(4, 5, 3), d(7, 8, 3), off(4, 6, 3);
  CHECK(is_straight(RationalCubic<3>({a, b, c, d})));
  CHECK(is_straight(RationalCubic<3>({a, a, c, d}, 2, 0.5)));
  CHECK_FALSE(is_straight(RationalCubic<3>({a, b, off, d})));
  CHECK_FALSE(is_straight(RationalCubic<3>({a, d, c, b})));  // goes back
  CHECK_FALSE(is_straight(RationalCubic<3>({a, b, c, a})));
  const auto still = spline(RationalCubic<3>({a, a, off, d}));
  REQUIRE_FALSE(still);
  CHECK(still.error().code == ErrorCode::not_positive);
}
