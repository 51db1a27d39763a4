// Many crossings of one coordinate of a spiral at once: circles corrected by the local radius.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>

#include "cncplan/path/detail/arc_axis.hpp"
#include "cncplan/path/detail/circle_crossings.hpp"

namespace cncplan::path {

/// `axis.crossing` for each of `values` in place, for any spiral. With w the angle from `low` on, the
/// coordinate is A (rho cos w - 1) + B rho sin w from its value there, rho = 1 + g w. The circle through
/// `low` (g = 0) gives a first w together with sine and cosine there, in closed form; two steps to the root
/// of the parabola that agrees in value and two derivatives follow, each of which turns sine and cosine on by
/// its own small angle. A step leaves an error of third order. Where the second is not small enough, or a
/// root is missing, near turnings or where the radius changes much, the crossing is solved for by itself.
template <std::floating_point S>
void spiral_crossings(const ArcAxis<S>& axis, std::span<S> values, S low, S high) {
  constexpr std::size_t chunk = 32;
  constexpr S epsilon = std::numeric_limits<S>::epsilon();
  constexpr S widest = S(1) / 16;  // radians for which the series below hold to rounding
  const S s = std::sin(low);
  const S c = std::cos(low);
  const S rho_low = S(1) + axis.growth * low;
  const S value = axis.value(low);
  const S a = rho_low * (axis.radial * c + axis.tangential * s);
  const S b = rho_low * (axis.tangential * c - axis.radial * s);
  const S g = axis.growth / rho_low;
  constexpr S tiny = std::numeric_limits<S>::min();  // no division by zero at a turning
  const S sense = axis.value(low + (high - low) / 2) < value ? S(-1) : S(1);
  const S speed =
      sense * b;  // of the circle; below zero between a turning of the spiral and the circle's own
  while (!values.empty()) {
    const std::size_t count = std::min(values.size(), chunk);
    // Square roots have loops of their own: they are what compilers do not vectorise together with the rest.
    std::array<S, chunk> deltas, angles, turned, onward, root, excess, first, error, trouble;
    for (std::size_t i = 0; i < count; ++i) {
      deltas[i] = values[i] - value;
      root[i] = b * b - deltas[i] * (deltas[i] + 2 * a);
      trouble[i] = root[i] < S(0) ? S(1) : S(0);
    }
    for (std::size_t i = 0; i < count; ++i) root[i] = std::sqrt(std::max(root[i], S(0)));
    for (std::size_t i = 0; i < count; ++i) {
      const S ahead = sense * deltas[i];
      angles[i] = 2 * arctangent(ahead > S(0) ? ahead : S(0), speed + root[i] + tiny);
      turned[i] = deltas[i];  // cosine's part less a, kept for itself so that flat arcs lose no digits
      onward[i] = sense * root[i];
    }
    for (int round = 0; round < 2; ++round) {
      for (std::size_t i = 0; i < count; ++i) {
        const S across = a + turned[i];
        const S rho = S(1) + g * angles[i];
        excess[i] = turned[i] - deltas[i] + g * angles[i] * across;
        first[i] = g * across + rho * onward[i];
        root[i] = first[i] * first[i] - 2 * excess[i] * (2 * g * onward[i] - rho * across);
        trouble[i] = root[i] < S(0) ? S(1) : trouble[i];
      }
      for (std::size_t i = 0; i < count; ++i) root[i] = std::sqrt(std::max(root[i], S(0)));
      for (std::size_t i = 0; i < count; ++i) {
        const S step = -2 * excess[i] / (first[i] + sense * (root[i] + tiny));
        const S z = step * step;
        const S sine =
            step * (S(1) - z * (S(1) / 6 - z * (S(1) / 120 - z * (S(1) / 5040 - z * (S(1) / 362880)))));
        const S versine = z * (S(1) / 2 - z * (S(1) / 24 - z * (S(1) / 720 - z * (S(1) / 40320))));
        const S across = a + turned[i];
        turned[i] += onward[i] * sine - across * versine;
        onward[i] -= across * sine + onward[i] * versine;
        angles[i] += step;
        error[i] = std::abs(step * z);
        trouble[i] = std::abs(step) < widest ? trouble[i] : S(1);
      }
    }
    for (std::size_t i = 0; i < count; ++i) {
      const bool solved = speed >= S(0) && error[i] <= epsilon && trouble[i] == S(0);
      values[i] = solved ? std::clamp(low + angles[i], low, high) : axis.crossing(values[i], low, high);
    }
    values = values.subspan(count);
  }
}

}  // namespace cncplan::path
