// Paths in the space of a machine's joints, and the blocks that are planned along them.
#pragma once

#include <concepts>
#include <cstddef>

#include "cncplan/core/concepts.hpp"

namespace cncplan::plan {

/// Derivatives of the joints by the length travelled, first to third: 1, 1/mm, 1/mm^2 (times rad/mm for a
/// rotary joint). At speed v, acceleration a and jerk j along the path, the joints move with first v, second
/// v^2 + first a, and third v^3 + 3 second v a + first j.
template <std::floating_point S, int N>
struct BasicJointRates {
  VectorN<S, N> first = VectorN<S, N>::Zero();
  VectorN<S, N> second = VectorN<S, N>::Zero();
  VectorN<S, N> third = VectorN<S, N>::Zero();
};

/// A path of joints, measured by the length that something else travels (the tool's tip as a rule), so that
/// its rates are not unit vectors.
template <class P>
concept JointPath = CurveByLength<P> && requires(const P& path, typename P::Scalar u) {
  { path.rates(u) } -> std::same_as<BasicJointRates<typename P::Scalar, P::Vector::RowsAtCompileTime>>;
};

/// One piece of a program in machine space.
template <JointPath P>
struct JointBlock {
  P path;
  typename P::Scalar feed{};   ///< mm/s along the path
  bool stop_at_end{};          ///< exact stop
  typename P::Scalar pause{};  ///< s at rest at its end
  std::size_t motion{};        ///< which motion of the program it belongs to
};

}  // namespace cncplan::plan
