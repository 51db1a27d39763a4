// Curve and speed together: the derivatives are those of the cost by differences, and the time goes down.
#include "cncplan/detail/curve/coupled_window.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "support/catch.hpp"

namespace {

using namespace cncplan;
using namespace cncplan::detail;
using Both = VectorN<double, 4>;

// A bent curve over cells of uneven lengths in the middle of its tube, and a speed along it.
struct Example {
  std::vector<BasicBandCell<double, 3>> cells;
  std::vector<BasicBandSample<double, 3>> samples;
  std::vector<double> feeds, skews;
  std::vector<Vector3> points;
  std::vector<double> speeds;
  MotionLimits<3> limits;
  BasicBandProblem<double, 3> curve;
  BasicCoupledProblem<double, 3> problem;

  Example() {
    constexpr std::size_t count = 12;
    const auto length = [](std::size_t i) { return 0.02 + 0.01 * std::sin(1.7 * static_cast<double>(i)); };
    for (std::size_t i = 0; i < count + 3; ++i) {
      const auto x = static_cast<double>(i);
      points.emplace_back(0.02 * x, 2e-3 * std::sin(0.4 * x), 1e-3 * std::cos(0.5 * x));
      speeds.push_back(9 + std::sin(0.6 * x));
    }
    for (std::size_t i = 0; i < count; ++i) {
      BasicBandCell<double, 3> cell;
      cell.length = length(i + 2);
      cell.weights = path::cubic_weights<double>(
          {length(i), length(i + 1), length(i + 2), length(i + 3), length(i + 4)});
      cell.third = Vector3(0.3, -1, 2);
      cell.jerk_weight = 0.1;
      cell.first_sample = samples.size();
      for (const double share : {0.0, 0.5}) {
        BasicBandSample<double, 3> sample;
        sample.weights = path::weights_at(cell.weights, share * cell.length);
        for (std::size_t q = 0; q < 4; ++q) sample.target += sample.weights[q] * points[i + q];
        sample.target += Vector3(1e-3, -3e-3, 2e-3);
        sample.scale = Vector3::Constant(100);
        samples.push_back(sample);
      }
      cells.push_back(cell);
      feeds.push_back(5 + 0.3 * std::sin(static_cast<double>(i)));
      skews.push_back(0.1 * std::cos(static_cast<double>(i)));
    }
    cells.emplace_back().first_sample = samples.size();
    limits.tool = {30, 1000, 1e5};
    limits.axes[1] = {4.5, 400, 8e4};
    curve = {cells, samples, Vector3(1, 0.5, 2), 0};
    problem = {&curve, feeds, skews, &limits};
  }
};

TEST_CASE("the gradient of a joint window is that of its cost by differences") {
  const Example example;
  constexpr std::size_t first = 4, count = 6;
  std::vector<CoupledPlace<double>> places(3 * (count + 3));
  const CoupledWindow<double, 3> window(example.problem, first, count, places);
  const std::size_t low = window.first_cell(), end = window.last_cell();
  std::vector<Both> at;
  for (std::size_t i = low; i < end + 3; ++i) {
    at.emplace_back();
    at.back() << example.points[i], example.speeds[i];
  }
  constexpr double weight = 1e-4;
  const auto cost = [&] {
    const auto found = window.cost(at);
    REQUIRE(std::isfinite(found.barrier));
    return found.time + weight * found.barrier;
  };
  std::vector<Both> gradient(at.size(), Both::Zero());
  for (std::size_t cell = low; cell < end; ++cell) {
    const auto model = window.model(cell, at, weight);
    for (std::size_t q = 0; q < 4; ++q) gradient[cell + q - low] += model.gradient(q);
  }
  for (std::size_t i = 0; i < at.size(); ++i)
    for (int k = 0; k < 4; ++k) {
      CAPTURE(i, k);
      const double step = k < 3 ? 1e-8 : 1e-5, middle = at[i][k];
      at[i][k] = middle + step;
      const double more = cost();
      at[i][k] = middle - step;
      const double less = cost();
      at[i][k] = middle;
      CHECK(gradient[i][k] == Approx((more - less) / (2 * step)).epsilon(1e-4).margin(1e-6));
    }
}

TEST_CASE("a joint window takes less time and stays in the tube") {
  Example example;
  constexpr std::size_t room = 8;
  std::vector<std::array<Eigen::Matrix4d, 4>> rows(room);
  std::vector<Both> gradient(room), step(room), trial(room + 6);
  std::vector<CoupledPlace<double>> places(3 * (room + 3));
  const auto time = [&] {
    std::vector<CoupledPlace<double>> own(3 * (room + 3));
    const CoupledWindow<double, 3> window(example.problem, 4, 6, own);
    std::vector<Both> at;
    for (std::size_t i = window.first_cell(); i < window.last_cell() + 3; ++i) {
      at.emplace_back();
      at.back() << example.points[i], example.speeds[i];
    }
    const auto cost = window.cost(at);
    CHECK(std::isfinite(cost.barrier));
    return cost.time;
  };
  const double before = time();
  const auto result = improve<double, 3>(example.problem, example.points, example.speeds, 4, 10, {},
                                         {rows, gradient, step, trial, places});
  CHECK(result.converged);
  CHECK(time() < 0.99 * before);
}

}  // namespace
