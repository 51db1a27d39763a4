// The square of a speed over length, a spline with one coefficient a cell, and the motion that it means.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <span>
#include <utility>

#include "cncplan/core/compiler.hpp"
#include "cncplan/core/phase.hpp"

namespace cncplan::detail {

/// How b'' goes through a cell: it is in the proportion of 1 + skew (2 u - 1) over the share u of the length.
/// At a constant jerk b'' = 2 j / v, so a cell in which the speed goes from v0 to v1 has little less than the
/// whole jerk throughout if its skew is (v0 - v1) / (v0 + v1).
template <std::floating_point S>
struct BasicCellShape {
  S length{};
  S skew{};  ///< in (-1, 1); 0: b'' is constant

  /// To where the tangents of b at both ends meet, from the start.
  [[nodiscard]] constexpr S to_middle() const { return length * (S(0.5) + skew / S(6)); }
  /// From there to the end.
  [[nodiscard]] constexpr S from_middle() const { return length * (S(0.5) - skew / S(6)); }
};

/// The skew of a cell in which the speed goes from one to another at a constant jerk.
template <std::floating_point S>
[[nodiscard]] constexpr S skew_between(S before, S after) {
  return std::clamp((before - after) / (before + after), S(-0.5), S(0.5));
}

/// A speed at a length, between places with speeds in order; `place` goes on from call to call with lengths
/// that grow.
template <std::floating_point S>
[[nodiscard]] S speed_between(std::span<const std::pair<S, S>> places, std::size_t& place, S at) {
  while (place + 2 < places.size() && places[place + 1].first < at) ++place;
  const auto [from, slow] = places[place];
  const auto [to, fast] = places[std::min(place + 1, places.size() - 1)];
  return to > from ? slow + std::clamp((at - from) / (to - from), S(0), S(1)) * (fast - slow) : slow;
}

/// b(s) = v^2 within one cell, mm^2/s^2, by its values at both ends and where the tangents there meet. Along
/// the path the acceleration is b'/2 and the jerk sqrt(b) b''/2.
template <std::floating_point S>
struct BasicCellSpeed {
  S start{};
  S middle{};
  S end{};

  /// b at a share of the length.
  [[nodiscard]] constexpr S at(S share, const BasicCellShape<S>& shape) const {
    const auto [first, bend] = derivatives(shape);
    const S x = share * shape.length;
    return start + x * (first + x * bend * (S(0.5) - shape.skew * (S(0.5) - share / S(3))));
  }
  /// No b in the cell is above this: b'' has one sign, so b lies below its chord or below both tangents.
  [[nodiscard]] constexpr S bound() const { return std::max({start, middle, end}); }
  [[nodiscard]] constexpr S acceleration(S share, const BasicCellShape<S>& shape) const {
    const auto [first, bend] = derivatives(shape);
    return (first + share * shape.length * bend * (S(1) - shape.skew * (S(1) - share))) / S(2);
  }

 private:
  // b' at the start and the mean of b''.
  [[nodiscard]] constexpr std::array<S, 2> derivatives(const BasicCellShape<S>& shape) const {
    const S first = (middle - start) / shape.to_middle(), last = (end - middle) / shape.from_middle();
    return {first, (last - first) / shape.length};
  }
};

/// b at the knot between two cells, between the coefficients of the one and the other, which stand at these
/// distances from it.
template <std::floating_point S>
[[nodiscard]] constexpr S at_knot(S before, S after, S distance_before, S distance_after) {
  return (distance_after * before + distance_before * after) / (distance_before + distance_after);
}

/// b over the cells of a path: one coefficient for each cell, its middle one, and one more at each end, the
/// values of b there. b and b' are continuous, so speed and acceleration are. Beyond the ends there is no
/// length.
template <std::floating_point S>
[[nodiscard]] constexpr BasicCellSpeed<S> cell_speed(std::span<const S> law, std::size_t cell,
                                                     const BasicCellShape<S>& before,
                                                     const BasicCellShape<S>& shape,
                                                     const BasicCellShape<S>& after) {
  return {at_knot(law[cell], law[cell + 1], before.from_middle(), shape.to_middle()), law[cell + 1],
          at_knot(law[cell + 1], law[cell + 2], shape.from_middle(), after.to_middle())};
}

/// Two phases of equal duration and constant jerk from one speed and acceleration to another, over a length:
///
///     T (v0 + v1) / 2 - T^2 (a1 - a0) / 12 = length
///
/// and the jerks (P - Q) / 2 and (3 Q - P) / 2 with P = 8 (v1 - v0 - a0 T) / T^2, Q = 2 (a1 - a0) / T. Both
/// ends are met exactly, wherever they come from. The phases count time and length from the first one's
/// start.
template <std::floating_point S>
[[nodiscard]] std::array<BasicPhase<S>, 2> phases_between(S length, S speed0, S acceleration0, S speed1,
                                                          S acceleration1) {
  const S mean = (speed0 + speed1) / S(2), rise = acceleration1 - acceleration0;
  const S T = S(2) * length / (mean + std::sqrt(std::max(mean * mean - rise * length / S(3), S(0))));
  const S half = T / S(2);
  const S P = S(8) * (speed1 - speed0 - acceleration0 * T) / (T * T), Q = S(2) * rise / T;
  BasicPhase<S> first{S(0), half, S(0), speed0, acceleration0, (P - Q) / S(2)};
  const BasicState<S> between = first.at(half);
  return {first,
          {half, half, between.position, between.velocity, between.acceleration, (S(3) * Q - P) / S(2)}};
}

/// Calls `emit(phase)` for the phases that drive a law of speed through a cell; time and position count from
/// the cell's start. Where the speed changes much the cell is cut, so that their jerk is close to the law's.
template <std::floating_point S, class Emit>
void emit_cell(const BasicCellSpeed<S>& b, const BasicCellShape<S>& shape, Emit&& emit) {
  const S length = shape.length;
  constexpr S change = S(0.1);
  constexpr int most = 8;
  const S v0 = std::sqrt(b.start), v1 = std::sqrt(b.end);
  if (b.start == b.end && b.middle == b.start) {
    emit(BasicPhase<S>{S(0), length / v0, S(0), v0, S(0), S(0)});
    return;
  }
  const S between = std::sqrt(b.at(S(0.5), shape));
  const S low = std::min({v0, v1, between}), high = std::max({v0, v1, between});
  const S wanted = std::ceil((high - low) / (change * low));
  const int parts = wanted < static_cast<S>(most) ? std::max(static_cast<int>(wanted), 1) : most;
  const S part_length = length / static_cast<S>(parts);
  S time = S(0), speed = v0, acceleration = b.acceleration(S(0), shape);
  for (int part = 1; part <= parts; ++part) {
    const S share = static_cast<S>(part) / static_cast<S>(parts);
    const S next_speed = part == parts ? v1 : std::sqrt(b.at(share, shape)),
            next = b.acceleration(share, shape);
    for (BasicPhase<S> phase : phases_between(part_length, speed, acceleration, next_speed, next)) {
      phase.position += part_length * static_cast<S>(part - 1);
      phase.time = time;
      time += phase.duration;
      emit(phase);
    }
    speed = next_speed;
    acceleration = next;
  }
}

/// How motion begins, or backwards in time ends: from rest at constant jerk, after a length x the speed is
/// (4.5 J x^2)^(1/3) and the acceleration sqrt(2 J v), so b grows with x^(4/3), which no polynomial does. Or
/// at a constant speed, without a length.
template <std::floating_point S>
struct BasicRestCell {
  S jerk{};
  S speed{};
  S acceleration{};

  BasicRestCell() = default;
  BasicRestCell(S length, S constant_jerk)
      : jerk(constant_jerk),
        speed(std::cbrt(S(4.5) * jerk * length * length)),
        acceleration(std::sqrt(S(2) * jerk * speed)) {}
  [[nodiscard]] static BasicRestCell at_speed(S speed) {
    BasicRestCell moving;
    moving.speed = speed;
    return moving;
  }

  [[nodiscard]] bool from_rest() const { return jerk > S(0); }
  [[nodiscard]] S duration() const { return from_rest() ? acceleration / jerk : S(0); }
};

}  // namespace cncplan::detail
