// How fast the curvature vector of a spiral changes, against differences of that vector itself.
#include <algorithm>
#include <cmath>

#include "cncplan/core/vector.hpp"
#include "cncplan/path/spiral.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

using Real = long double;
using Vector = Eigen::Matrix<Real, 3, 1>;

struct Frame {
  Vector tangent, curvature;
  Real speed;
};

Frame frame(const path::Spiral<double>& spiral, Real angle) {
  const Real r = spiral.radius + spiral.growth * angle, k = spiral.growth, h = spiral.rise;
  const Real c = std::cos(angle), s = std::sin(angle);
  const Vector first(k * c - r * s, k * s + r * c, h);
  const Vector second(-2 * k * s - r * c, 2 * k * c - r * s, 0);
  const Real speed = first.norm();
  const Vector tangent = first / speed;
  return {tangent, (second - tangent * tangent.dot(second)) / (speed * speed), speed};
}

Real change(const path::Spiral<double>& spiral, Real angle) {
  const Real step = 1e-5L;
  const Frame here = frame(spiral, angle);
  const Vector rate = (frame(spiral, angle + step).curvature - frame(spiral, angle - step).curvature) /
                      (2 * step * here.speed);
  return (rate - here.tangent * here.tangent.dot(rate)).norm();
}

path::Spiral<double> draw(test::Random& random, double& end) {
  path::Spiral<double> spiral{random.log_uniform(0.1, 100), 0, 0};
  end = random.log_uniform(0.1, 30);
  if (random.integer(0, 3) > 0) spiral.growth = spiral.radius * random.log_uniform(1e-5, 10);
  if (random.coin()) spiral.growth = -std::min(spiral.growth, 0.9 * spiral.radius / end);
  if (random.integer(0, 3) > 0) spiral.rise = spiral.radius * random.log_uniform(1e-4, 100);
  return spiral;
}

}  // namespace

TEST_CASE("The change of a spiral's curvature is that of differences") {
  test::Random random;
  Real worst = 0;
  for (int i = 0; i < 20000; ++i) {
    double end = 0;
    const auto spiral = draw(random, end);
    const double angle = random.uniform(0, end);
    const Real wanted = change(spiral, angle);
    const Real scale = frame(spiral, angle).curvature.squaredNorm() + wanted;
    worst = std::max(
        worst, std::abs(path::curvature_change_at_radius(spiral, spiral.radius_at(angle)) - wanted) / scale);
  }
  CHECK(static_cast<double>(worst) < 1e-8);
}

TEST_CASE("The change of a helix's curvature is curvature times torsion, that of a circle zero") {
  const path::Spiral<double> helix{3, 0, 4};  // curvature 3/25, torsion 4/25
  CHECK(path::max_curvature_change(helix, 7.0) == Approx(12.0 / 625).epsilon(1e-14));
  CHECK(path::max_curvature_change(path::Spiral<double>{0.3, 0, 0}, 7.0) == 0);
}

TEST_CASE("The bound of the change of curvature holds all along a spiral, and is at most 4 percent above") {
  test::Random random;
  double below = 0, above = 0;
  for (int i = 0; i < test::cases(5000); ++i) {
    double end = 0;
    const auto spiral = draw(random, end);
    const double bound = path::max_curvature_change(spiral, end);
    if (bound == 0) continue;
    Real largest = 0;
    for (int k = 0; k <= 500; ++k) largest = std::max(largest, change(spiral, end * std::pow(k / 500.0, 3)));
    const double ratio = static_cast<double>(largest) / bound;
    if (bound > 1e-6 * std::pow(path::max_curvature(spiral, end), 2)) {  // else differences are rounding
      below = std::max(below, ratio);
      above = std::max(above, 1 / ratio);
    }
  }
  CHECK(below < 1 + 1e-4);
  CHECK(above < 1.04 + 1e-4);
}
