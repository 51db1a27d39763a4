// Splines through points of any number of axes: against a dense solution, a known curve, and as paths.
#include "cncplan/path/spline_through.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "cncplan/time_optimal.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;
using path::SplineThrough;

namespace {

constexpr int joints = 6;
using Vector = VectorN<double, joints>;
using Spline = SplineThrough<joints>;

// A spline that keeps its knots to itself.
struct Unsaid {
  using Scalar = double;
  using Vector = VectorN<double, joints>;

  const Spline& spline;

  double length() const { return spline.length(); }
  auto point_at(double u) const { return spline.point_at(u); }
  auto enclosure(double from, double to) const { return spline.enclosure(from, to); }
};

std::vector<Vector> random_points(test::Random& random, int count) {
  std::vector<Vector> points(static_cast<std::size_t>(count));
  for (Vector& point : points)
    for (double& coordinate : point) coordinate = random.uniform(-3, 3);
  return points;
}

// The third powers (u - knot)_+^3 and a straight line: the natural spline is the one combination of them that
// goes through the points and does not bend at both ends.
Vector dense(const std::vector<Vector>& points, const std::vector<double>& knots, double u) {
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(n + 2, n + 2), values = Eigen::MatrixXd::Zero(n + 2, joints);
  const auto powers = [&](double at, auto&& row) {
    row(0) = 1;
    row(1) = at;
    for (Eigen::Index k = 0; k < n; ++k)
      row(k + 2) = std::pow(std::max(at - knots[static_cast<std::size_t>(k)], 0.0), 3);
  };
  for (Eigen::Index i = 0; i < n; ++i) {
    powers(knots[static_cast<std::size_t>(i)], rows.row(i));
    values.row(i) = points[static_cast<std::size_t>(i)].transpose();
  }
  for (Eigen::Index k = 0; k < n; ++k)
    rows(n, k + 2) = 6 * (knots.back() - knots[static_cast<std::size_t>(k)]);
  rows(n + 1, n + 1) = 1;  // nothing begins at the end
  Eigen::VectorXd at(n + 2);
  powers(u, at);
  return (at.transpose() * rows.fullPivLu().solve(values)).transpose();
}

}  // namespace

TEST_CASE("a spline goes through its points as a dense solution does") {
  test::Random random;
  for (const int count : {2, 3, 4, 9}) {
    const auto points = random_points(random, count);
    std::vector<double> parameters{random.uniform(-5, 5)};
    while (parameters.size() < points.size())
      parameters.push_back(parameters.back() + random.uniform(0.3, 2));
    const auto spline = Spline::make(points, parameters);
    REQUIRE(spline);
    std::vector<double> knots;
    for (const double parameter : parameters) knots.push_back(parameter - parameters.front());
    CHECK(spline->length() == Approx(knots.back()));
    for (std::size_t i = 0; i < points.size(); ++i)
      CHECK((spline->position_at(spline->knots()[i]) - points[i]).norm() < 1e-13);
    for (double share = 0; share <= 1; share += 0.01) {
      const double u = share * knots.back();
      CHECK((spline->position_at(u) - dense(points, knots, u)).norm() < 1e-9);
    }
  }
}

TEST_CASE("a spline's derivatives are those of its positions, and its enclosures hold them") {
  test::Random random;
  const auto spline = Spline::make(random_points(random, 12));
  REQUIRE(spline);
  for (int i = 0; i < 300; ++i) {
    double from = random.uniform(0, spline->length()), to = random.uniform(0, spline->length());
    if (to < from) std::swap(from, to);
    const auto all = spline->enclosure(from, to);
    const double u = random.uniform(from, to), h = 1e-4;
    const auto at = spline->point_at(u);
    for (int axis = 0; axis < joints; ++axis) {
      const auto& own = all[static_cast<std::size_t>(axis)];
      constexpr double rounding = 1e-9;
      const auto holds = [&](const Interval& interval, double x) {
        return interval.low - rounding <= x && x <= interval.high + rounding;
      };
      CHECK(holds(own.value, at.position[axis]));
      CHECK(holds(own.first, at.first[axis]));
      CHECK(holds(own.second, at.second[axis]));
      CHECK(holds(own.third, at.third[axis]));
    }
    if (u < h || u > spline->length() - h) continue;
    const auto before = spline->point_at(u - h), behind = spline->point_at(u + h);
    CHECK((behind.position - before.position - 2 * h * at.first).norm() < 1e-9);
    CHECK((behind.first - before.first - 2 * h * at.second).norm() < 1e-4 * (1 + at.third.norm()));
  }
}

TEST_CASE("a spline through points that say nothing is refused") {
  const std::vector<Vector> one(1, Vector::Ones()), twice(2, Vector::Ones());
  std::vector<Vector> endless{Vector::Zero(), Vector::Ones()};
  endless[1][2] = std::numeric_limits<double>::infinity();
  const auto code = [](const std::vector<Vector>& points, const std::vector<double>& parameters = {}) {
    const auto spline = Spline::make(points, parameters);
    REQUIRE_FALSE(spline);
    return spline.error().code;
  };
  CHECK(code({}) == ErrorCode::below_limit);
  CHECK(code(one) == ErrorCode::below_limit);
  CHECK(code(twice) == ErrorCode::not_positive);
  CHECK(code(endless) == ErrorCode::not_finite);
  CHECK(code(twice, {0, 0}) == ErrorCode::not_positive);
  CHECK(code(twice, {1, 0}) == ErrorCode::not_positive);
  CHECK(code(twice, {0, std::nan("")}) == ErrorCode::not_finite);
  CHECK(code(twice, {0}) == ErrorCode::below_limit);
  CHECK(code(twice, {0, 1, 2}) == ErrorCode::above_limit);
  CHECK(Spline::make(twice, std::vector<double>{0, 1}));  // it stands still, over a parameter of one's own
}

TEST_CASE("a spline of six joints is driven in the least time that its limits allow") {
  test::Random random;
  const auto spline = Spline::make(random_points(random, 8));
  REQUIRE(spline);
  cncplan::MotionLimits<joints> limits;
  for (auto& own : limits.axes) own = {random.uniform(3, 6), random.uniform(5, 10), random.uniform(20, 40)};
  const auto motion = time_optimal(*spline, limits);
  REQUIRE(motion);
  const double step = motion->duration() / 20000;
  const auto place = [&](double t) { return spline->position_at(motion->at(t).position); };
  double most = 0;
  for (double t = 0; t + 3 * step <= motion->duration(); t += step) {
    const Vector a = place(t), b = place(t + step), c = place(t + 2 * step), d = place(t + 3 * step);
    for (int axis = 0; axis < joints; ++axis) {
      const Limits& own = limits.axes[static_cast<std::size_t>(axis)];
      most =
          std::max({most, std::abs(b[axis] - a[axis]) / step / own.velocity,
                    std::abs(c[axis] - 2 * b[axis] + a[axis]) / (step * step) / own.acceleration,
                    std::abs(d[axis] - 3 * c[axis] + 3 * b[axis] - a[axis]) / std::pow(step, 3) / own.jerk});
    }
  }
  CHECK(most < 1 + 1e-3);
  CHECK(most > 0.98);
  // A path that does not say where its third derivative jumps is run through slowly there.
  const auto unsaid = time_optimal(Unsaid{*spline}, limits);
  REQUIRE(unsaid);
  CHECK(motion->duration() < 0.95 * unsaid->duration());
  for (auto& own : limits.axes) own = {own.velocity * 1.03, own.acceleration * 1.03, own.jerk * 1.03};
  const auto faster = time_optimal(*spline, limits);
  REQUIRE(faster);
  CHECK(faster->duration() < 0.995 * motion->duration());  // 1 to 3 % less
  CHECK((place(motion->duration()) - spline->position_at(spline->length())).norm() < 1e-9);
}
