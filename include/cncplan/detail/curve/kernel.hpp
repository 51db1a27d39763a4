// Kernels that take a jump of direction or of curvature out of a path: closed forms and their ranges.
#pragma once

#include "cncplan/core/compiler.hpp"

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>

#include "cncplan/core/interval.hpp"

namespace cncplan::detail {

/// What jumps at a junction: the path's first or its second derivative by length.
enum class Jump : std::uint8_t { direction, curvature };

/// A kernel and its first three derivatives at one distance from its centre, in units of its size.
template <class T>
using KernelValues = std::array<T, 4>;

/// 2^(1/3) - 1: how much longer than its size the curvature kernel reaches. The overshoot of the curvature
/// then makes up for what comes before it, and the kernel ends at zero with its derivatives.
template <std::floating_point S>
inline constexpr S overshoot = S(0.25992104989487316477L);
template <std::floating_point S>
inline constexpr S overshoot_gain = S(1) / (S(2) * (S(1) - overshoot<S>));

/// Where derivative k of a kernel has an extremum inside its support.
template <std::floating_point S>
inline constexpr std::array<S, 4> direction_extrema{S(0), S(0), S(0), S(2) / S(3)};
template <std::floating_point S>
inline constexpr std::array<S, 4> curvature_extrema{S(0.37249507619754334L), S(1) - overshoot<S>, S(1), S(1)};

/// How far a kernel reaches from its centre, in units of its size.
template <std::floating_point S>
[[nodiscard]] constexpr S reach(Jump jump) {
  return jump == Jump::direction ? S(2) : S(1) + overshoot<S>;
}

/// The largest value of a kernel of size one: what it leaves the path by, per unit of the jump (and of the
/// size, squared for a jump of curvature).
template <std::floating_point S>
[[nodiscard]] constexpr S largest(Jump jump) {
  return jump == Jump::direction ? S(28) / S(120) : S(0.0230487);
}

/// Behind the centre, at u >= 0 sizes from it. A path plus (jump) * (size) * kernel has no jump of direction:
///
///     phi = ((2 - u)^5 - 4 (1 - u)^5) / 120,     each power only where its base is positive:
///
/// twice differentiated the cubic B-spline, of area one. Or, with size^2, no jump of curvature:
///
///     psi = g (e^3 - 2 f^3) / 6,   e = 1 + r - u,   f = 1 - u,   r = 2^(1/3) - 1,   g = 1 / (2 (1 - r)):
///
/// twice differentiated it goes from -1/2 straight through zero to an overshoot of g r and back to zero at
/// 1 + r. Before the centre phi is even and psi is odd. The third derivative of psi at u = 1 is that of
/// further in.
template <std::floating_point S>
[[nodiscard]] constexpr KernelValues<S> kernel(Jump jump, S u) {
  if (jump == Jump::direction) {
    const S e = std::max(S(2) - u, S(0)), f = std::max(S(1) - u, S(0));
    const S e2 = e * e, f2 = f * f;
    return {(e2 * e2 * e - S(4) * f2 * f2 * f) / S(120), -(e2 * e2 - S(4) * f2 * f2) / S(24),
            (e2 * e - S(4) * f2 * f) / S(6), -(e2 - S(4) * f2) / S(2)};
  }
  constexpr S g = overshoot_gain<S>;
  const S e = std::max(S(1) + overshoot<S> - u, S(0)), f = std::max(S(1) - u, S(0));
  const S third = u <= S(1) ? g : (e > S(0) ? -g : S(0));
  return {g * (e * e * e - S(2) * f * f * f) / S(6), g * (f * f - e * e / S(2)), g * (e - S(2) * f), third};
}

/// The ranges of a kernel and its derivatives for all u in [from, to], 0 <= from <= to: sharp, as each of
/// them has one extremum.
template <std::floating_point S>
[[nodiscard]] constexpr KernelValues<BasicInterval<S>> kernel_range(Jump jump, S from, S to) {
  const auto first = kernel(jump, from), last = kernel(jump, to);
  const auto& extrema = jump == Jump::direction ? direction_extrema<S> : curvature_extrema<S>;
  KernelValues<BasicInterval<S>> result;
  for (std::size_t k = 0; k < 4; ++k) {
    result[k] = BasicInterval<S>::hull(first[k], last[k]);
    if (!(from < extrema[k] && extrema[k] < to)) continue;
    const S between = kernel(jump, extrema[k])[k];
    result[k] = BasicInterval<S>::hull(result[k].low, result[k].high, between);
  }
  if (jump == Jump::curvature && from <= S(1) && to >= S(1))  // where the third derivative steps
    result[3] = BasicInterval<S>::hull(result[3].low, result[3].high, -overshoot_gain<S>);
  return result;
}

}  // namespace cncplan::detail
