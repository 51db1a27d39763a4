// Time and nearness to the limits of a law of speed, cell by cell, with first and second derivatives.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>

#include "cncplan/smooth/motion_bounds.hpp"
#include "cncplan/smooth/speed_law.hpp"

namespace cncplan::smooth {

/// A function of the three Bezier coefficients of b in a cell: gradient, and a Hessian that is never
/// indefinite, in the order 00 01 02 11 12 22.
template <std::floating_point S>
struct BasicCellModel {
  std::array<S, 3> gradient{};
  std::array<S, 6> hessian{};
};

/// One limit of acceleration and jerk at one place of a path: squares as shares of the limits' squares, each
/// to stay below 1, by b, b' and b'' there. The prices are the multipliers of an interior-point method: what
/// the time gains by a higher limit.
template <std::floating_point S>
struct BasicForceShare {
  std::array<S, 6> p{};  ///< products of q', q'', q'''
  S acceleration_sq{};   ///< reciprocal square of the limit; 0: none
  S jerk_sq{};           ///< the same of jerk
  S acceleration_price{};
  S jerk_price{};

  /// acceleration = q'' b + q' b'/2
  [[nodiscard]] S acceleration(S b, S slope) const {
    return acceleration_sq * (p[3] * b * b + p[1] * b * slope + p[0] * slope * slope / S(4));
  }
  /// The derivatives of that share by b and b'.
  [[nodiscard]] std::array<S, 2> by_acceleration(S b, S slope) const {
    return {acceleration_sq * (S(2) * p[3] * b + p[1] * slope),
            acceleration_sq * (p[1] * b + p[0] * slope / S(2))};
  }
  /// jerk / sqrt(b) = q''' b + 3/2 q'' b' + q' b''/2: the gradient of half its square
  [[nodiscard]] std::array<S, 3> pull(S b, S slope, S bend) const {
    return {p[5] * b + S(1.5) * p[4] * slope + S(0.5) * p[2] * bend,
            S(1.5) * p[4] * b + S(2.25) * p[3] * slope + S(0.75) * p[1] * bend,
            S(0.5) * p[2] * b + S(0.75) * p[1] * slope + S(0.25) * p[0] * bend};
  }
  [[nodiscard]] S jerk(S b, S slope, S bend) const {
    const auto y = pull(b, slope, bend);
    return jerk_sq * b * (y[0] * b + y[1] * slope + y[2] * bend);
  }
};

/// The limit of b at one place: its reciprocal, and its price.
template <std::floating_point S>
struct BasicSpeedShare {
  S speed_sq{};
  S price{};
};

/// The limits of a cell at its start, its middle and its end: three of the speed, and all others of one place
/// after those of the other.
template <std::floating_point S>
struct BasicCellShares {
  BasicCellShape<S> shape{};
  std::span<BasicSpeedShare<S>> speeds;
  std::span<BasicForceShare<S>> forces;

  [[nodiscard]] std::span<BasicForceShare<S>> forces_at(std::size_t place) const {
    return forces.subspan(place * (forces.size() / 3), forces.size() / 3);
  }
};

namespace detail {

/// b, b' and b'' at a place of a cell from its Bezier coefficients: rows of numbers.
template <std::floating_point S>
struct Place {
  std::array<S, 3> b, slope, bend;
};

/// Start, middle and end.
template <std::floating_point S>
[[nodiscard]] constexpr std::array<Place<S>, 3> places(const BasicCellShape<S>& shape) {
  const S length = shape.length, skew = shape.skew;
  const S first = S(1) / shape.to_middle(), last = S(1) / shape.from_middle();
  const auto bend = [&](S share) {
    const S k = share / length;
    return std::array<S, 3>{k * first, -k * (first + last), k * last};
  };
  // At the middle: by b' at the start and the mean of b''.
  const S b = length * (S(0.125) - skew / S(12)), slope = S(0.5) - skew / S(4);
  return {{{{S(1), S(0), S(0)}, {-first, first, S(0)}, bend(S(1) - skew)},
           {{S(1) + (b - length / S(2)) * first, (length / S(2) - b) * first - b * last, b * last},
            {(slope - S(1)) * first, (S(1) - slope) * first - slope * last, slope * last},
            bend(S(1))},
           {{S(0), S(0), S(1)}, {S(0), -last, last}, bend(S(1) + skew)}}};
}

template <std::floating_point S>
[[nodiscard]] constexpr S row(const std::array<S, 3>& numbers, const BasicCellSpeed<S>& b) {
  return numbers[0] * b.start + numbers[1] * b.middle + numbers[2] * b.end;
}

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

/// How many limits `for_each_limit` has.
template <std::floating_point S, int N>
[[nodiscard]] std::size_t limit_count(const BasicMotionLimits<S, N>& limits) {
  std::size_t count = 0;
  for_each_limit(limits, [&](const auto&, const auto&) { ++count; });
  return count;
}

/// Writes the limits of a cell, lowered to a pace, and leaves the prices.
template <std::floating_point S, int N>
void set_shares(const BasicSpeedCell<S, N>& cell, const BasicMotionLimits<S, N>& limits,
                const BasicPace<S>& pace, const BasicCellShares<S>& shares) {
  const S acceleration_sq = detail::reciprocal_square(pace.acceleration()),
          jerk_sq = detail::reciprocal_square(pace.jerk());
  for (std::size_t i = 0; i < 3; ++i) {
    const S at = cell.length * static_cast<S>(i) / S(2);
    const auto first = cell.first_at(at), second = cell.second_at(at);
    shares.speeds[i].speed_sq = detail::least_speed_sq(cell, first, limits) / (pace.speed * pace.speed);
    auto force = shares.forces_at(i).begin();
    for_each_limit(limits, [&](const BasicLimits<S>& own, const auto& inner) {
      force->p = products(first, second, cell.third, inner);
      force->acceleration_sq = acceleration_sq * detail::reciprocal_square(own.acceleration);
      force->jerk_sq = jerk_sq * detail::reciprocal_square(own.jerk);
      ++force;
    });
  }
}

/// The use of the limits at the start, the middle and the end of a cell; infinite where b is not positive.
template <std::floating_point S, int N>
[[nodiscard]] BasicUse<S> sampled_use(const BasicSpeedCell<S, N>& cell, const BasicMotionLimits<S, N>& limits,
                                      const BasicCellSpeed<S>& law) {
  constexpr S none = std::numeric_limits<S>::infinity();
  BasicUse<S> use;
  const auto places = detail::places(cell.shape());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const S at = cell.length * static_cast<S>(i) / S(2), b = detail::row(places[i].b, law);
    if (!(b > S(0))) return {none, none, none};
    const auto first = cell.first_at(at), second = cell.second_at(at);
    use.include({std::sqrt(b * detail::least_speed_sq(cell, first, limits)), S(0), S(0)});
    for_each_limit(limits, [&](const BasicLimits<S>& own, const auto& inner) {
      const S slope = detail::row(places[i].slope, law), bend = detail::row(places[i].bend, law);
      const BasicForceShare<S> share{products(first, second, cell.third, inner),
                                     detail::reciprocal_square(own.acceleration),
                                     detail::reciprocal_square(own.jerk), S(0), S(0)};
      use.include({S(0), std::sqrt(std::max(share.acceleration(b, slope), S(0))),
                   std::sqrt(std::max(share.jerk(b, slope, bend), S(0)))});
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

template <std::floating_point S>
[[nodiscard]] BasicCellCost<S> cell_cost(const BasicCellShares<S>& shares, const BasicCellSpeed<S>& law) {
  constexpr S none = std::numeric_limits<S>::infinity();
  const auto places = detail::places(shares.shape);
  BasicCellCost<S> cost;
  S room = S(1);   // the product of what is left of all limits
  S least = S(1);  // of what is left of one
  for (std::size_t i = 0; i < 3; ++i) {
    const S b = detail::row(places[i].b, law);
    if (!(b > S(0))) return {none, none};
    const S slope = detail::row(places[i].slope, law), bend = detail::row(places[i].bend, law);
    const auto take = [&](S share) {
      room *= S(1) - share;
      least = std::min(least, S(1) - share);
    };
    take(b * shares.speeds[i].speed_sq);
    for (const BasicForceShare<S>& force : shares.forces_at(i)) {
      take(force.acceleration(b, slope));
      take(force.jerk(b, slope, bend));
    }
    cost.time += (i == 1 ? S(4) : S(1)) * shares.shape.length / (S(6) * std::sqrt(b));
    if (!(least > S(0))) return {none, none};
    if (room < S(1e-30)) {
      if (!(room > S(0))) return {none, none};
      cost.barrier -= std::log(room);
      room = S(1);
    }
  }
  cost.barrier -= std::log(room);
  return cost;
}

/// Gradient of time + weight * barrier, and the Hessian of the time and of the shares at their prices. The
/// prices are kept near to what the barrier makes them, weight / (1 - share), by a factor `spread`: 1 gives
/// the Hessian of the barrier itself. All terms are convex but the jerk's: with u = b |y|^2 / J^2 and y =
/// q''' b + 3/2 q'' b' + q' b''/2, linear in (b, b', b''), the Hessian of u is positive but for -2 u / b^2 in
/// its first entry, which is taken off what the time has there, as far as that goes.
template <std::floating_point S>
[[nodiscard]] BasicCellModel<S> cell_model(const BasicCellShares<S>& shares, const BasicCellSpeed<S>& law,
                                           S weight, S spread) {
  const auto places = detail::places(shares.shape);
  BasicCellModel<S> model;
  const auto settle = [&](S& price, S pressure) {
    price = std::clamp(price, pressure / spread, pressure * spread);
    return price;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const detail::Place<S>& place = places[i];
    const S b = detail::row(place.b, law), slope = detail::row(place.slope, law),
            bend = detail::row(place.bend, law);
    // By b, b' and b''.
    std::array<S, 3> g{};
    std::array<S, 6> H{};
    const S w = (i == 1 ? S(4) : S(1)) * shares.shape.length / S(6), root = S(1) / std::sqrt(b);
    g[0] = -w * root / (S(2) * b);
    S own = S(0.75) * w * root / (b * b);
    const S cap = shares.speeds[i].speed_sq, left = S(1) / (S(1) - b * cap);
    g[0] += weight * left * cap;
    H[0] += settle(shares.speeds[i].price, weight * left) * left * cap * cap;
    for (BasicForceShare<S>& force : shares.forces_at(i)) {
      if (const S k = force.acceleration_sq; k > S(0)) {
        const S f = S(1) / (S(1) - force.acceleration(b, slope));
        const auto [x, y] = force.by_acceleration(b, slope);
        const S pressure = weight * f, price = settle(force.acceleration_price, pressure);
        g[0] += pressure * x;
        g[1] += pressure * y;
        H[0] += price * (f * x * x + k * S(2) * force.p[3]);
        H[1] += price * (f * x * y + k * force.p[1]);
        H[3] += price * (f * y * y + k * force.p[0] / S(2));
      }
      if (const S k = force.jerk_sq; k > S(0)) {
        const auto& p = force.p;
        const auto y = force.pull(b, slope, bend);
        const S square = y[0] * b + y[1] * slope + y[2] * bend, two = S(2) * k;
        const S f = S(1) / (S(1) - k * b * square);
        const S pressure = weight * f, price = settle(force.jerk_price, pressure), pf = price * f;
        const std::array<S, 3> d{k * (square + S(2) * b * y[0]), two * b * y[1], two * b * y[2]};
        for (std::size_t q = 0; q < 3; ++q) g[q] += pressure * d[q];
        const S bent = price * two;
        own -= bent * square / b;
        H[0] += pf * d[0] * d[0] + bent * (b * p[5] + S(2) * y[0] + square / b);
        H[1] += pf * d[0] * d[1] + bent * (S(1.5) * b * p[4] + y[1]);
        H[2] += pf * d[0] * d[2] + bent * (S(0.5) * b * p[2] + y[2]);
        H[3] += pf * d[1] * d[1] + bent * S(2.25) * b * p[3];
        H[4] += pf * d[1] * d[2] + bent * S(0.75) * b * p[1];
        H[5] += pf * d[2] * d[2] + bent * S(0.25) * b * p[0];
      }
    }
    H[0] += std::max(own, S(0));
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

/// Moves the prices by a part of the Newton step that belongs to a step of the law: to where price (1 -
/// share) is the weight, to first order.
template <std::floating_point S>
void move_prices(const BasicCellShares<S>& shares, const BasicCellSpeed<S>& law,
                 const BasicCellSpeed<S>& step, S weight, S part) {
  const auto places = detail::places(shares.shape);
  const auto move = [&](S& price, S left, S rise) {
    price += part * ((weight + price * rise) / left - price);
  };
  for (std::size_t i = 0; i < 3; ++i) {
    const S b = detail::row(places[i].b, law), slope = detail::row(places[i].slope, law),
            bend = detail::row(places[i].bend, law);
    const S db = detail::row(places[i].b, step), dslope = detail::row(places[i].slope, step),
            dbend = detail::row(places[i].bend, step);
    const S cap = shares.speeds[i].speed_sq;
    move(shares.speeds[i].price, S(1) - b * cap, db * cap);
    for (BasicForceShare<S>& force : shares.forces_at(i)) {
      const auto [x, y] = force.by_acceleration(b, slope);
      move(force.acceleration_price, S(1) - force.acceleration(b, slope), x * db + y * dslope);
      const auto pull = force.pull(b, slope, bend);
      const S square = pull[0] * b + pull[1] * slope + pull[2] * bend, k = force.jerk_sq;
      move(force.jerk_price, S(1) - k * b * square,
           k * (square * db + S(2) * b * (pull[0] * db + pull[1] * dslope + pull[2] * dbend)));
    }
  }
}

}  // namespace cncplan::smooth
