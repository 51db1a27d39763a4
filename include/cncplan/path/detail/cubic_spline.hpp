// A curve of cubic pieces over knots of any spacing, C2, by its control points.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <span>

#include "cncplan/core/path_point.hpp"
#include "cncplan/core/vector.hpp"

namespace cncplan::path {

/// Weights of the four control points of a cell: row d gives the d-th derivative at the cell's start.
template <std::floating_point S>
using CubicWeights = std::array<std::array<S, 4>, 4>;

/// The weights of a cell from the lengths of five cells, of which it is the middle one (Cox and de Boor; at
/// a cell's start the basis functions of lower degree are few).
template <std::floating_point S>
[[nodiscard]] constexpr CubicWeights<S> cubic_weights(const std::array<S, 5>& lengths) {
  const auto& [a, b, c, d, e] = lengths;
  const S left = a + b + c, mid = b + c + d, right = c + d + e;
  const std::array<S, 3> quadratic{c / (b + c), b / (b + c), S(0)};
  const std::array<S, 2> linear{S(1), S(0)};
  CubicWeights<S> w{};
  w[0] = {c / left * quadratic[0], (a + b) / left * quadratic[0] + (c + d) / mid * quadratic[1],
          b / mid * quadratic[1], S(0)};
  const std::array<std::array<S, 3>, 4> down{{{S(-3) / left, S(0), S(0)},
                                              {S(3) / left, S(-3) / mid, S(0)},
                                              {S(0), S(3) / mid, S(-3) / right},
                                              {S(0), S(0), S(3) / right}}};
  const std::array<std::array<S, 2>, 3> down2{
      {{S(-2) / (b + c), S(0)}, {S(2) / (b + c), S(-2) / (c + d)}, {S(0), S(2) / (c + d)}}};
  for (std::size_t q = 0; q < 4; ++q)
    for (std::size_t r = 0; r < 3; ++r) {
      w[1][q] += down[q][r] * quadratic[r];
      for (std::size_t m = 0; m < 2; ++m) {
        w[2][q] += down[q][r] * down2[r][m] * linear[m];
        w[3][q] += down[q][r] * down2[r][m] * (m == 0 ? S(-1) : S(1)) / c;
      }
    }
  return w;
}

/// The weights of the position at x mm of the cell.
template <std::floating_point S>
[[nodiscard]] constexpr std::array<S, 4> weights_at(const CubicWeights<S>& w, S x) {
  std::array<S, 4> result{};
  for (std::size_t q = 0; q < 4; ++q)
    result[q] = w[0][q] + x * (w[1][q] + x * (w[2][q] / S(2) + x * w[3][q] / S(6)));
  return result;
}

/// The weights of the first three derivatives at x mm of the cell, position first.
template <std::floating_point S>
[[nodiscard]] constexpr CubicWeights<S> moved(const CubicWeights<S>& w, S x) {
  CubicWeights<S> result = w;
  result[0] = weights_at(w, x);
  for (std::size_t q = 0; q < 4; ++q) {
    result[1][q] = w[1][q] + x * (w[2][q] + x * w[3][q] / S(2));
    result[2][q] = w[2][q] + x * w[3][q];
  }
  return result;
}

/// Position and derivatives at the start of a cell from its four control points.
template <class V>
[[nodiscard]] PathPoint<V> cubic_start(const CubicWeights<typename V::Scalar>& w, std::span<const V> four) {
  PathPoint<V> at;
  for (std::size_t q = 0; q < 4; ++q) {
    at.position += w[0][q] * four[q];
    at.first += w[1][q] * four[q];
    at.second += w[2][q] * four[q];
    at.third += w[3][q] * four[q];
  }
  return at;
}

/// The same at x mm of the cell.
template <class V>
[[nodiscard]] PathPoint<V> cubic_at(const PathPoint<V>& start, typename V::Scalar x) {
  using S = typename V::Scalar;
  return {start.position + x * (start.first + x * (start.second / S(2) + (x / S(6)) * start.third)),
          start.first + x * (start.second + (x / S(2)) * start.third), start.second + x * start.third,
          start.third};
}

}  // namespace cncplan::path
