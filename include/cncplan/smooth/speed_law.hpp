// The square of a speed over length, a quadratic B-spline, and the motion that it means.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <span>

#include "cncplan/core/compiler.hpp"
#include "cncplan/core/phase.hpp"

namespace cncplan::smooth {

/// b(s) = v^2 within one cell, mm^2/s^2, by its Bezier coefficients. Along the path the acceleration is b'/2
/// and the jerk sqrt(b) b''/2.
template <std::floating_point S>
struct BasicCellSpeed {
  S start{};
  S middle{};
  S end{};

  [[nodiscard]] constexpr S at(S share) const {
    const S other = S(1) - share;
    return other * other * start + S(2) * share * other * middle + share * share * end;
  }
  /// The acceleration at a place of a cell of this length.
  [[nodiscard]] constexpr S acceleration(S share, S length) const {
    return ((S(1) - share) * (middle - start) + share * (end - middle)) / length;
  }
};

/// b at the knot between two cells, between the coefficients of the one and the other.
template <std::floating_point S>
[[nodiscard]] constexpr S at_knot(S before, S after, S length_before, S length_after) {
  return (length_after * before + length_before * after) / (length_before + length_after);
}

/// b over the cells of a path: one coefficient for each cell, its middle one, and one more at each end, the
/// values of b there. b and b' are continuous, so speed and acceleration are.
template <std::floating_point S>
[[nodiscard]] constexpr BasicCellSpeed<S> cell_speed(std::span<const S> law, std::size_t cell,
                                                     S length_before, S length, S length_after) {
  return {at_knot(law[cell], law[cell + 1], length_before, length), law[cell + 1],
          at_knot(law[cell + 1], law[cell + 2], length, length_after)};
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
void emit_cell(const BasicCellSpeed<S>& b, S length, Emit&& emit) {
  constexpr S change = S(0.1);
  constexpr int most = 8;
  const S v0 = std::sqrt(b.start), v1 = std::sqrt(b.end);
  if (b.start == b.end && b.middle == b.start) {
    emit(BasicPhase<S>{S(0), length / v0, S(0), v0, S(0), S(0)});
    return;
  }
  const S between = std::sqrt(b.at(S(0.5)));
  const S low = std::min({v0, v1, between}), high = std::max({v0, v1, between});
  const S wanted = std::ceil((high - low) / (change * low));
  const int parts = wanted < static_cast<S>(most) ? std::max(static_cast<int>(wanted), 1) : most;
  const S part_length = length / static_cast<S>(parts);
  S time = S(0), speed = v0, acceleration = b.acceleration(S(0), length);
  for (int part = 1; part <= parts; ++part) {
    const S share = static_cast<S>(part) / static_cast<S>(parts);
    const S next_speed = part == parts ? v1 : std::sqrt(b.at(share)), next = b.acceleration(share, length);
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

/// From rest at constant jerk: after a length x the speed is (4.5 J x^2)^(1/3) and the acceleration
/// sqrt(2 J v), so b grows with x^(4/3), which no polynomial does.
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

  [[nodiscard]] S duration() const { return acceleration / jerk; }
};

}  // namespace cncplan::smooth
