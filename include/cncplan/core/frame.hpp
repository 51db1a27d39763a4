// A curve at one point, by its own arc length: where it is, where it goes, how it bends.
#pragma once

#include <cmath>
#include <concepts>
#include <cstddef>

#include "cncplan/core/curve_point.hpp"
#include "cncplan/core/vector.hpp"

namespace cncplan {

/// Position and its first two derivatives by the length that counts; on a curve by its own length, the unit
/// tangent and the curvature vector. With speed v and acceleration a along it, the velocity is v first and
/// the acceleration a first + v^2 second.
template <class Vector>
struct Frame {
  Vector position;  ///< mm
  Vector first;     ///< zero where the curve stands still
  Vector second;    ///< 1/mm
};

/// Up to `capacity` frames, in columns.
template <std::floating_point S, int N>
struct Frames {
  static constexpr int capacity = 64;
  using Columns = Eigen::Matrix<S, N, capacity>;

  Columns position;
  Columns first;
  Columns second;

  void set(std::size_t i, const Frame<VectorN<S, N>>& frame) {
    const auto column = static_cast<Eigen::Index>(i);
    position.col(column) = frame.position;
    first.col(column) = frame.first;
    second.col(column) = frame.second;
  }
  [[nodiscard]] Frame<VectorN<S, N>> operator[](std::size_t i) const {
    const auto column = static_cast<Eigen::Index>(i);
    return {position.col(column), first.col(column), second.col(column)};
  }
};

/// The frame of a curve over any parameter.
template <class Vector>
[[nodiscard]] Frame<Vector> frame(const CurvePoint<Vector>& point) {
  using S = typename Vector::Scalar;
  const S norm_sq = point.first.squaredNorm();
  if (!(norm_sq > S(0))) return {point.position, Vector::Zero(), Vector::Zero()};
  const Vector across = point.second - point.first * (point.first.dot(point.second) / norm_sq);
  return {point.position, point.first / std::sqrt(norm_sq), across / norm_sq};
}

}  // namespace cncplan
