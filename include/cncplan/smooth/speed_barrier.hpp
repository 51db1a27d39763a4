// Time and nearness to the limits of a law of speed, cell by cell, with first and second derivatives.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>

#include "cncplan/smooth/motion_bounds.hpp"
#include "cncplan/smooth/speed_law.hpp"

namespace cncplan::smooth {

/// A function of the three Bezier coefficients of b in a cell: value, gradient, and a Hessian that is never
/// indefinite, in the order 00 01 02 11 12 22.
template <std::floating_point S>
struct BasicCellModel {
  S value{};
  std::array<S, 3> gradient{};
  std::array<S, 6> hessian{};
};

namespace detail {

/// b, b' and b'' at a place of a cell from its Bezier coefficients: rows of numbers.
template <std::floating_point S>
struct Place {
  std::array<S, 3> b, slope, bend;
};

/// Start, middle and end.
template <std::floating_point S>
[[nodiscard]] constexpr std::array<Place<S>, 3> places(S length) {
  const S h = S(1) / length, hh = S(2) * h * h;
  const std::array<S, 3> bend{hh, S(-2) * hh, hh};
  return {{{{S(1), S(0), S(0)}, {S(-2) * h, S(2) * h, S(0)}, bend},
           {{S(0.25), S(0.5), S(0.25)}, {-h, S(0), h}, bend},
           {{S(0), S(0), S(1)}, {S(0), S(-2) * h, S(2) * h}, bend}}};
}

template <std::floating_point S>
[[nodiscard]] constexpr S row(const std::array<S, 3>& numbers, const BasicCellSpeed<S>& b) {
  return numbers[0] * b.start + numbers[1] * b.middle + numbers[2] * b.end;
}

/// Squares of the limits at one place, as shares: each must stay below 1.
template <std::floating_point S>
struct Shares {
  S b, slope, bend;            // of the law
  std::array<S, 6> p;          // products of q', q'', q'''
  S acceleration_sq, jerk_sq;  // reciprocal squares of the limits; 0: none

  /// acceleration = q'' b + q' b'/2
  [[nodiscard]] S acceleration() const {
    return acceleration_sq * (p[3] * b * b + p[1] * b * slope + p[0] * slope * slope / S(4));
  }
  /// jerk / sqrt(b) = q''' b + 3/2 q'' b' + q' b''/2: the gradient of half its square
  [[nodiscard]] std::array<S, 3> pull() const {
    return {p[5] * b + S(1.5) * p[4] * slope + S(0.5) * p[2] * bend,
            S(1.5) * p[4] * b + S(2.25) * p[3] * slope + S(0.75) * p[1] * bend,
            S(0.5) * p[2] * b + S(0.75) * p[1] * slope + S(0.25) * p[0] * bend};
  }
  [[nodiscard]] S jerk() const {
    const auto y = pull();
    return jerk_sq * b * (y[0] * b + y[1] * slope + y[2] * bend);
  }
};

/// The reciprocal of the highest b at a place, by the feed and by the limits of velocity.
template <std::floating_point S, int N>
[[nodiscard]] S least_speed_sq(const BasicSpeedCell<S, N>& cell, const VectorN<S, N>& first,
                               const BasicMotionLimits<S, N>& limits) {
  const ToolProduct tool{limits.tool_axes};
  S most = std::max(S(1), tool(first, first)) / (cell.feed * cell.feed);
  for_each_limit(limits, [&](const BasicLimits<S>& own, const auto& inner) {
    most = std::max(most, inner(first, first) / (own.velocity * own.velocity));
  });
  return most;
}

template <std::floating_point S>
[[nodiscard]] constexpr S reciprocal_square(S limit) {
  return limit < std::numeric_limits<S>::infinity() ? S(1) / (limit * limit) : S(0);
}

}  // namespace detail

/// By how much the limits in a cell are lowered: velocities to one share, accelerations to the square of the
/// other and jerks to its cube, as if the clock ran so much slower.
template <std::floating_point S>
struct BasicPace {
  S speed = S(1);
  S force = S(1);

  [[nodiscard]] constexpr S acceleration() const { return force * force; }
  [[nodiscard]] constexpr S jerk() const { return force * force * force; }
};

/// The use of the limits at the start, the middle and the end of a cell; infinite where b is not positive.
template <std::floating_point S, int N>
[[nodiscard]] BasicUse<S> sampled_use(const BasicSpeedCell<S, N>& cell, const BasicMotionLimits<S, N>& limits,
                                      const BasicCellSpeed<S>& law) {
  constexpr S none = std::numeric_limits<S>::infinity();
  BasicUse<S> use;
  const auto places = detail::places(cell.length);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const S at = cell.length * static_cast<S>(i) / S(2), b = detail::row(places[i].b, law);
    if (!(b > S(0))) return {none, none, none};
    const auto first = cell.first_at(at), second = cell.second_at(at);
    use.include({std::sqrt(b * detail::least_speed_sq(cell, first, limits)), S(0), S(0)});
    for_each_limit(limits, [&](const BasicLimits<S>& own, const auto& inner) {
      const detail::Shares<S> shares{b,
                                     detail::row(places[i].slope, law),
                                     detail::row(places[i].bend, law),
                                     products(first, second, cell.third, inner),
                                     detail::reciprocal_square(own.acceleration),
                                     detail::reciprocal_square(own.jerk)};
      use.include(
          {S(0), std::sqrt(std::max(shares.acceleration(), S(0))), std::sqrt(std::max(shares.jerk(), S(0)))});
    });
  }
  return use;
}

/// The time through a cell (Simpson's rule on 1/sqrt(b)), and the barrier: the sum of -log(1 - share^2) over
/// all limits at the start, the middle and the end of the cell. Infinite where a limit is not kept.
template <std::floating_point S>
struct BasicCellCost {
  S time{};
  S barrier{};
};

template <std::floating_point S, int N>
[[nodiscard]] BasicCellCost<S> cell_cost(const BasicSpeedCell<S, N>& cell,
                                         const BasicMotionLimits<S, N>& limits, BasicPace<S> pace,
                                         const BasicCellSpeed<S>& law) {
  constexpr S none = std::numeric_limits<S>::infinity();
  const auto places = detail::places(cell.length);
  const S speed_sq = detail::reciprocal_square(pace.speed);
  const S acceleration_sq = detail::reciprocal_square(pace.acceleration()),
          jerk_sq = detail::reciprocal_square(pace.jerk());
  BasicCellCost<S> cost;
  S room = S(1);  // the product of what is left of all limits
  bool inside = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const S at = cell.length * static_cast<S>(i) / S(2), b = detail::row(places[i].b, law);
    if (!(b > S(0))) return {none, none};
    const auto first = cell.first_at(at), second = cell.second_at(at);
    const auto take = [&](S share) {
      if (!(share < S(1))) inside = false;
      room *= S(1) - share;
    };
    take(b * speed_sq * detail::least_speed_sq(cell, first, limits));
    for_each_limit(limits, [&](const BasicLimits<S>& own, const auto& inner) {
      const detail::Shares<S> shares{b,
                                     detail::row(places[i].slope, law),
                                     detail::row(places[i].bend, law),
                                     products(first, second, cell.third, inner),
                                     acceleration_sq * detail::reciprocal_square(own.acceleration),
                                     jerk_sq * detail::reciprocal_square(own.jerk)};
      if (shares.acceleration_sq > S(0)) take(shares.acceleration());
      if (shares.jerk_sq > S(0)) take(shares.jerk());
    });
    cost.time += (i == 1 ? S(4) : S(1)) * cell.length / (S(6) * std::sqrt(b));
    if (room < S(1e-30)) {
      if (!inside || !(room > S(0))) return {none, none};
      cost.barrier -= std::log(room);
      room = S(1);
    }
  }
  if (!inside) return {none, none};
  cost.barrier -= std::log(room);
  return cost;
}

/// Gradient and Hessian of time + weight * barrier. All terms are convex but the jerk's: with u = b |y|^2 /
/// J^2 and y = q''' b + 3/2 q'' b' + q' b''/2, linear in (b, b', b''), the Hessian of u is positive but for
/// -2 u / b^2 in its first entry, which is left out.
template <std::floating_point S, int N>
[[nodiscard]] BasicCellModel<S> cell_model(const BasicSpeedCell<S, N>& cell,
                                           const BasicMotionLimits<S, N>& limits, BasicPace<S> pace,
                                           const BasicCellSpeed<S>& law, S weight) {
  const auto places = detail::places(cell.length);
  const S speed_sq = detail::reciprocal_square(pace.speed);
  const S acceleration_sq = detail::reciprocal_square(pace.acceleration()),
          jerk_sq = detail::reciprocal_square(pace.jerk());
  BasicCellModel<S> model;
  for (std::size_t i = 0; i < 3; ++i) {
    const detail::Place<S>& place = places[i];
    const S at = cell.length * static_cast<S>(i) / S(2);
    const S b = detail::row(place.b, law), slope = detail::row(place.slope, law),
            bend = detail::row(place.bend, law);
    const auto first = cell.first_at(at), second = cell.second_at(at);
    // By b, b' and b''.
    std::array<S, 3> g{};
    std::array<S, 6> H{};
    const S w = (i == 1 ? S(4) : S(1)) * cell.length / S(6), root = S(1) / std::sqrt(b);
    g[0] = -w * root / (S(2) * b);
    H[0] = S(0.75) * w * root / (b * b);
    const S cap = speed_sq * detail::least_speed_sq(cell, first, limits), left = cap / (S(1) - b * cap);
    g[0] += weight * left;
    H[0] += weight * left * left;
    for_each_limit(limits, [&](const BasicLimits<S>& own, const auto& inner) {
      const auto p = products(first, second, cell.third, inner);
      const detail::Shares<S> shares{b,
                                     slope,
                                     bend,
                                     p,
                                     acceleration_sq * detail::reciprocal_square(own.acceleration),
                                     jerk_sq * detail::reciprocal_square(own.jerk)};
      if (const S k = shares.acceleration_sq; k > S(0)) {
        const S f = S(1) / (S(1) - shares.acceleration());
        const S x = f * k * (S(2) * p[3] * b + p[1] * slope), y = f * k * (p[1] * b + p[0] * slope / S(2));
        g[0] += weight * x;
        g[1] += weight * y;
        H[0] += weight * (x * x + f * k * S(2) * p[3]);
        H[1] += weight * (x * y + f * k * p[1]);
        H[3] += weight * (y * y + f * k * p[0] / S(2));
      }
      if (const S k = shares.jerk_sq; k > S(0)) {
        const auto y = shares.pull();
        const S square = y[0] * b + y[1] * slope + y[2] * bend;
        const S f = S(1) / (S(1) - k * b * square);
        const S kf = k * f, two = S(2) * kf;
        const std::array<S, 3> d{kf * (square + S(2) * b * y[0]), two * b * y[1], two * b * y[2]};
        for (std::size_t q = 0; q < 3; ++q) g[q] += weight * d[q];
        H[0] += weight * (d[0] * d[0] + two * (b * p[5] + S(2) * y[0] + square / b));
        H[1] += weight * (d[0] * d[1] + two * (S(1.5) * b * p[4] + y[1]));
        H[2] += weight * (d[0] * d[2] + two * (S(0.5) * b * p[2] + y[2]));
        H[3] += weight * (d[1] * d[1] + two * S(2.25) * b * p[3]);
        H[4] += weight * (d[1] * d[2] + two * S(0.75) * b * p[1]);
        H[5] += weight * (d[2] * d[2] + two * S(0.25) * b * p[0]);
      }
    });
    // To the Bezier coefficients.
    const auto& [r0, r1, r2] = place;
    std::size_t entry = 0;
    for (std::size_t q = 0; q < 3; ++q) {
      model.gradient[q] += g[0] * r0[q] + g[1] * r1[q] + g[2] * r2[q];
      const S h0 = H[0] * r0[q] + H[1] * r1[q] + H[2] * r2[q];
      const S h1 = H[1] * r0[q] + H[3] * r1[q] + H[4] * r2[q];
      const S h2 = H[2] * r0[q] + H[4] * r1[q] + H[5] * r2[q];
      for (std::size_t r = q; r < 3; ++r) model.hessian[entry++] += h0 * r0[r] + h1 * r1[r] + h2 * r2[r];
    }
  }
  return model;
}

}  // namespace cncplan::smooth
