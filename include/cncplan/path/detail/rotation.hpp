// Sine and versine of an angle travelled, without branches and calls, so that loops over it become vector
// code.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <numbers>

namespace cncplan::path {

/// A turn by the angle u carries a vector r with its perpendicular t to r + sine t - versine r.
template <std::floating_point S>
struct Rotation {
  S sine{};     ///< sin u
  S versine{};  ///< 1 - cos u, exact to rounding for small angles too
};

namespace detail {

/// 2 pi as a sum. The first two have so few digits that their products with a number of turns below 2^23
/// (float: 2^13) are exact (Cody and Waite).
template <std::floating_point S>
inline constexpr S two_pi[] = {S(0x1.921fb54p+2), S(0x1.10b46118p-28), S(0x1.313198a2e0370p-59)};
template <>
inline constexpr float two_pi<float>[] = {0x1.92p+2F, 0x1.fb4p-10F, 0x1.4442dp-22F};

/// c0 + x (c1 + x (c2 + ...)).
template <std::floating_point S>
[[nodiscard]] constexpr S horner(S /*x*/, S c) {
  return c;
}
template <std::floating_point S, std::same_as<S>... C>
[[nodiscard]] constexpr S horner(S x, S c, C... rest) {
  return c + x * horner(x, rest...);
}

}  // namespace detail

/// For u >= 0, rad. Absolute error at most 7 epsilon below 5e7 rad (float: 5e4), relative error at most 4
/// epsilon below 1 rad: see the test; beyond, and up to 2^30 turns, also that of rounding u. The angle less
/// whole turns is halved twice: a quarter of it lies in [-pi/4, pi/4], where the Taylor series of sine and
/// cosine end at x^15 and x^16, and
///   sin(2q) = 2 sin q cos q,   cos(2q) = 1 - 2 sin^2 q,   versine(2h) = 2 sin^2 h
/// lead back without telling quadrants apart.
template <std::floating_point S>
[[nodiscard]] constexpr Rotation<S> rotation(S u) {
  constexpr S most = S(1 << 30);
  const S turns =
      static_cast<S>(static_cast<std::int32_t>(std::min(u * (std::numbers::inv_pi_v<S> / 2) + S(0.5), most)));
  const auto& whole = detail::two_pi<S>;
  const S q = (((u - turns * whole[0]) - turns * whole[1]) - turns * whole[2]) / 4;
  const S x = q * q;
  const S sine_q = q * detail::horner(x, S(1), S(-1.0 / 6), S(1.0 / 120), S(-1.0 / 5040), S(1.0 / 362880),
                                      S(-1.0 / 39916800), S(1.0 / 6227020800), S(-1.0 / 1307674368000));
  const S cosine_q =
      detail::horner(x, S(1), S(-1.0 / 2), S(1.0 / 24), S(-1.0 / 720), S(1.0 / 40320), S(-1.0 / 3628800),
                     S(1.0 / 479001600), S(-1.0 / 87178291200), S(1.0 / 20922789888000));
  const S sine_h = 2 * sine_q * cosine_q;
  const S cosine_h = 1 - 2 * sine_q * sine_q;
  return {2 * sine_h * cosine_h, 2 * sine_h * sine_h};
}

}  // namespace cncplan::path
