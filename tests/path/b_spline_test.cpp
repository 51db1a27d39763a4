#include "cncplan/path/b_spline.hpp"

#include <array>
#include <type_traits>
#include <vector>

#include "cncplan/path/arc_length_table.hpp"
#include "support/catch.hpp"
#include "support/path_laws.hpp"
#include "support/random.hpp"

using namespace cncplan;
using path::BasicBSpline;

// Controls are lent: by what outlives the expression.
using Cubic = path::BSpline<3>;
static_assert(std::is_constructible_v<Cubic, std::vector<Vector3>&>);
static_assert(std::is_constructible_v<Cubic, std::span<Vector3>>);
static_assert(!std::is_constructible_v<Cubic, std::vector<Vector3>>);
static_assert(!std::is_constructible_v<Cubic, const std::array<Vector3, 4>>);
static_assert(std::is_constructible_v<Cubic, const Cubic>);

namespace {

template <class S>
std::vector<BasicVector3<S>> random_controls(test::Random& random, int count) {
  std::vector<BasicVector3<S>> controls;
  for (int i = 0; i < count; ++i)
    controls.emplace_back(static_cast<S>(10 * i + random.uniform(-3, 3)),
                          static_cast<S>(random.uniform(-10, 10)), static_cast<S>(random.uniform(-10, 10)));
  return controls;
}

template <class S, int Degree>
void check_laws() {
  test::Random random;
  test::PathLawErrors worst;
  for (int i = 0; i < 40; ++i) {
    // one piece: at knots a quadratic's second derivative jumps, and the law's differences would see it
    const auto controls = random_controls<S>(random, Degree + 1);
    worst.worst_of(test::path_law_errors(
        path::ArcLengthTable(BasicBSpline<S, Degree>(std::span<const BasicVector3<S>>(controls))), 0.5));
  }
  test::check_path_laws(worst, "B-spline of degree " + std::to_string(Degree));
}

/// The basis by the recursion of Cox and de Boor: another way to the same weights.
double basis(int degree, double x) {  // support [0, degree + 1]
  if (degree == 0) return x >= 0 && x < 1 ? 1.0 : 0.0;
  return (x * basis(degree - 1, x) + (degree + 1 - x) * basis(degree - 1, x - 1)) / degree;
}

}  // namespace

TEST_CASE("The basis matrices are the printed ones") {
  using Row2 = std::array<std::int64_t, 2>;
  using Row3 = std::array<std::int64_t, 3>;
  using Row4 = std::array<std::int64_t, 4>;
  using Row5 = std::array<std::int64_t, 5>;
  CHECK(path::b_spline_matrix<1>() == std::array{Row2{-1, 1}, Row2{1, 0}});
  CHECK(path::b_spline_matrix<2>() == std::array{Row3{1, -2, 1}, Row3{-2, 2, 0}, Row3{1, 1, 0}});
  CHECK(path::b_spline_matrix<3>() ==
        std::array{Row4{-1, 3, -3, 1}, Row4{3, -6, 3, 0}, Row4{-3, 0, 3, 0}, Row4{1, 4, 1, 0}});
  CHECK(path::b_spline_matrix<4>() == std::array{Row5{1, -4, 6, -4, 1}, Row5{-4, 12, -12, 4, 0},
                                                 Row5{6, -6, -6, 6, 0}, Row5{-4, -12, 12, 4, 0},
                                                 Row5{1, 11, 11, 1, 0}});
}

TEMPLATE_TEST_CASE_SIG("Weights are those of the recursion of Cox and de Boor, at any degree", "",
                       ((int N), N), 1, 2, 3, 4, 5, 7) {
  double worst = 0;
  for (int i = 0; i < 50; ++i) {
    const double t = i / 50.0;
    const path::BSplineWeights<double, N> weights(t);
    for (int j = 0; j <= N; ++j)
      worst = std::max(worst, std::abs(weights.position[static_cast<std::size_t>(j)] - basis(N, t + N - j)));
  }
  CHECK(worst < 1e-13);
}

TEMPLATE_TEST_CASE("B-splines obey the laws of paths", "", float, double) {
  check_laws<TestType, 2>();
  check_laws<TestType, 3>();
  check_laws<TestType, 5>();
}

TEST_CASE("A cubic B-spline is continuous to its second derivative at knots") {
  test::Random random;
  const auto controls = random_controls<double>(random, 9);
  const path::BSpline<3> spline(controls);
  REQUIRE(spline.pieces() == 6);
  for (int knot = 1; knot < 6; ++knot) {
    const auto before = spline.at(std::nextafter(static_cast<double>(knot), 0.0));
    const auto behind = spline.at(static_cast<double>(knot));
    CHECK((before.position - behind.position).norm() < 1e-13);
    CHECK((before.first - behind.first).norm() < 1e-13);
    CHECK((before.second - behind.second).norm() < 1e-12);
  }
}

TEST_CASE("Control points on a line make a line at constant speed") {
  std::vector<Vector3> controls;
  for (int i = 0; i < 7; ++i) controls.emplace_back(3.0 * i, 4.0 * i, 0.0);
  const path::BSpline<3> spline(controls);
  CHECK(spline.length() == Approx(20.0).epsilon(1e-15));
  CHECK((spline.derivative(1.7) - Vector3(3, 4, 0)).norm() < 1e-14);
}

TEST_CASE("A B-spline of too few control points is refused") {
  test::Random random;
  const auto controls = random_controls<double>(random, 5);
  const std::span<const Vector3> all(controls);
  CHECK(Cubic::make({}).error() == Error{ErrorCode::below_limit, "number of control points", 0, 4});
  CHECK(Cubic::make(all.first(3)).error() == Error{ErrorCode::below_limit, "number of control points", 3, 4});
  CHECK(Cubic::make(all.first(4))->pieces() == 1);
  CHECK(Cubic::make(controls)->length() == Cubic(controls).length());
}
