// The peak between two ramps: how high the speed gets when there is no room for a cruise.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

#include "cncplan/core/detail/cube_root.hpp"
#include "cncplan/profile/ramp_law.hpp"

namespace cncplan::profile {

namespace detail {

using cncplan::cube_root;

/// Positive root of w^4 + 4 sum w^2 - 4 c w - d^2 with c >= sqrt(d) sum and sum >= d >= 0, c > 0.
///
/// It is the peak between two ramps at full jerk: with y^2 and z^2 the speed above the higher and the lower
/// end speed, z^2 - y^2 = d, the distance c / sqrt(J) is
///     y^3 + 2 high y + z^3 + 2 low z = c,
/// and w = y + z, d/w = z - y make it rational. From a start within 10 % of the root, over all arguments, two
/// Householder steps of order three (quartic convergence: 10 %, 1e-4) leave rounding.
template <std::floating_point S>
[[nodiscard]] constexpr S double_ramp_root(S sum, S c, S d) {
  const S k = S(4) * sum;
  const S t = S(4) * c;
  const S dd = d * d;
  const S reach = k - S(0.6) * d;  // w^2 times its square is k w^2 - d^2, to within the start's accuracy
  const S cube_root = rough_cube_root(t);
  const S h = cube_root * cube_root;
  const S q =
      reach * (reach + S(0.4) * h) + h * h;  // w (reach + g^2) = t with g^2 = h^3 / q, right at both ends
  S w = t * q / (reach * q + h * h * h);
  for (int step = 0; step < 2; ++step) {
    const S w2 = w * w;
    const S w4 = w2 * w2;
    // value and derivatives of w^3 + k w - t - d^2/w, each times the power of w that clears its denominator
    const S f0 = w * (w * (w2 + k) - t) - dd;
    const S f1 = S(3) * w4 + k * w2 + dd;
    const S f2 = S(3) * w4 - dd;  // half the second
    const S f3 = w4 + dd;         // a sixth of the third
    const S f1_sq = f1 * f1;
    w -= w * f0 * (f1_sq - f0 * f2) / (f1 * (f1_sq - S(2) * f0 * f2) + f0 * f0 * f3);
  }
  return w;
}

/// Roots of the speed changes on both sides of a peak.
template <std::floating_point S>
struct Peak {
  S from_high{};  ///< sqrt(peak - higher end speed)
  S from_low{};   ///< sqrt(peak - lower end speed)
};

/// What of a length a peak is solved for, so that rounding leaves a rest to cruise and never a deficit.
template <std::floating_point S>
inline constexpr S below = S(1) - S(16) * std::numeric_limits<S>::epsilon();

/// Both ramps within the acceleration limit.
template <std::floating_point S>
[[nodiscard]] constexpr Peak<S> free_peak(const BasicRampLaw<S>& law, S high, S low, S root_d, S length) {
  if (high == S(0)) {  // from rest to rest
    const S root = cube_root(length * law.root_jerk / S(2));
    return {root, root};
  }
  const S d = high - low;
  const S w = double_ramp_root(high + low, length * law.root_jerk, d);
  if (w <= root_d) return {S(0), root_d};
  const S difference = d / w;
  return {(w - difference) / S(2), (w + difference) / S(2)};
}

/// Both ramps at the acceleration limit: (high + V)(slope (V - high) + offset) and the same from low add up
/// to the length.
template <std::floating_point S>
[[nodiscard]] Peak<S> bound_peak(const BasicRampLaw<S>& law, S high, S low, S length) {
  const S d = high - low;
  // in x = V - high: 2 slope x^2 + 2 b x = rest
  const S b = law.offset + S(2) * law.slope * high;
  const S rest =
      std::max(length - S(2) * high * law.offset - (high + low) * (law.slope * d + law.offset), S(0));
  const S x = rest / (b + std::sqrt(b * b + S(2) * law.slope * rest));
  return {std::sqrt(x), std::sqrt(x + d)};
}

/// The longer ramp at the acceleration limit, the shorter one within it: a quartic in y = sqrt(V - high) with
/// positive coefficients, whose root lies between `least` and `most`.
template <std::floating_point S>
[[nodiscard]] Peak<S> mixed_peak(const BasicRampLaw<S>& law, S high, S low, S length, S least, S most) {
  const S d = high - low;
  const S c4 = law.slope;
  const S c3 = law.inverse_root_jerk;
  const S c2 = S(2) * law.slope * high + law.offset;
  const S c1 = S(2) * high * law.inverse_root_jerk;
  const S c0 = (high + low) * (law.slope * d + law.offset) - length;
  const auto value = [&](S y) { return c0 + y * (c1 + y * (c2 + y * (c3 + y * c4))); };
  const S at_least = value(least);
  const S at_most = value(most);
  S y = at_most > at_least ? least - at_least * (most - least) / (at_most - at_least) : most;
  for (int step = 0; step < 3; ++step) {
    const S f = value(y);
    const S first = c1 + y * (S(2) * c2 + y * (S(3) * c3 + y * S(4) * c4));
    const S second = S(2) * c2 + y * (S(6) * c3 + y * S(12) * c4);
    y = std::clamp(y - S(2) * f * first / (S(2) * first * first - f * second), least, most);
  }
  return {y, std::sqrt(y * y + d)};
}

}  // namespace detail

/// The highest speed between two ramps from and to the given end speeds (in either order) that fill `length`;
/// the length is at least that of the direct ramp between them, and at most what a peak at the speed limit
/// takes. `root_d` = sqrt(high - low).
template <std::floating_point S>
[[nodiscard]] detail::Peak<S> peak_between(const BasicRampLaw<S>& law, S high, S low, S root_d, S length,
                                           S root_most) {
  const auto distance = [&](S y, S z) {
    return (S(2) * high + y * y) * law.half_duration(y) + (S(2) * low + z * z) * law.half_duration(z);
  };
  const S d = high - low;
  const S limit = law.root_break;
  const S limit_sq = limit * limit;
  if (low + limit_sq >= high + root_most * root_most)
    return detail::free_peak(law, high, low, root_d, length);
  const S least = limit_sq > d ? std::sqrt(limit_sq - d) : S(0);
  if (limit_sq > d && length <= distance(least, limit))
    return detail::free_peak(law, high, low, root_d, length);
  if (limit < root_most && length >= distance(limit, std::sqrt(limit_sq + d)))
    return detail::bound_peak(law, high, low, length);
  return detail::mixed_peak(law, high, low, length, least, std::min(limit, root_most));
}

}  // namespace cncplan::profile
