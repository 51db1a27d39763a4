// Time and nearness to the limits of a law of speed, cell by cell, with first and second derivatives.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <span>

#include "cncplan/detail/speed/motion_bounds.hpp"
#include "cncplan/detail/speed/speed_law.hpp"

namespace cncplan::detail {

/// A function of the three coefficients of speed that a cell hangs on: gradient, and a Hessian that is never
/// indefinite, in the order 00 01 02 11 12 22.
template <std::floating_point S>
struct BasicCellModel {
  std::array<S, 3> gradient{};
  std::array<S, 6> hessian{};
};

/// b, b' and b'' at a place of a cell from the three coefficients of speed that the cell hangs on: rows of
/// numbers.
template <std::floating_point S>
struct BasicLawPlace {
  std::array<S, 3> b{}, slope{}, bend{};
  S time{};  ///< its weight in Simpson's rule, mm

  [[nodiscard]] static constexpr S row(const std::array<S, 3>& numbers, const S* law) {
    return numbers[0] * law[0] + numbers[1] * law[1] + numbers[2] * law[2];
  }
};

/// What the time gains by a higher limit, the multiplier of an interior-point method; and its share as
/// `cell_model` found it last.
template <std::floating_point S>
struct BasicMultiplier {
  S multiplier{};
  S inverse_room = 1;     ///< 1 / (1 - share)
  std::array<S, 3> by{};  ///< the derivatives of the share by b, b' and b''

  /// Moves the multiplier by a part of its Newton step, where b, b' and b'' make these steps: to where
  /// multiplier (1 - share) is the weight, to first order.
  constexpr void move(const std::array<S, 3>& step, S weight, S part) {
    const S rise = by[0] * step[0] + by[1] * step[1] + by[2] * step[2];
    multiplier += part * ((weight + multiplier * rise) * inverse_room - multiplier);
  }
};

/// One limit of acceleration and jerk at one place of a path: squares as shares of the limits' squares, each
/// to stay below 1, by b, b' and b'' there.
template <std::floating_point S>
struct BasicForceShare {
  std::array<S, 6> p{};  ///< products of q', q'', q'''
  S acceleration_sq{};   ///< reciprocal square of the limit; 0: none
  S jerk_sq{};           ///< the same of jerk
  BasicMultiplier<S> of_acceleration{};
  BasicMultiplier<S> of_jerk{};

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

/// The limit of b at one place: its reciprocal, and its multiplier.
template <std::floating_point S>
struct BasicSpeedShare {
  BasicLawPlace<S> place{};
  S speed_sq{};
  BasicMultiplier<S> of_speed{};
};

/// The limits of a cell at its start, its middle and its end: three of the speed, and all others of one place
/// after those of the other.
template <std::floating_point S>
struct BasicCellShares {
  std::span<BasicSpeedShare<S>> speeds;
  std::span<BasicForceShare<S>> forces;

  [[nodiscard]] std::span<BasicForceShare<S>> forces_at(std::size_t place) const {
    return forces.subspan(place * (forces.size() / 3), forces.size() / 3);
  }
};

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

/// Start, middle and end of a cell, between others.
template <std::floating_point S>
[[nodiscard]] constexpr std::array<BasicLawPlace<S>, 3> law_places(const BasicCellShape<S>& before,
                                                                   const BasicCellShape<S>& shape,
                                                                   const BasicCellShape<S>& after) {
  const S a = before.from_middle() / (before.from_middle() + shape.to_middle()),
          z = shape.from_middle() / (shape.from_middle() + after.to_middle());
  const auto by_law = [&](const std::array<S, 3>& r) {
    return std::array<S, 3>{(S(1) - a) * r[0], a * r[0] + r[1] + (S(1) - z) * r[2], z * r[2]};
  };
  const auto places = detail::places(shape);
  std::array<BasicLawPlace<S>, 3> result;
  for (std::size_t i = 0; i < 3; ++i)
    result[i] = {by_law(places[i].b), by_law(places[i].slope), by_law(places[i].bend),
                 (i == 1 ? S(4) : S(1)) * shape.length / S(6)};
  return result;
}

/// By how much the limits in a cell are lowered: velocities to one share, accelerations to the square of the
/// other and jerks to its cube, as if the clock ran so much slower.
template <std::floating_point S>
struct BasicLimitScale {
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

/// Writes the limits of a cell, lowered to a scale, and leaves places and multipliers.
template <std::floating_point S, int N>
void set_shares(const BasicSpeedCell<S, N>& cell, const BasicMotionLimits<S, N>& limits,
                const BasicLimitScale<S>& scale, const BasicCellShares<S>& shares) {
  const S acceleration_sq = reciprocal_square(scale.acceleration()),
          jerk_sq = reciprocal_square(scale.jerk());
  for (std::size_t i = 0; i < 3; ++i) {
    const S at = cell.length * static_cast<S>(i) / S(2);
    const auto first = cell.first_at(at), second = cell.second_at(at);
    shares.speeds[i].speed_sq = least_speed_sq(cell, first, limits) / (scale.speed * scale.speed);
    auto force = shares.forces_at(i).begin();
    for_each_limit(limits, [&](const BasicLimits<S>& own, const auto& inner) {
      force->p = products(first, second, cell.third, inner);
      force->acceleration_sq = acceleration_sq * reciprocal_square(own.acceleration);
      force->jerk_sq = jerk_sq * reciprocal_square(own.jerk);
      ++force;
    });
  }
}

/// The use of the limits at the start, the middle and the end of a cell; infinite where b is not positive.
template <std::floating_point S, int N>
[[nodiscard]] BasicUtilisation<S> sampled_utilisation(const BasicSpeedCell<S, N>& cell,
                                                      const BasicMotionLimits<S, N>& limits,
                                                      const BasicCellSpeed<S>& law) {
  constexpr S none = std::numeric_limits<S>::infinity();
  BasicUtilisation<S> utilisation;
  const auto places = detail::places(cell.shape());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const S at = cell.length * static_cast<S>(i) / S(2), b = row(places[i].b, law);
    if (!(b > S(0))) return {none, none, none};
    const auto first = cell.first_at(at), second = cell.second_at(at);
    utilisation.include({std::sqrt(b * least_speed_sq(cell, first, limits)), S(0), S(0)});
    for_each_limit(limits, [&](const BasicLimits<S>& own, const auto& inner) {
      const S slope = row(places[i].slope, law), bend = row(places[i].bend, law);
      const BasicForceShare<S> share{products(first, second, cell.third, inner),
                                     reciprocal_square(own.acceleration), reciprocal_square(own.jerk)};
      utilisation.include({S(0), std::sqrt(std::max(share.acceleration(b, slope), S(0))),
                           std::sqrt(std::max(share.jerk(b, slope, bend), S(0)))});
    });
  }
  return utilisation;
}

/// The sum of -log(1 - share) over shares of limits, with one logarithm for many.
template <std::floating_point S>
class BasicBarrier {
 public:
  constexpr void take(S share) {
    room_ *= S(1) - share;
    least_ = std::min(least_, S(1) - share);
  }
  /// To be called before the product of what is left of limits underflows: after a place, or a sample.
  void settle() {
    if (room_ < S(1e-30)) close();
  }
  /// Whether all shares are below 1.
  [[nodiscard]] constexpr bool kept() const { return least_ > S(0); }
  /// Infinite where a limit is not kept.
  [[nodiscard]] S sum() {
    close();
    return kept() ? sum_ : std::numeric_limits<S>::infinity();
  }

 private:
  void close() {
    sum_ -= std::log(std::max(room_, std::numeric_limits<S>::min()));
    room_ = S(1);
  }

  S room_ = S(1);   // the product of what is left of the limits
  S least_ = S(1);  // of what is left of one
  S sum_{};
};

/// The time through cells (Simpson's rule on 1/sqrt(b)), and the barrier of all limits at the start, the
/// middle and the end of each. Infinite where a limit is not kept.
template <std::floating_point S>
struct BasicLawCost {
  S time{};
  S barrier{};
};

/// Adds the time through a cell with a law of three coefficients, and its limits. False where b is not
/// positive or a limit is not kept.
template <std::floating_point S>
[[nodiscard]] bool add_cost(const BasicCellShares<S>& shares, const S* law, S& time,
                            BasicBarrier<S>& barrier) {
  for (std::size_t i = 0; i < 3; ++i) {
    const BasicLawPlace<S>& place = shares.speeds[i].place;
    const S b = place.row(place.b, law), slope = place.row(place.slope, law),
            bend = place.row(place.bend, law);
    if (!(b > S(0))) return false;
    time += place.time / std::sqrt(b);
    barrier.take(b * shares.speeds[i].speed_sq);
    for (const BasicForceShare<S>& force : shares.forces_at(i)) {
      barrier.take(force.acceleration(b, slope));
      barrier.take(force.jerk(b, slope, bend));
    }
    barrier.settle();
  }
  return barrier.kept();
}

/// Gradient of time + weight * barrier, and the Hessian of the time and of the shares at their
/// multipliers. The multipliers are kept near to what the barrier makes them, weight / (1 - share),
/// by a factor `spread`: 1 gives the Hessian of the barrier itself. All terms are convex but the jerk's: with
/// u = b |y|^2 / J^2 and y = q''' b + 3/2 q'' b' + q' b''/2, linear in (b, b', b''), the Hessian of u is
/// positive but for -2 u / b^2 in its first entry, which is taken off what the time has there, as far as that
/// goes.
template <std::floating_point S>
[[nodiscard]] BasicCellModel<S> cell_model(const BasicCellShares<S>& shares, const S* law, S weight,
                                           S spread) {
  BasicCellModel<S> model;
  const S least = S(1) / spread;
  const auto settle = [&](BasicMultiplier<S>& own, S share, const std::array<S, 3>& by) {
    own.inverse_room = S(1) / (S(1) - share);
    own.by = by;
    const S central = weight * own.inverse_room;
    own.multiplier = std::clamp(own.multiplier, central * least, central * spread);
    return own.multiplier;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    BasicSpeedShare<S>& speed = shares.speeds[i];
    const BasicLawPlace<S>& place = speed.place;
    const S b = place.row(place.b, law), slope = place.row(place.slope, law),
            bend = place.row(place.bend, law);
    // By b, b' and b''.
    std::array<S, 3> g{};
    std::array<S, 6> H{};
    const S inverse = S(1) / b, time = place.time * std::sqrt(inverse);
    g[0] = S(-0.5) * time * inverse;
    S own = S(0.75) * time * inverse * inverse;
    const S cap = speed.speed_sq, of_speed = settle(speed.of_speed, b * cap, {cap, S(0), S(0)});
    g[0] += weight * speed.of_speed.inverse_room * cap;
    H[0] += of_speed * speed.of_speed.inverse_room * cap * cap;
    for (BasicForceShare<S>& force : shares.forces_at(i)) {
      const auto& p = force.p;
      if (const S k = force.acceleration_sq; k > S(0)) {
        const auto [x, y] = force.by_acceleration(b, slope);
        const S multiplier = settle(force.of_acceleration, force.acceleration(b, slope), {x, y, S(0)});
        const S f = force.of_acceleration.inverse_room;
        g[0] += weight * f * x;
        g[1] += weight * f * y;
        H[0] += multiplier * (f * x * x + k * S(2) * p[3]);
        H[1] += multiplier * (f * x * y + k * p[1]);
        H[3] += multiplier * (f * y * y + k * p[0] / S(2));
      }
      if (const S k = force.jerk_sq; k > S(0)) {
        const auto y = force.pull(b, slope, bend);
        const S square = y[0] * b + y[1] * slope + y[2] * bend, two = S(2) * k;
        const std::array<S, 3> d{k * (square + S(2) * b * y[0]), two * b * y[1], two * b * y[2]};
        const S multiplier = settle(force.of_jerk, k * b * square, d), f = force.of_jerk.inverse_room,
                pf = multiplier * f;
        for (std::size_t q = 0; q < 3; ++q) g[q] += weight * f * d[q];
        const S bent = multiplier * two, part = square * inverse;
        own -= bent * part;
        H[0] += pf * d[0] * d[0] + bent * (b * p[5] + S(2) * y[0] + part);
        H[1] += pf * d[0] * d[1] + bent * (S(1.5) * b * p[4] + y[1]);
        H[2] += pf * d[0] * d[2] + bent * (S(0.5) * b * p[2] + y[2]);
        H[3] += pf * d[1] * d[1] + bent * S(2.25) * b * p[3];
        H[4] += pf * d[1] * d[2] + bent * S(0.75) * b * p[1];
        H[5] += pf * d[2] * d[2] + bent * S(0.25) * b * p[0];
      }
    }
    H[0] += std::max(own, S(0));
    // To the coefficients.
    std::size_t entry = 0;
    for (std::size_t q = 0; q < 3; ++q) {
      const S r0 = place.b[q], r1 = place.slope[q], r2 = place.bend[q];
      model.gradient[q] += g[0] * r0 + g[1] * r1 + g[2] * r2;
      const S h0 = H[0] * r0 + H[1] * r1 + H[2] * r2;
      const S h1 = H[1] * r0 + H[3] * r1 + H[4] * r2;
      const S h2 = H[2] * r0 + H[4] * r1 + H[5] * r2;
      for (std::size_t r = q; r < 3; ++r)
        model.hessian[entry++] += h0 * place.b[r] + h1 * place.slope[r] + h2 * place.bend[r];
    }
  }
  return model;
}

/// Moves the multipliers by a part of the Newton step that belongs to a step of the law from where
/// `cell_model` was asked last.
template <std::floating_point S>
void move_multipliers(const BasicCellShares<S>& shares, const S* step, S weight, S part) {
  for (std::size_t i = 0; i < 3; ++i) {
    const BasicLawPlace<S>& place = shares.speeds[i].place;
    const std::array<S, 3> by_place{place.row(place.b, step), place.row(place.slope, step),
                                    place.row(place.bend, step)};
    shares.speeds[i].of_speed.move(by_place, weight, part);
    for (BasicForceShare<S>& force : shares.forces_at(i)) {
      force.of_acceleration.move(by_place, weight, part);
      force.of_jerk.move(by_place, weight, part);
    }
  }
}

}  // namespace cncplan::detail
