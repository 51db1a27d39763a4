// The laws that every path obeys, checked against numeric differentiation and integration.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "cncplan/core/concepts.hpp"
#include "support/catch.hpp"

namespace cncplan::test {

/// Worst violations of one path, each in units of the rounding to be expected; a few units are in order.
struct PathLawErrors {
  double derivative = 0;         ///< against a five-point difference of position
  double second_derivative = 0;  ///< against a five-point difference of derivative
  double length = 0;             ///< against Gauss-Legendre integration of |derivative|
  double inverse = 0;            ///< length integrated up to parameter_at(s), against s
  double ends = 0;               ///< 0 or 1: parameter_at(0) and parameter_at(length()) are the ends
  double monotone = 0;           ///< 0 or 1: parameter_at grows

  void worst_of(const PathLawErrors& other) {
    for (auto member : {&PathLawErrors::derivative, &PathLawErrors::second_derivative, &PathLawErrors::length,
                        &PathLawErrors::inverse, &PathLawErrors::ends, &PathLawErrors::monotone})
      this->*member = std::max(this->*member, other.*member);
  }
};

/// Length of the path between two parameters: Gauss-Legendre, five points a panel, in double whatever the
/// scalar.
template <ParametricPath P>
double integrated_length(const P& path, double from, double to, double unit) {
  constexpr double node[] = {0.0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640,
                             -0.9061798459386640};
  constexpr double weight[] = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665, 0.2369268850561891,
                               0.2369268850561891};
  const int panels = 4 + static_cast<int>(8 * (to - from) / unit);
  const double half = (to - from) / panels / 2;
  long double sum = 0;  // thousands of addends, all rounded the same way on a circle
  for (int i = 0; i < panels; ++i)
    for (int k = 0; k < 5; ++k) {
      const double u = from + half * (2 * i + 1 + node[k]);
      sum += weight[k] * half *
             path.derivative(static_cast<typename P::Scalar>(u)).template cast<double>().norm();
    }
  return static_cast<double>(sum);
}

/// Checks one path at `points` parameters. `unit`: the parameter range over which the path changes its shape
/// (1 rad on an arc, the length of a line).
template <CurveByLength P>
PathLawErrors path_law_errors(const P& path, double unit, int points = 7) {
  using S = typename P::Scalar;
  using V = typename P::Vector;
  const double eps = std::numeric_limits<S>::epsilon();
  const double end = path.parameter_end();
  const double length = path.length();
  const double reach = std::min(unit, end);
  const S h = static_cast<S>(std::pow(eps, 0.2) * reach);
  const auto five_points = [h](auto f, S u) -> V {
    return (8 * (f(u + h) - f(u - h)) - (f(u + 2 * h) - f(u - 2 * h))) / (12 * h);
  };
  const double size = path.position(S(0)).cwiseAbs().maxCoeff() +
                      path.position(static_cast<S>(end)).cwiseAbs().maxCoeff() +
                      path.derivative(S(0)).norm() * unit + length * std::min(1.0, unit / end);
  const double numeric = std::pow(eps, 0.8) * size / reach + 4 * eps * end * size / unit / unit;

  PathLawErrors worst;
  double previous = 0;
  for (int i = 0; i <= points; ++i) {
    const double part = static_cast<double>(i) / points;
    const S u = std::clamp(static_cast<S>(part * end), 2 * h, static_cast<S>(end) - 2 * h);
    const V d1 = five_points([&path](S x) { return path.position(x); }, u);
    const V d2 = five_points([&path](S x) { return path.derivative(x); }, u);
    worst.derivative =
        std::max(worst.derivative, static_cast<double>((d1 - path.derivative(u)).norm()) / numeric);
    worst.second_derivative =
        std::max(worst.second_derivative,
                 static_cast<double>((d2 - path.second_derivative(u)).norm()) / (numeric / unit));
    const double s = part * length;
    const double at = path.parameter_at(static_cast<S>(s));
    const double rounding = eps * (length + size * end / unit);
    worst.inverse = std::max(worst.inverse, std::abs(integrated_length(path, 0, at, unit) - s) / rounding);
    if (at < previous) worst.monotone = 1;
    previous = at;
  }
  worst.length = std::abs(integrated_length(path, 0, end, unit) - length) / (eps * length);
  if (path.parameter_at(S(0)) != S(0) || path.parameter_at(path.length()) != path.parameter_end())
    worst.ends = 1;
  return worst;
}

/// One CHECK a law.
inline void check_path_laws(const PathLawErrors& worst, const std::string& what) {
  INFO(what);
  CHECK(worst.derivative < 20);
  CHECK(worst.second_derivative < 20);
  CHECK(worst.length < 40);
  CHECK(worst.inverse < 20);
  CHECK(worst.ends == 0);
  CHECK(worst.monotone == 0);
}

}  // namespace cncplan::test
