// The fastest motion along a path against an optimum on a grid, by linear programs of its own.
#include "cncplan/time_optimal.hpp"

#include <Clp_C_Interface.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/path/measured.hpp"
#include "cncplan/path/spline_through.hpp"
#include "support/catch.hpp"
#include "support/half_ellipse.hpp"

using namespace cncplan;
using cncplan::MotionLimits;

namespace {

/// The least time from a speed to the same speed under equal limits of X and Y, in b = v^2 at nodes of equal
/// distance. Of
///
///     |q''' b + 3/2 q'' b' + q' b''/2| <= J / sqrt(b)
///
/// the right side is convex, so that its tangent lies below it: each linear program keeps the limit, and
/// begins where the last one ended.
template <class P>
double least_time(const P& path, const Limits& limits, double speed, int nodes) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const int n = nodes;
  const double h = path.length() / (n - 1);
  std::vector<double> b(static_cast<std::size_t>(n), speed * speed);
  std::vector<PathPoint<Vector3>> points;
  for (int i = 0; i < n; ++i) points.push_back(path.point_at(h * i));
  const auto time = [&] {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < b.size(); ++i) sum += 2 * h / (std::sqrt(b[i]) + std::sqrt(b[i + 1]));
    return sum;
  };
  double last = time(), trust = 1.5;  // by which factor b may change at once
  for (int round = 0; round < 200 && trust > 1 + 1e-4; ++round) {
    std::vector<double> lower(b.size()), upper(b.size()), cost(b.size());
    for (std::size_t i = 0; i < b.size(); ++i) {
      double most = b[i] * trust;
      for (const int axis : {0, 1}) {
        const double rate = std::abs(points[i].first[axis]);
        if (rate > 1e-9) most = std::min(most, std::pow(limits.velocity / rate, 2));
      }
      lower[i] = b[i] / trust;
      upper[i] = most;
      const double root = std::sqrt(b[i]);
      for (const int side : {-1, 1}) {
        const std::size_t k = i + static_cast<std::size_t>(side);  // wraps below 0
        if (k < b.size()) cost[i] -= h / root / std::pow(root + std::sqrt(b[k]), 2);
      }
    }
    for (const std::size_t i : {std::size_t{0}, std::size_t{1}, b.size() - 2, b.size() - 1})
      lower[i] = upper[i] = speed * speed;  // without acceleration
    std::vector<CoinBigIndex> starts{0};
    std::vector<int> columns;
    std::vector<double> elements, row_lower, row_upper;
    const auto row = [&](std::size_t i, double left, double own, double right, double low, double high) {
      int column = static_cast<int>(i) - 1;
      for (const double element : {left, own, right}) {
        if (std::abs(element) > 1e-9) columns.push_back(column), elements.push_back(element);  // not rounding
        ++column;
      }
      starts.push_back(static_cast<CoinBigIndex>(columns.size()));
      row_lower.push_back(low);
      row_upper.push_back(high);
    };
    for (std::size_t i = 1; i + 1 < b.size(); ++i)
      for (const int axis : {0, 1}) {
        const double first = points[i].first[axis], second = points[i].second[axis],
                     third = points[i].third[axis];
        const double slope = 1.5 * second / (2 * h), bend = first / (2 * h * h), root = std::sqrt(b[i]);
        const double falls = limits.jerk / (2 * b[i] * root), most = 1.5 * limits.jerk / root;
        row(i, bend - slope, third - 2 * bend + falls, bend + slope, -infinity, most);
        row(i, bend - slope, third - 2 * bend - falls, bend + slope, -most, infinity);
        row(i, -first / (4 * h), second, first / (4 * h), -limits.acceleration, limits.acceleration);
      }
    const std::unique_ptr<Clp_Simplex, void (*)(Clp_Simplex*)> model(Clp_newModel(), Clp_deleteModel);
    Clp_setLogLevel(model.get(), 0);
    const std::vector<CoinBigIndex> none(b.size() + 1, 0);
    Clp_addColumns(model.get(), n, lower.data(), upper.data(), cost.data(), none.data(), nullptr, nullptr);
    Clp_addRows(model.get(), static_cast<int>(row_lower.size()), row_lower.data(), row_upper.data(),
                starts.data(), columns.data(), elements.data());
    Clp_dual(model.get(), 0);
    if (Clp_status(model.get()) != 0) Clp_primal(model.get(), 0);  // rounding may have stopped it
    if (Clp_status(model.get()) != 0) return infinity;
    const double* const x = Clp_primalColumnSolution(model.get());
    const std::vector<double> before = b;
    std::copy(x, x + n, b.begin());
    const double now = time();
    if (now < last * (1 - 1e-7)) {
      last = now;
    } else {
      b = before;
      trust = std::sqrt(trust);
    }
  }
  return time();
}

template <class P>
void check(const P& path, const Limits& limits, double speed) {
  MotionLimits<3> of_axes;
  of_axes.tool = {1e9, 1e12, 1e15};
  for (Limits& own : of_axes.axes) own = limits;
  const auto motion = time_optimal(path, of_axes, {.start_velocity = speed, .end_velocity = speed});
  REQUIRE(motion);
  // Its error falls with the distance of the nodes: the two at each end have no acceleration.
  const double coarse = least_time(path, limits, speed, 501), fine = least_time(path, limits, speed, 1501);
  const double optimum = fine + (fine - coarse) / 2;
  CHECK(coarse < 1.02 * fine);
  CAPTURE(optimum, motion->duration());
  CHECK(motion->duration() < optimum * 1.005);
  CHECK(motion->duration() > optimum * 0.995);
}

}  // namespace

TEST_CASE("time optimal: half a circle and half an ellipse, as linear programs find them") {
  const auto circle =
      path::arc_from_center(Vector3(0, 0, 0), {20, 0, 0}, {10, 0, 0}, Turn::clockwise, Plane::xy);
  REQUIRE(circle);
  check(*circle, {.velocity = 50, .acceleration = 300, .jerk = 2000}, 5);
  const auto ellipse = path::measured(test::HalfEllipse{20, 8});
  REQUIRE(ellipse);
  check(*ellipse, {.velocity = 30, .acceleration = 1000, .jerk = 1e4}, 6);
}

TEST_CASE("time optimal: a spline of which the third derivative jumps, as linear programs find it") {
  const std::vector<Vector3> points{{0, 0, 0}, {12, 9, 0}, {25, 7, 0}, {31, -6, 0}, {45, -2, 0}};
  const auto spline = path::SplineThrough<3>::make(points);
  REQUIRE(spline);
  check(*spline, {.velocity = 60, .acceleration = 400, .jerk = 2500}, 5);
}
