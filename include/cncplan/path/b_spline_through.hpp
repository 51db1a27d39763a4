// The uniform cubic B-spline through given points (set-up).
#pragma once

#include <concepts>
#include <cstddef>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "cncplan/core/error.hpp"
#include "cncplan/core/vector.hpp"

namespace cncplan::path {

/// The curve's derivatives by its parameter at both ends, mm per piece. Where there is none the end is
/// natural: its second derivative is zero.
template <std::floating_point S>
struct BasicSplineEnds {
  std::optional<BasicVector3<S>> start;
  std::optional<BasicVector3<S>> end;
};

/// The control points, two more than the points, of the cubic `BasicBSpline` that is at point i at parameter
/// i. At the knots it weighs three controls by 1/6, 4/6, 1/6, so they solve
///
///     c_i + 4 c_(i+1) + c_(i+2) = 6 p_i
///
/// with an end condition on either side: three bands with a heavy diagonal, eliminated without pivots in
/// linear time. Error: below_limit for less than two points.
template <std::floating_point S>
[[nodiscard]] Expected<std::vector<BasicVector3<S>>> b_spline_through(
    std::span<const BasicVector3<S>> points, const std::type_identity_t<BasicSplineEnds<S>>& ends = {}) {
  using Vector = BasicVector3<S>;
  const std::size_t n = points.size();
  if (n < 2)
    return tl::unexpected(Error{ErrorCode::below_limit, "number of points", static_cast<double>(n), 2.0});

  // Rows of c_1 to c_n, c_0 and c_(n+1) put in: natural c_0 = 2 c_1 - c_2, with a derivative c_0 = c_2 - 2 d.
  std::vector<Vector> controls(n + 2, Vector::Zero());
  std::vector<S> above(n + 1, S(0));  // what is left of the upper band
  for (std::size_t i = 1; i <= n; ++i) {
    const bool first = i == 1, last = i == n;
    S before = first ? S(0) : S(1), own = S(4), after = last ? S(0) : S(1);
    Vector value = S(6) * points[i - 1];
    const auto close = [&](const std::optional<Vector>& derivative, S sign, S& inner) {
      if (derivative) {
        inner += S(1);
        value += sign * S(2) * *derivative;
      } else {
        own += S(2);
        inner -= S(1);
      }
    };
    if (first) close(ends.start, S(1), after);
    if (last) close(ends.end, S(-1), before);
    own -= before * above[i - 1];
    above[i] = after / own;
    controls[i] = (value - before * controls[i - 1]) / own;
  }
  for (std::size_t i = n - 1; i >= 1; --i) controls[i] -= above[i] * controls[i + 1];
  controls[0] =
      ends.start ? Vector(controls[2] - S(2) * *ends.start) : Vector(S(2) * controls[1] - controls[2]);
  controls[n + 1] =
      ends.end ? Vector(controls[n - 1] + S(2) * *ends.end) : Vector(S(2) * controls[n] - controls[n - 1]);
  return controls;
}

}  // namespace cncplan::path
