// Length of a curve between two parameters, by Gauss-Legendre quadrature of its speed.
#pragma once

#include <array>
#include <concepts>

#include "cncplan/core/vector.hpp"

namespace cncplan::path {

/// A curve of which no length is needed yet: it is what this computes.
template <class C>
concept DifferentiableCurve = requires(const C& curve, typename C::Scalar u) {
  requires std::floating_point<typename C::Scalar>;
  { curve.derivative(u) } -> std::same_as<typename C::Vector>;
};

/// The integral of |r'| from u = `from` to `to`, mm, by eight points a panel: exact for polynomials up to
/// degree 15. Where the speed is smooth over a panel the error falls with the sixteenth power of its width.
template <DifferentiableCurve C>
[[nodiscard]] typename C::Scalar arc_length(const C& curve, typename C::Scalar from, typename C::Scalar to,
                                            int panels = 1) {
  using S = typename C::Scalar;
  constexpr std::array nodes{S(0.18343464249564980494), S(0.52553240991632898582), S(0.79666647741362673959),
                             S(0.96028985649753623168)};
  constexpr std::array weights{S(0.36268378337836198297), S(0.31370664587788728734),
                               S(0.22238103445337447054), S(0.10122853629037625915)};
  const S half = (to - from) / static_cast<S>(2 * panels);
  S sum = S(0);
  for (int panel = 0; panel < panels; ++panel) {
    const S middle = from + half * static_cast<S>(2 * panel + 1);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      sum += weights[i] * (curve.derivative(middle - half * nodes[i]).norm() +
                           curve.derivative(middle + half * nodes[i]).norm());
  }
  return half * sum;
}

}  // namespace cncplan::path
