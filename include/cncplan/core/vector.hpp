// The vector of the whole library: a fixed-size Eigen column.
#pragma once

#include "cncplan/core/compiler.hpp"

#include <Eigen/Core>
#include <concepts>

namespace cncplan {

/// Column vector of N components; mm for positions, mm/s and mm/s^2 for their derivatives.
template <std::floating_point S, int N>
using VectorN = Eigen::Matrix<S, N, 1>;

/// Point or direction in space, X Y Z.
template <std::floating_point S>
using BasicVector3 = VectorN<S, 3>;

using Vector3 = BasicVector3<double>;

}  // namespace cncplan
