// How large the kernels of a program's junctions may be.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <span>

#include "cncplan/core/detail/long_length.hpp"
#include "cncplan/core/in_space.hpp"
#include "cncplan/core/vector.hpp"
#include "cncplan/detail/curve/kernel.hpp"

namespace cncplan::detail {

/// Which deviations count together, and which alone: that of the tool in space, and that of each axis beside
/// it.
template <std::floating_point S, int N>
struct BasicAxisTolerances {
  std::array<int, 3> tool{-1, -1, -1};              ///< as for `in_space`
  VectorN<S, N> linear = VectorN<S, N>::Zero();     ///< 1 for an axis that has the tolerance of the tool
  VectorN<S, N> per_angle = VectorN<S, N>::Zero();  ///< 1 / tolerance of a rotary axis, per rad
};

/// What the size of one correction has to keep to, and the size.
template <std::floating_point S, int N>
struct BasicSizing {
  LongLength<S> at{};  ///< mm, as in `BasicCorrection`
  Jump jump{};
  VectorN<S, N> step = VectorN<S, N>::Zero();  ///< the jump, per mm where curvature jumps
  S wanted{};                                  ///< mm: where the motion needs no larger one
  S room{};                                    ///< mm on each side that it may reach
  S tolerance{};                               ///< mm, > 0: how far the tool may leave the path here
  S left = 1;  ///< share of the tolerances of rotary axes that there is here, > 0
  S tool{};    ///< length of the jump in space; by `set_widest`
  S widest{};  ///< mm, of the kernel if it were alone; by `set_widest`
  S sum{};     ///< what the widest kernels may deviate here, over the tolerance: `deviation_sum`
  S size{};    ///< mm: `fitted_size`
};

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
  if (kind == Jump::curvature) return overshoot_gain<S> * jump * speed * speed * speed / (share * jerk);
  const S by_jerk = std::sqrt(S(2) * jump * speed * speed * speed / (S(3) * share * jerk));
  const S by_acceleration = S(2) * jump * speed * speed / (S(3) * share * acceleration);
  return std::max(by_jerk, by_acceleration);
}

/// The largest share of the tolerances at a place that deviations may take, by half of their sum and half of
/// what they add up to by size: `lengths` of the tool, `sizes` axis by axis.
template <std::floating_point S, int N>
[[nodiscard]] S share_of(const VectorN<S, N>& sum, S lengths, const VectorN<S, N>& sizes,
                         const BasicSizing<S, N>& there, const BasicAxisTolerances<S, N>& axes) {
  const S tool = (in_space(sum, axes.tool).norm() + lengths) / S(2);
  const VectorN<S, N> others = (sum.cwiseAbs() + sizes) / S(2);
  const S linear = others.cwiseProduct(axes.linear).maxCoeff();
  const S rotary = others.cwiseProduct(axes.per_angle).maxCoeff();
  return std::max(std::max(tool, linear) / there.tolerance, rotary / there.left);
}

/// How far centre j is from that of kernel i, in units of its widest size; no more than it reaches. A
/// curvature's kernel counts at every centre next to which it acts: there the place next to j counts.
template <std::floating_point S, int N>
[[nodiscard]] S distance_at(std::span<const BasicSizing<S, N>> all, std::size_t i, std::size_t j) {
  const BasicSizing<S, N>& own = all[i];
  LongLength<S> place = all[j].at;
  if (own.jump == Jump::curvature)
    for (std::size_t k = j; k != i && place == all[j].at;) place = all[k < i ? ++k : --k].at;
  return std::min(std::abs(own.at - place) / own.widest, reach<S>(own.jump));
}

/// The first of three steps to a size: that of the kernel alone, as large as wanted, as there is room for,
/// and as the tolerance allows.
template <std::floating_point S, int N>
void set_widest(BasicSizing<S, N>& own, const BasicAxisTolerances<S, N>& axes) {
  own.tool = in_space(own.step, axes.tool).norm();
  const S share = largest<S>(own.jump) * share_of<S, N>(own.step, own.tool, own.step.cwiseAbs(), own, axes);
  // A curvature's correction leaves half of the tolerance to those of directions.
  const S most = own.jump == Jump::direction ? S(1) / share : std::sqrt(S(0.5) / share);
  own.widest = own.size = std::min({own.wanted, most, own.room / reach<S>(own.jump)});
}

/// The second: what any choice of kernels of `all`, up to the widest of each, may deviate at number j of
/// them or next to it, over the tolerance.
///
/// A kernel phi of a direction only adds, so with c_i where the widest is, each deviates by part of c_i e_i,
/// e_i being the direction of its jump. Their sum along a direction u is at most
///
///     sum c_i max(0, u e_i)  <=  (|sum c_i e_i| + sum c_i) / 2,
///
/// and for each u convex between two centres, as phi is on both sides of its own: largest at a centre. psi of
/// a curvature is negative before its centre; it counts with its largest value at every centre next to which
/// it acts, at its own with both signs.
template <std::floating_point S, int N>
[[nodiscard]] S deviation_sum(std::span<const BasicSizing<S, N>> all, std::size_t j,
                              const BasicAxisTolerances<S, N>& axes) {
  VectorN<S, N> sum = VectorN<S, N>::Zero(), sizes = sum;
  S lengths = S(0);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const BasicSizing<S, N>& own = all[i];
    const S u = distance_at(all, i, j);
    if (!(u < reach<S>(own.jump))) continue;
    S deviates = own.jump == Jump::direction ? own.widest * kernel(own.jump, u)[0]
                                             : own.widest * own.widest * largest<S>(own.jump);
    if (own.jump == Jump::direction || own.at < all[j].at)
      sum += deviates * own.step;
    else if (own.at > all[j].at)
      sum -= deviates * own.step;
    else
      deviates *= S(2);  // on both sides
    sizes += deviates * own.step.cwiseAbs();
    lengths += deviates * own.tool;
  }
  return share_of(sum, lengths, sizes, all[j], axes);
}

/// The third: the size of number i of `all`. One pass is enough: where the deviations add up to D > 1
/// tolerances, kernels made smaller by D deviate less by D at least.
template <std::floating_point S, int N>
[[nodiscard]] S fitted_size(std::span<const BasicSizing<S, N>> all, std::size_t i) {
  S size = all[i].size;
  for (std::size_t j = 0; j < all.size(); ++j)
    if (all[j].sum > S(1) && distance_at(all, i, j) < reach<S>(all[i].jump))
      size = std::min(size, all[i].widest / all[j].sum);
  return size;
}

}  // namespace cncplan::detail
