// A junction's correction: what takes its jump out of the path.
#pragma once

#include <concepts>

#include "cncplan/core/detail/long_length.hpp"
#include "cncplan/core/vector.hpp"
#include "cncplan/detail/curve/kernel.hpp"

namespace cncplan::detail {

/// A kernel at a junction. Added to the path of N axes,
///
///     step * size * phi(x / size)   or   step * size^2 * psi(x / size),   x the length from the junction,
///
/// takes out the jump `step` of the first or second derivative by length. Each is a jump of its own; those
/// that overlap add up.
template <std::floating_point S, int N>
struct BasicCorrection {
  using Vector = VectorN<S, N>;

  LongLength<S> at{};  ///< mm of the program to the junction, from wherever the paths' starts are counted
  S size{};            ///< mm, > 0
  Jump jump{};
  Vector step = Vector::Zero();  ///< the derivative behind the junction less the one before it

  /// mm on both sides of the junction in which it acts.
  [[nodiscard]] S support() const { return size * reach<S>(jump); }
};

template <int N>
using Correction = BasicCorrection<double, N>;

}  // namespace cncplan::detail
