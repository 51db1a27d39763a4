// Proof that a phase of constant jerk on a cell keeps the limits of all axes: bounds, not samples.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>

#include "cncplan/core/motion_limits.hpp"
#include "cncplan/core/phase.hpp"
#include "cncplan/detail/speed/speed_cell.hpp"

namespace cncplan::detail {

/// Largest shares of their limits that velocity, acceleration and jerk reach: 1 is the limit.
template <std::floating_point S>
struct BasicUtilisation {
  S velocity{};
  S acceleration{};
  S jerk{};

  /// What is not a number counts as more than any limit.
  void include(const BasicUtilisation& other) {
    const auto larger = [](S a, S b) { return a >= b ? a : b == b ? b : std::numeric_limits<S>::infinity(); };
    velocity = larger(velocity, other.velocity);
    acceleration = larger(acceleration, other.acceleration);
    jerk = larger(jerk, other.jerk);
  }
  /// By how much the clock would have to slow down for the limits to hold, at most 1 where they do: those of
  /// acceleration and jerk, and all of them.
  [[nodiscard]] S force() const { return std::max(std::sqrt(acceleration), std::cbrt(jerk)); }
  [[nodiscard]] S slow_down() const { return std::max(velocity, force()); }
};

using Utilisation = BasicUtilisation<double>;

/// A polynomial over [0, 1] by its powers, lowest first.
template <std::floating_point S, std::size_t Size>
using Powers = std::array<S, Size>;

template <std::floating_point S, std::size_t A, std::size_t B>
[[nodiscard]] constexpr Powers<S, A + B - 1> product(const Powers<S, A>& a, const Powers<S, B>& b) {
  Powers<S, A + B - 1> result{};
  for (std::size_t i = 0; i < A; ++i)
    for (std::size_t k = 0; k < B; ++k) result[i + k] += a[i] * b[k];
  return result;
}

/// a + factor b; a has the higher degree.
template <std::floating_point S, std::size_t A, std::size_t B>
[[nodiscard]] constexpr Powers<S, A> sum(Powers<S, A> a, S factor, const Powers<S, B>& b) {
  static_assert(A >= B);
  for (std::size_t i = 0; i < B; ++i) a[i] += factor * b[i];
  return a;
}

/// What each power, a row, adds to the Bernstein coefficients of degree Size - 1: coefficient i is the sum of
/// C(i, k) / C(Size - 1, k) a_k over k.
template <std::floating_point S, std::size_t Size>
inline constexpr auto bernstein_rows = [] {
  std::array<std::array<S, Size>, Size> rows{};
  for (std::size_t k = 0; k < Size; ++k)
    for (std::size_t i = k; i < Size; ++i) {
      S share = S(1);
      for (std::size_t m = 0; m < k; ++m) share *= static_cast<S>(i - m) / static_cast<S>(Size - 1 - m);
      rows[k][i] = share;
    }
  return rows;
}();

/// Bernstein coefficients, of degree Size - 1: the polynomial lies in their hull.
template <std::size_t Size, std::floating_point S, std::size_t A>
[[nodiscard]] constexpr std::array<S, Size> bernstein(const Powers<S, A>& a) {
  static_assert(A <= Size);
  std::array<S, Size> result{};
  for (std::size_t k = 0; k < A; ++k)
    for (std::size_t i = 0; i < Size; ++i) result[i] += bernstein_rows<S, Size>[k][i] * a[k];
  return result;
}

/// The largest square of a norm over the control points a_i q' + b_i q'' + c_i q'''.
template <std::size_t Size, std::floating_point S>
[[nodiscard]] constexpr S largest_sq(const std::array<S, Size>& a, const std::array<S, Size>& b,
                                     const std::array<S, Size>& c, const std::array<S, 6>& p) {
  S most = S(0);
  for (std::size_t i = 0; i < Size; ++i) {
    const S square = a[i] * a[i] * p[0] + b[i] * b[i] * p[3] + c[i] * c[i] * p[5] +
                     S(2) * (a[i] * b[i] * p[1] + a[i] * c[i] * p[2] + b[i] * c[i] * p[4]);
    if (!(square <= most)) most = square == square ? square : std::numeric_limits<S>::infinity();
  }
  return most;
}

/// What the limits see of a place of a path: the products of q', q'' and q''', in the order 11 12 13 22
/// 23 33.
template <class V, class Product>
[[nodiscard]] std::array<typename V::Scalar, 6> products(const V& first, const V& second, const V& third,
                                                         const Product& product) {
  return {product(first, first),   product(first, second), product(first, third),
          product(second, second), product(second, third), product(third, third)};
}

/// Bounds of the use of all limits, and of the cell's feed, throughout a phase that begins at
/// `phase.position` mm of the cell and stays within it. Position is a polynomial of degree 9 in time, so
/// velocity, acceleration and jerk are of degree 8, 7 and 6; they lie in the hulls of their Bernstein
/// coefficients.
template <std::floating_point S, int N>
[[nodiscard]] BasicUtilisation<S> utilisation_of(const BasicPhase<S>& phase, const BasicSpeedCell<S, N>& cell,
                                                 const BasicMotionLimits<S, N>& limits) {
  const S T = phase.duration;
  // By time as a share of the phase.
  const Powers<S, 2> a{phase.acceleration, phase.jerk * T};
  const Powers<S, 3> v{phase.velocity, phase.acceleration * T, phase.jerk * T * T / S(2)};
  const Powers<S, 4> x{phase.position, v[0] * T, v[1] * T / S(2), v[2] * T / S(3)};
  const auto xx = product(x, x);
  const auto vv = product(v, v);
  const auto va = product(v, a);
  const auto speed0 = bernstein<9>(v), speed1 = bernstein<9>(product(x, v));
  auto speed2 = bernstein<9>(product(xx, v));
  for (S& c : speed2) c /= S(2);
  const auto turn0 = bernstein<8>(a), turn1 = bernstein<8>(sum(product(x, a), S(1), vv));
  const auto turn2 = bernstein<8>(sum(product(x, vv), S(0.5), product(xx, a)));
  auto jerk1 = x;
  for (S& c : jerk1) c *= phase.jerk;
  Powers<S, 7> jerk2 = product(vv, v);
  jerk2 = sum(jerk2, S(3), product(x, va));
  jerk2 = sum(jerk2, phase.jerk / S(2), xx);
  const auto change0 = bernstein<7>(Powers<S, 1>{phase.jerk});
  const auto change1 = bernstein<7>(sum(jerk1, S(3), va)), change2 = bernstein<7>(jerk2);

  // What the part of q''' that the cell does not know adds, for each unit of it.
  S top = std::max(phase.velocity, S(0)), slope = std::abs(phase.acceleration);
  {
    const BasicState<S> end = phase.at(T);
    slope = std::max(slope, std::abs(end.acceleration));
    top = std::max(phase.velocity, end.velocity) + std::abs(phase.jerk) * T * T / S(8);
  }
  const S s = cell.length;
  const S speed_more = s * s / S(2) * top;
  const S turn_more = s * s / S(2) * slope + s * top * top;
  const S jerk_more = s * s / S(2) * std::abs(phase.jerk) + S(3) * s * top * slope + top * top * top;

  BasicUtilisation<S> utilisation;
  for_each_limit(limits, [&]<class Product>(const BasicLimits<S>& own, const Product& inner) {
    const auto p = products(cell.first, cell.second, cell.third, inner);
    const S spread = std::sqrt(inner(cell.spread, cell.spread));
    const S speed = std::sqrt(largest_sq(speed0, speed1, speed2, p)) + spread * speed_more;
    utilisation.include(
        {speed / own.velocity,
         (std::sqrt(largest_sq(turn0, turn1, turn2, p)) + spread * turn_more) / own.acceleration,
         (std::sqrt(largest_sq(change0, change1, change2, p)) + spread * jerk_more) / own.jerk});
    if constexpr (std::same_as<Product, ToolProduct>) utilisation.include({speed / cell.feed, S(0), S(0)});
  });
  utilisation.include({*std::max_element(speed0.begin(), speed0.end()) / cell.feed, S(0), S(0)});
  return utilisation;
}

}  // namespace cncplan::detail
