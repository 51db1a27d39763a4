// Many crossings of one coordinate of a circle at once: what step generation asks for, a batch at a time.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <numbers>
#include <span>

#include "cncplan/path/detail/arc_axis.hpp"

namespace cncplan::path {

/// atan(opposite / adjacent) for lengths >= 0, not both zero, to 3 units in the last place: without branches,
/// so that a loop of it is vectorised. Lengths are turned by 45 and mirrored at 45 degrees until the tangent
/// q is below tan(22.5 deg); there atan q = q + q^3 p(q^2) with p the Chebyshev fit of degree 10, which
/// leaves 5.5e-18 q.
template <std::floating_point S>
[[nodiscard]] constexpr S arctangent(S opposite, S adjacent) {
  constexpr S octant = std::numbers::pi_v<S> / 4;
  const S shorter = opposite < adjacent ? opposite : adjacent;
  const S longer = opposite < adjacent ? adjacent : opposite;
  const bool turn = shorter > S(0.41421356237309503) * longer;
  const S q = (turn ? shorter - longer : shorter) / (turn ? shorter + longer : longer);
  const S z = q * q;
  const S z2 = z * z;
  const S z4 = z2 * z2;
  const S p0 = (S(-0.33333333333333330156) + S(0.19999999999995516545) * z) +
               (S(-0.14285714284665680761) + S(0.11111111015187018721) * z) * z2;
  const S p4 = (S(-0.090909045753064890845) + S(0.076921831253768920895) * z) +
               (S(-0.066645105255089365988) + S(0.058581409048663282818) * z) * z2;
  const S p8 =
      (S(-0.050854078345894842573) + S(0.039230447784793095235) * z) + S(-0.019175404711104933678) * z2;
  const S below = q + q * z * (p0 + z4 * (p4 + z4 * p8));
  const S angle = turn ? octant + below : below;
  return opposite < adjacent ? angle : 2 * octant - angle;
}

/// `axis.crossing` for each of `values` in place, for a circle (axis.growth == 0): seen from `low`, the angle
/// on to the crossing follows from delta, the way to there, and the speeds at both: tan(angle/2) = |delta| /
/// (|v_low| + |v|) with v^2 = v_low^2 - delta (delta + 2 radial_low). Both speeds have one sign, so nothing
/// cancels.
template <std::floating_point S>
void circle_crossings(const ArcAxis<S>& axis, std::span<S> values, S low, S high) {
  constexpr std::size_t chunk = 32;
  const S s = std::sin(low);
  const S c = std::cos(low);
  const S value = axis.value(low);
  const S radial = axis.radial * c + axis.tangential * s;
  const S speed = std::abs(axis.tangential * c - axis.radial * s);
  const S speed_sq = speed * speed;
  // Values that rounding puts behind `low` fall on it; at a turning both speeds vanish there.
  const S sense = axis.value(low + (high - low) / 2) < value ? S(-1) : S(1);
  constexpr S tiny = std::numeric_limits<S>::min();
  while (!values.empty()) {
    const std::size_t count = std::min(values.size(), chunk);
    std::array<S, chunk> speeds;
    for (std::size_t i = 0; i < count; ++i) {
      const S delta = values[i] - value;
      speeds[i] = speed_sq - delta * (delta + 2 * radial);
    }
    for (std::size_t i = 0; i < count; ++i) speeds[i] = std::sqrt(std::max(speeds[i], S(0)));
    for (std::size_t i = 0; i < count; ++i) {
      const S onward = sense * (values[i] - value);
      const S u = low + 2 * arctangent(onward > S(0) ? onward : S(0), speed + speeds[i] + tiny);
      values[i] = u < high ? u : high;
    }
    values = values.subspan(count);
  }
}

}  // namespace cncplan::path
