// The fastest speed over path length that keeps caps, acceleration and jerk, found numerically on a grid,
// with nonzero acceleration wherever that helps, which the planner does not try.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "cncplan/core/limits.hpp"

namespace cncplan::test {

/// In b = v^2 over path length x, b' = 2a and b'' sqrt(b) = 2j. Minimises the sum of h / sqrt(b) by an
/// interior point method: logarithmic barriers, Newton steps on a matrix of five diagonals. The jerk's
/// constraint |b''| <= 2J / sqrt(b) is not convex, so what is found is a local optimum, below or at the
/// start.
class Optimum {
 public:
  /// `highest`: square of the highest speed at each node, `step` mm apart. `start`: squares of the speeds of
  /// a motion within all limits, whose first two and last two values stay.
  Optimum(const Limits& limits, double step, std::vector<double> highest, const std::vector<double>& start)
      : limits_(limits), step_(step), highest_(std::move(highest)), b_(start) {
    constexpr double inside =
        0.99;  // of a motion within its limits, a slower one is strictly so, grid errors included
    for (double& b : b_) b *= inside;
  }

  /// Squares of the speeds.
  std::vector<double> solve() {
    double weight = 10.0 * time(b_) / static_cast<double>(b_.size());
    const double least = weight * 1e-8;
    for (; weight > least; weight *= 0.3)
      for (int newton = 0; newton < 100 && improve(weight); ++newton) continue;
    return b_;
  }

  /// s, by cells of constant acceleration.
  [[nodiscard]] double time(const std::vector<double>& b) const {
    double sum = 0.0;
    for (std::size_t i = 0; i + 1 < b.size(); ++i)
      sum += 2.0 * step_ / (std::sqrt(b[i]) + std::sqrt(b[i + 1]));
    return sum;
  }

 private:
  // The constraints at a node, all > 0 inside, and their derivatives by its left neighbour, itself, its right
  // one.
  struct Constraint {
    double value;
    std::array<double, 3> slope;
  };
  [[nodiscard]] std::array<Constraint, 5> constraints(const std::vector<double>& b, std::size_t i) const {
    const double h2 = step_ * step_;
    const double root = std::sqrt(b[i]);
    const double jerk = 2.0 * limits_.jerk * h2 / root;
    const double jerk_slope = -jerk / (2.0 * b[i]);
    const double bend = b[i + 1] - 2.0 * b[i] + b[i - 1];
    const double rise = b[i + 1] - b[i - 1];
    const double most = 4.0 * step_ * limits_.acceleration;
    return {{{highest_[i] - b[i], {0.0, -1.0, 0.0}},
             {jerk - bend, {-1.0, jerk_slope + 2.0, -1.0}},
             {jerk + bend, {1.0, jerk_slope - 2.0, 1.0}},
             {most - rise, {1.0, 0.0, -1.0}},
             {most + rise, {-1.0, 0.0, 1.0}}}};
  }

  [[nodiscard]] double barrier(const std::vector<double>& b, double weight) const {
    double sum = 0.0;
    for (std::size_t i = 1; i + 1 < b.size(); ++i) {
      if (!(b[i] > 0.0)) return std::numeric_limits<double>::infinity();
      sum += step_ / std::sqrt(b[i]);
      for (const Constraint& c : constraints(b, i)) {
        if (!(c.value > 0.0)) return std::numeric_limits<double>::infinity();
        sum -= weight * std::log(c.value);
      }
    }
    return sum;
  }

  // One Newton step with a line search; false where it gains nothing any more.
  bool improve(double weight) {
    const std::size_t n = b_.size();
    std::vector<double> gradient(n, 0.0);
    std::vector<std::array<double, 3>> matrix(n, {0.0, 0.0, 0.0});  // the diagonal and two below it
    for (std::size_t i = 1; i + 1 < n; ++i) {
      gradient[i] -= step_ / (2.0 * b_[i] * std::sqrt(b_[i]));
      matrix[i][0] += 3.0 * step_ / (4.0 * b_[i] * b_[i] * std::sqrt(b_[i]));
      for (const Constraint& c : constraints(b_, i))
        for (std::size_t row = 0; row < 3; ++row) {
          gradient[i + row - 1] -= weight * c.slope[row] / c.value;
          for (std::size_t column = 0; column <= row; ++column)
            matrix[i + row - 1][row - column] +=
                weight * c.slope[row] * c.slope[column] / (c.value * c.value);
        }
    }
    // Cholesky between the fixed ends
    std::vector<double> step(n, 0.0);
    for (std::size_t i = 2; i + 2 < n; ++i) {
      for (std::size_t below = std::min<std::size_t>(2, i - 2); below > 0; --below) {
        double value = matrix[i][below];
        if (below == 1 && i >= 4) value -= matrix[i][2] * matrix[i - 1][1];
        matrix[i][below] = value / matrix[i - below][0];
      }
      double value = matrix[i][0];
      step[i] = -gradient[i];
      for (std::size_t below = 1; below <= std::min<std::size_t>(2, i - 2); ++below) {
        value -= matrix[i][below] * matrix[i][below];
        step[i] -= matrix[i][below] * step[i - below];
      }
      matrix[i][0] = std::sqrt(std::max(value, 1e-300));
      step[i] /= matrix[i][0];
    }
    for (std::size_t i = n - 3; i >= 2; --i) {
      for (std::size_t above = 1; above <= 2 && i + above + 2 < n; ++above)
        step[i] -= matrix[i + above][above] * step[i + above];
      step[i] /= matrix[i][0];
    }
    const double before = barrier(b_, weight);
    for (double length = 1.0; length > 1e-6; length /= 2.0) {
      std::vector<double> tried = b_;
      for (std::size_t i = 2; i + 2 < n; ++i) tried[i] += length * step[i];
      const double after = barrier(tried, weight);
      if (!(after < before)) continue;
      b_ = std::move(tried);
      return before - after > 1e-2 * weight;
    }
    return false;
  }

  Limits limits_;
  double step_;
  std::vector<double> highest_;
  std::vector<double> b_;
};

}  // namespace cncplan::test
