#include "cncplan/path/bezier.hpp"

#include "cncplan/path/arc_length_table.hpp"
#include "support/catch.hpp"
#include "support/path_laws.hpp"
#include "support/random.hpp"

using namespace cncplan;
using path::BasicBezier;

namespace {

template <class S, int Degree>
BasicBezier<S, Degree> random_bezier(test::Random& random) {
  typename BasicBezier<S, Degree>::Controls controls;
  for (int i = 0; i <= Degree; ++i)  // one after the other in X, so that the curve never stands still
    controls[static_cast<std::size_t>(i)] = {static_cast<S>(10 * i + random.uniform(-3, 3)),
                                             static_cast<S>(random.uniform(-10, 10)),
                                             static_cast<S>(random.uniform(-10, 10))};
  return BasicBezier<S, Degree>(controls);
}

template <class S, int Degree>
void check_laws() {
  test::Random random;
  test::PathLawErrors worst;
  for (int i = 0; i < 40; ++i)
    worst.worst_of(test::path_law_errors(path::ArcLengthTable(random_bezier<S, Degree>(random)), 0.2));
  test::check_path_laws(worst, "Bezier of degree " + std::to_string(Degree));
}

}  // namespace

TEMPLATE_TEST_CASE("Bezier curves obey the laws of paths", "", float, double) {
  check_laws<TestType, 2>();
  check_laws<TestType, 3>();
  check_laws<TestType, 5>();
}

TEST_CASE("A Bezier curve is the sum of K17's Bernstein polynomials") {
  test::Random random;
  const auto curve = random_bezier<double, 5>(random);
  double worst = 0;
  for (const double u : {0.0, 0.1, 0.37, 0.5, 0.93, 1.0}) {
    Vector3 sum = Vector3::Zero();
    constexpr std::array binomial{1.0, 5.0, 10.0, 10.0, 5.0, 1.0};
    for (std::size_t i = 0; i <= 5; ++i)
      sum += binomial[i] * std::pow(1 - u, 5.0 - static_cast<double>(i)) *
             std::pow(u, static_cast<double>(i)) * curve.controls()[i];
    worst = std::max(worst, (curve.position(u) - sum).norm());
  }
  CHECK(worst < 2e-14);
  CHECK(curve.position(0.0) == curve.controls().front());
  CHECK(curve.position(1.0) == curve.controls().back());
  CHECK(curve.position(2.0) == curve.controls().back());
}

TEST_CASE("The length of a parabola is the closed form") {
  const BasicBezier<double, 2> parabola({Vector3(0, 0, 0), Vector3(0.5, 0, 0), Vector3(1, 1, 0)});  // y = x^2
  CHECK(parabola.length() == Approx(std::sqrt(5.0) / 2 + std::asinh(2.0) / 4).epsilon(1e-15));
}
