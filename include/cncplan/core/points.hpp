// Many points at once, as columns of one block of memory that belongs to the caller.
#pragma once

#include <Eigen/Core>
#include <concepts>
#include <span>

#include "cncplan/core/vector.hpp"

namespace cncplan {

/// N coordinates a column, one column a point, without gaps: a view, copied by value.
template <std::floating_point S, int N>
using PointsN = Eigen::Map<Eigen::Matrix<S, N, Eigen::Dynamic>>;

template <std::floating_point S>
using BasicPoints = PointsN<S, 3>;

using Points = BasicPoints<double>;

/// The view of a span of vectors.
template <std::floating_point S, int N>
[[nodiscard]] PointsN<S, N> points(std::span<VectorN<S, N>> vectors) {
  return {vectors.empty() ? nullptr : vectors.front().data(), N, static_cast<Eigen::Index>(vectors.size())};
}

/// The view of a matrix, fixed or dynamic.
template <std::floating_point S, int N, int Columns>
[[nodiscard]] PointsN<S, N> points(Eigen::Matrix<S, N, Columns>& matrix) {
  return {matrix.data(), N, matrix.cols()};
}

}  // namespace cncplan
