// How large the kernels of a program's junctions may be.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>
#include <utility>

#include "cncplan/smooth/kernel.hpp"

namespace cncplan::smooth {

/// What the size of one correction has to keep to, and the size. `tool` and `others` are sizes of its jump,
/// per mm where curvature jumps.
template <std::floating_point S>
struct BasicSizing {
  double at{};  ///< mm, as in `BasicCorrection`
  Jump jump{};
  S wanted{};     ///< mm: where the motion needs no larger one
  S room{};       ///< mm on each side that it may reach
  S tool{};       ///< length of the jump in space
  S others{};     ///< largest jump of another axis, over the tolerance of that axis
  S tolerance{};  ///< mm, > 0: how far the tool may leave the path here
  S left = 1;     ///< share of the tolerances of other axes that there is here, > 0
  S widest{};     ///< mm, of the kernel if it were alone; by `fit_sizes`
  S sum{};        ///< what the widest kernels deviate here, over the tolerance; by `fit_sizes`
  S size{};       ///< mm, by `fit_sizes`

  /// What a kernel of this size deviates at its centre over the tolerances at a place.
  [[nodiscard]] S deviation(S kernel_size, const BasicSizing& there) const {
    return largest<S>(jump) * std::max(tool / there.tolerance, others / there.left) *
           (jump == Jump::direction ? kernel_size : kernel_size * kernel_size);
  }
};

using Sizing = BasicSizing<double>;

/// Kernels reach over no more than so many junctions on each side: what bounds the work for one.
inline constexpr std::size_t most_neighbours = 16;

/// How much of the jerk and acceleration limits the bends of corrections take at full speed, where they are
/// as large as they want to be. The rest is for changes of speed.
template <std::floating_point S>
inline constexpr S bend_share = S(0.15);

/// The size from which on a jump takes no more than `bend_share` of the limits at a speed: by the largest
/// derivatives of the kernels,
///
///     |q'''| = (2/3) d / w^2,  |q''| = (2/3) d / w   for a jump d of direction,
///     |q'''| = 0.67560 d / m                          for one of curvature, which has the rest of the size.
template <std::floating_point S>
[[nodiscard]] S wanted_size(Jump kind, S jump, S speed, S acceleration, S jerk) {
  constexpr S share = bend_share<S>;
  if (!(jump > S(0))) return S(0);
  if (kind == Jump::curvature)
    return detail::overshoot_gain<S> * jump * speed * speed * speed / (share * jerk);
  const S by_jerk = std::sqrt(S(2) * jump * speed * speed * speed / (S(3) * share * jerk));
  const S by_acceleration = S(2) * jump * speed * speed / (S(3) * share * acceleration);
  return std::max(by_jerk, by_acceleration);
}

namespace detail {

/// What kernel i deviates at centre j or next to it, over the tolerance there. phi is convex on both sides of
/// its centre, so a sum of them is largest at a centre; psi is counted with its largest value at every centre
/// next to which it acts.
template <std::floating_point S>
[[nodiscard]] S deviation_at(std::span<const BasicSizing<S>> all, std::size_t i, std::size_t j) {
  const BasicSizing<S>& own = all[i];
  const S size = own.widest;
  double place = all[j].at;
  if (own.jump == Jump::curvature)
    for (std::size_t k = j; k != i && place == all[j].at;) place = all[k < i ? ++k : --k].at;
  const S x = static_cast<S>(std::abs(own.at - place));
  if (!(x < size * reach<S>(own.jump))) return S(0);
  const S most = own.deviation(size, all[j]);
  if (own.jump == Jump::curvature) return most;
  return most * kernel(Jump::direction, x / size)[0] / largest<S>(Jump::direction);
}

}  // namespace detail

/// The first of three steps to a size: that of the kernel alone, as large as wanted, as there is room for,
/// and as the tolerance allows.
template <std::floating_point S>
void set_widest(BasicSizing<S>& own) {
  const S share = own.deviation(S(1), own);
  // A curvature's correction leaves half of the tolerance to those of directions.
  const S most = own.jump == Jump::direction ? S(1) / share : std::sqrt(S(0.5) / share);
  own.widest = own.size = std::min({own.wanted, most, own.room / reach<S>(own.jump)});
}

/// The second: the sum of what the widest kernels of `all` deviate at number j of them, over the tolerance.
template <std::floating_point S>
[[nodiscard]] S deviation_sum(std::span<const BasicSizing<S>> all, std::size_t j) {
  S sum = S(0);
  for (std::size_t i = 0; i < all.size(); ++i) sum += detail::deviation_at(all, i, j);
  return sum;
}

/// The third: the size of number i of `all`. One pass is enough: where the deviations add up to D > 1
/// tolerances, kernels made smaller by D deviate less by D at least.
template <std::floating_point S>
[[nodiscard]] S fitted_size(std::span<const BasicSizing<S>> all, std::size_t i) {
  S size = all[i].size;
  for (std::size_t j = 0; j < all.size(); ++j)
    if (all[j].sum > S(1) && detail::deviation_at(all, i, j) > S(0))
      size = std::min(size, all[i].widest / all[j].sum);
  return size;
}

/// Finds the sizes for corrections in order of their places, at most two at one: as large as wanted, as there
/// is room for, and as the tolerance allows where kernels overlap.
template <std::floating_point S>
void fit_sizes(std::span<BasicSizing<S>> all) {
  constexpr std::size_t window = 2 * most_neighbours + 1;
  const auto around = [&](std::size_t j) {
    const std::size_t first = j > window ? j - window : 0;
    return std::pair(
        std::span<const BasicSizing<S>>(all).subspan(first, std::min(j + window + 1, all.size()) - first),
        j - first);
  };
  for (BasicSizing<S>& own : all) set_widest(own);
  for (std::size_t j = 0; j < all.size(); ++j) {
    const auto [near, at] = around(j);
    all[j].sum = deviation_sum(near, at);
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto [near, at] = around(i);
    all[i].size = fitted_size(near, at);
  }
}

}  // namespace cncplan::smooth
