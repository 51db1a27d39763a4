// One in-plane coordinate along an arc: its value, where it turns round, where it takes a given value.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <numbers>

namespace cncplan::path {

/// x(u) = start + radial (rho cos u - 1) + tangential rho sin u, rho = 1 + growth u, for the angle u
/// travelled. `radial` is start minus centre in this axis and `tangential` the velocity dx/du of the circle
/// at u = 0, so that radial = r cos(phase), tangential = -r sin(phase) and x = centre + r rho cos(u + phase).
/// Everything is measured from the start, not from the centre: a flat arc of huge radius loses no digits.
template <std::floating_point S>
struct ArcAxis {
  S start;
  S radial;
  S tangential;
  S growth;  ///< relative to the start radius, per radian
  S phase;   ///< rad

  [[nodiscard]] S value(S u) const {
    const S s = std::sin(u / 2);
    const S c = std::cos(u / 2);
    const S turned = 2 * s * (c * tangential - s * radial);
    return start + turned + growth * u * (radial + turned);
  }

  [[nodiscard]] S rate(S u) const {
    const S s = std::sin(u);
    const S c = std::cos(u);
    return growth * (radial * c + tangential * s) + (S(1) + growth * u) * (tangential * c - radial * s);
  }

  /// Grows strictly with u; the axis turns round where it passes a multiple of pi (there tan(u + phase) =
  /// growth/rho).
  [[nodiscard]] S turning_phase(S u) const {
    return u + phase - (growth == S(0) ? S(0) : std::atan2(growth, S(1) + growth * u));
  }

  /// The u at which turning_phase(u) = n pi. Newton's method on a function whose slope lies between 1 and 2.
  [[nodiscard]] S turning(S n) const {
    constexpr int newton_steps = 8;
    const S target = n * std::numbers::pi_v<S>;
    S u = target - phase;
    if (growth == S(0)) return u;
    for (int i = 0; i < newton_steps; ++i) {
      const S rho = S(1) + growth * u;
      const S slope = S(1) + growth * growth / (rho * rho + growth * growth);
      const S step = (target - turning_phase(u)) / slope;
      u += step;
      if (step * step * std::abs(growth) <= std::numeric_limits<S>::epsilon()) break;
    }
    return u;
  }

  /// Number of the first turning after u; one within rounding of u counts as u itself.
  [[nodiscard]] S next_turning_number(S u) const {
    const S turns = turning_phase(u) / std::numbers::pi_v<S>;
    return std::floor(turns + rounding(turns)) + S(1);
  }

  /// Number of the last turning before u.
  [[nodiscard]] S previous_turning_number(S u) const {
    const S turns = turning_phase(u) / std::numbers::pi_v<S>;
    return std::ceil(turns - rounding(turns)) - S(1);
  }

  /// The u in [low, high] with x(u) = wanted, for a piece without a turning inside.
  /// Circle: with delta = wanted - start and v the axis velocity at the crossing, v^2 = tangential^2 - delta
  /// (delta + 2 radial) and tan(u/2) = delta / (tangential + v) = (tangential - v) / (delta + 2 radial);
  /// whichever does not cancel. Spiral: the circle through the piece's middle, then Newton's method kept
  /// inside its bracket.
  [[nodiscard]] S crossing(S wanted, S low, S high) const {
    const S middle = (low + high) / 2;
    const S sense =
        std::fmod(std::floor(turning_phase(middle) / std::numbers::pi_v<S>), S(2)) == S(0) ? S(-1) : S(1);
    if (growth == S(0)) return std::clamp(circle_crossing(wanted - start, middle, sense), low, high);
    const S rho = S(1) + growth * middle;
    const S delta = (wanted - start - growth * middle * radial) / rho;
    S u = std::clamp(circle_crossing(delta, middle, sense), low, high);
    // Ends when a step is below rounding; halving alone needs the digits of S plus a few.
    for (int i = 0; i < std::numeric_limits<S>::digits + 8; ++i) {
      const S excess = sense * (value(u) - wanted);
      (excess > S(0) ? high : low) = u;
      S next = u - excess / (sense * rate(u));
      if (!(next >= low && next <= high)) next = (low + high) / 2;
      const S step = std::abs(next - u);
      u = next;
      if (step <= std::numeric_limits<S>::epsilon() * std::max(S(1), u)) break;
    }
    return u;
  }

 private:
  [[nodiscard]] static S rounding(S turns) {
    return 8 * std::numeric_limits<S>::epsilon() * (S(1) + std::abs(turns));
  }

  /// The solution within half a turn of `middle` whose velocity has the sign `sense`.
  [[nodiscard]] S circle_crossing(S delta, S middle, S sense) const {
    const S v = sense * std::sqrt(std::max(S(0), tangential * tangential - delta * (delta + 2 * radial)));
    const S half = tangential * v > std::min(S(0), radial * (radial + delta))
                       ? std::atan(delta / (tangential + v))
                       : std::atan((tangential - v) / (delta + 2 * radial));
    constexpr S turn = 2 * std::numbers::pi_v<S>;
    return 2 * half + turn * std::round((middle - 2 * half) / turn);
  }
};

}  // namespace cncplan::path
