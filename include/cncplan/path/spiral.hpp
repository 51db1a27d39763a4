// Arc length and curvature of a spiral: radius and height linear in the angle; circle and helix are its
// special cases.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>

namespace cncplan::path {

/// Radius r = radius + growth * angle and height rise * angle, at angles where r > 0.
template <std::floating_point S>
struct Spiral {
  S radius{};  ///< at angle 0, mm, > 0
  S growth{};  ///< radius gained per radian, mm
  S rise{};    ///< height gained per radian, mm

  [[nodiscard]] S radius_at(S angle) const { return radius + growth * angle; }

  friend bool operator==(const Spiral&, const Spiral&) = default;
};

/// log(1 + x) / x, continued by 1 to x = 0, by its series: exact to rounding for |x| < 1e-3.
template <std::floating_point S>
[[nodiscard]] S small_log1p_over(S x) {
  return S(1) - x * (S(1) / 2 - x * (S(1) / 3 - x * (S(1) / 4 - x * (S(1) / 5 - x / 6))));
}

/// log(1 + x) / x, continued by 1 to x = 0.
template <std::floating_point S>
[[nodiscard]] S log1p_over(S x) {
  return std::abs(x) < S(1e-3) ? small_log1p_over(x) : std::log1p(x) / x;
}

/// Length travelled per radian, ds/dangle = sqrt(r^2 + growth^2 + rise^2).
template <std::floating_point S>
[[nodiscard]] S speed_at(const Spiral<S>& spiral, S angle) {
  const S r = spiral.radius_at(angle);
  return std::sqrt(r * r + spiral.growth * spiral.growth + spiral.rise * spiral.rise);
}

/// Length from angle 0 to `angle`. With r0, r1 the radii there, m^2 = growth^2 + rise^2 and g = sqrt(r^2 +
/// m^2), the integral of g is [r g + m^2 asinh(r / m)] / (2 growth) between r0 and r1. Both differences
/// divided by growth are written so that nothing cancels as growth -> 0 (arcs programmed by a rounded centre
/// are spirals of growth 1e-6):
///   r1 g1 - r0 g0     = (r1^2 g1^2 - r0^2 g0^2) / (r1 g1 + r0 g0),
///   asinh r1/m - asinh r0/m = log1p(x),   x = (r1 - r0) c,   c = (1 + (r1 + r0) / (g1 + g0)) / (r0 + g0).
/// Here `log_over` is `log1p_over` or what stands for it.
template <std::floating_point S, class Log>
[[nodiscard]] S length_at(const Spiral<S>& spiral, S angle, S g0, S g1, Log log_over) {
  const S r0 = spiral.radius;
  const S r1 = spiral.radius_at(angle);
  const S m_sq = spiral.growth * spiral.growth + spiral.rise * spiral.rise;
  const S c = (S(1) + (r1 + r0) / (g1 + g0)) / (r0 + g0);
  const S rational = (r1 + r0) * (r1 * r1 + r0 * r0 + m_sq) / (r1 * g1 + r0 * g0);
  return angle / 2 * (rational + m_sq * c * log_over((r1 - r0) * c));
}

template <std::floating_point S>
[[nodiscard]] S length_at(const Spiral<S>& spiral, S angle) {
  const S g0 = speed_at(spiral, S(0));
  if (spiral.growth == S(0)) return angle * g0;
  return length_at(spiral, angle, g0, speed_at(spiral, angle), log1p_over<S>);
}

/// `length_at` for each of `angles`, none farther from 0 than `farthest`, in place. As x above is at most
/// |r1 - r0| / min(r0, r1), the series serves all of a spiral of little growth: vector code.
template <std::floating_point S>
void lengths_at(const Spiral<S>& spiral, std::span<S> angles, S farthest) {
  const S g0 = speed_at(spiral, S(0));
  const S nearest = std::min(spiral.radius, spiral.radius_at(farthest));
  if (spiral.growth == S(0)) {
    for (S& angle : angles) angle *= g0;
  } else if (std::abs(spiral.growth * farthest) < S(0.5e-3) * nearest) {
    constexpr std::size_t chunk = 32;
    const S m_sq = spiral.growth * spiral.growth + spiral.rise * spiral.rise;
    for (; !angles.empty(); angles = angles.subspan(std::min(chunk, angles.size()))) {
      const std::size_t count = std::min(chunk, angles.size());
      std::array<S, chunk> speeds;
      for (std::size_t i = 0; i < count; ++i) {
        const S r = spiral.radius_at(angles[i]);
        speeds[i] = r * r + m_sq;
      }
      for (std::size_t i = 0; i < count; ++i) speeds[i] = std::sqrt(std::max(speeds[i], S(0)));
      for (std::size_t i = 0; i < count; ++i)
        angles[i] = length_at(spiral, angles[i], g0, speeds[i], small_log1p_over<S>);
    }
  } else {
    for (S& angle : angles) angle = length_at(spiral, angle);
  }
}

/// Inverse of `length_at` for s in [0, end_length], where end_length belongs to end_angle.
/// Newton's method from the solution for a speed linear in the angle. The length is convex or concave in the
/// angle (the radius is monotone), so after one step the iterates approach from one side; the error squares
/// with every step and the loop ends as soon as the next one would be below rounding: after one step for
/// |growth| < 1e-4 radius, after four at most in 1e6 random spirals with radius ratios to 1e9; twice that is
/// the bound.
template <std::floating_point S>
[[nodiscard]] S angle_at(const Spiral<S>& spiral, S s, S end_angle, S end_length) {
  if (s <= S(0)) return S(0);
  if (s >= end_length) return end_angle;
  const S g0 = speed_at(spiral, S(0));
  if (spiral.growth == S(0)) return s / g0;
  constexpr int newton_steps = 8;
  const S g1 = speed_at(spiral, end_angle);
  const S scaled = s / end_length * (g0 + g1) / 2 * end_angle;
  S angle = 2 * scaled / (g0 + std::sqrt(g0 * g0 + 2 * (g1 - g0) / end_angle * scaled));
  for (int i = 0; i < newton_steps; ++i) {
    const S g = speed_at(spiral, angle);
    const S step = (s - length_at(spiral, angle)) / g;
    angle = std::clamp(angle + step, S(0), end_angle);
    const S next_error = step * step * std::abs(spiral.growth) * spiral.radius_at(angle) / (g * g);
    if (next_error <= std::numeric_limits<S>::epsilon() * angle) break;
  }
  return angle;
}

/// |p' x p''| / |p'|^3 where the radius is r; in the local frame p' = (growth, r, rise), p'' = (-r, 2 growth,
/// 0). 1/mm.
template <std::floating_point S>
[[nodiscard]] S curvature_at_radius(const Spiral<S>& spiral, S r) {
  const S k_sq = spiral.growth * spiral.growth;
  const S h_sq = spiral.rise * spiral.rise;
  const S in_plane = r * r + 2 * k_sq;
  const S g_sq = r * r + k_sq + h_sq;
  return std::sqrt(h_sq * (r * r + 4 * k_sq) + in_plane * in_plane) / (g_sq * std::sqrt(g_sq));
}

/// Largest curvature between angle 0 and `end_angle`: at one of the ends, or (steep helices) where
/// d curvature^2 / d r^2 = 0, that is r^4 + 6 k^2 r^2 + 8 k^4 + 7 k^2 h^2 - h^4 = 0 with k = growth, h =
/// rise.
template <std::floating_point S>
[[nodiscard]] S max_curvature(const Spiral<S>& spiral, S end_angle) {
  const S r0 = spiral.radius;
  const S r1 = spiral.radius_at(end_angle);
  const S largest = std::max(curvature_at_radius(spiral, r0), curvature_at_radius(spiral, r1));
  const S k_sq = spiral.growth * spiral.growth;
  const S h_sq = spiral.rise * spiral.rise;
  const S root_sq = k_sq * k_sq - 7 * k_sq * h_sq + h_sq * h_sq;
  if (!(root_sq > S(0))) return largest;
  const S r_sq = std::sqrt(root_sq) - 3 * k_sq;
  const auto [low, high] = std::minmax(r0, r1);
  if (!(r_sq > low * low && r_sq < high * high)) return largest;
  return std::max(largest, curvature_at_radius(spiral, std::sqrt(r_sq)));
}

/// How fast the curvature vector changes across the tangent, by length, where the radius is r: curvature
/// times torsion on a helix, zero on a circle. 1/mm^2. In the local frame it is |p' x q| / |p'|^4 with q =
/// p''' - 3 (p' . p'') p'' / |p'|^2 = -(3 growth m^2, r (|p'|^2 + 6 growth^2), 0) / |p'|^2 but for a part
/// along p', where m^2 = growth^2 + rise^2.
template <std::floating_point S>
[[nodiscard]] S curvature_change_at_radius(const Spiral<S>& spiral, S r) {
  const S k = spiral.growth;
  const S h = spiral.rise;
  const S g_sq = r * r + k * k + h * h;
  const S outwards = 3 * k * (k * k + h * h) / g_sq;
  const S onwards = r * (g_sq + 6 * k * k) / g_sq;
  return std::hypot(h * onwards, h * outwards, k * onwards - r * outwards) / (g_sq * g_sq);
}

/// A bound of `curvature_change_at_radius` between angle 0 and `end_angle`, at most 4 % above its largest
/// value. That is at an end; where the radius comes below 0.6 m it may be in between, less than 4 % above
/// what it is at the ends, 0.35 m and 0.55 m.
template <std::floating_point S>
[[nodiscard]] S max_curvature_change(const Spiral<S>& spiral, S end_angle) {
  const auto [low, high] = std::minmax({spiral.radius, spiral.radius_at(end_angle)});
  const S m = std::hypot(spiral.growth, spiral.rise);
  S largest(0);
  for (const S r : {low, high, std::clamp(S(0.35) * m, low, high), std::clamp(S(0.55) * m, low, high)})
    largest = std::max(largest, curvature_change_at_radius(spiral, r));
  return low < high && low < S(0.6) * m ? S(1.04) * largest : largest;
}

}  // namespace cncplan::path
