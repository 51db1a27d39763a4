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

  /// The u at which turning_phase(u) = n pi. Newton's method on a function whose slope lies between 1 and 2:
  /// five steps at most seen, as above.
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
  [[nodiscard]] S next_reversal_number(S u) const {
    const S turns = turning_phase(u) / std::numbers::pi_v<S>;
    return std::floor(turns + rounding(turns)) + S(1);
  }

  /// Number of the last turning before u.
  [[nodiscard]] S previous_reversal_number(S u) const {
    const S turns = turning_phase(u) / std::numbers::pi_v<S>;
    return std::ceil(turns - rounding(turns)) - S(1);
  }

  /// The u in [low, high] with x(u) = wanted, for a piece without a reversal inside.
  [[nodiscard]] S crossing(S wanted, S low, S high) const {
    const S middle = (low + high) / 2;
    const S turns = std::floor(turning_phase(middle) / std::numbers::pi_v<S>);
    const S sense = turns == 2 * std::floor(turns / 2) ? S(-1) : S(1);
    if (growth == S(0)) return std::clamp(circle_crossing(wanted - start, middle, sense), low, high);
    return spiral_crossing(wanted, low, high, sense);
  }

 private:
  [[nodiscard]] static S rounding(S turns) {
    return 8 * std::numeric_limits<S>::epsilon() * (S(1) + std::abs(turns));
  }

  /// The solution on the circle within half a turn of `middle` whose velocity v has the sign `sense`. With
  /// delta the way from the start, v^2 = tangential^2 - delta (delta + 2 radial) and tan(u/2) = delta /
  /// (tangential + v) = (tangential - v) / (delta + 2 radial), whichever does not cancel.
  [[nodiscard]] S circle_crossing(S delta, S middle, S sense) const {
    const S v = sense * std::sqrt(std::max(S(0), tangential * tangential - delta * (delta + 2 * radial)));
    const S half = tangential * v > std::min(S(0), radial * (radial + delta))
                       ? std::atan(delta / (tangential + v))
                       : std::atan((tangential - v) / (delta + 2 * radial));
    constexpr S turn = 2 * std::numbers::pi_v<S>;
    return 2 * half + turn * std::round((middle - 2 * half) / turn);
  }

  /// From the circle through the piece's middle, steps to the root of the parabola that agrees in value and
  /// two derivatives, within a bracket that shrinks: reversals, where Newton's method crawls, are no harder
  /// than the rest. A step leaves an error of third order in x, hence the end at |step|^3 < rounding: seven
  /// steps at most in 5e6 random crossings of spirals with radius ratios to 1e3, one to three where the ratio
  /// is 1 +- 1e-3.
  [[nodiscard]] S spiral_crossing(S wanted, S low, S high, S sense) const {
    constexpr int crossing_steps = 16;
    const S middle = (low + high) / 2;
    const S delta = (wanted - start - growth * middle * radial) / (S(1) + growth * middle);
    // The radius at the crossing, not at the middle, to first order; damped towards reversals, where v = 0.
    const S u_circle = circle_crossing(delta, middle, sense);
    const S q = radial + delta;
    const S v_sq = std::max(S(0), tangential * tangential - delta * (delta + 2 * radial));
    const S lag =
        growth * (u_circle - middle) * sense * std::sqrt(v_sq) * q / (v_sq + std::abs(growth) * q * q);
    S u = std::clamp(u_circle - lag, low, high);
    for (int i = 0; i < crossing_steps; ++i) {
      const S s = std::sin(u / 2);
      const S c = std::cos(u / 2);
      const S rho = S(1) + growth * u;
      const S turned = 2 * s * (c * tangential - s * radial);
      const S across = radial + turned;
      const S along = tangential - 2 * s * (s * tangential + c * radial);
      const S excess = (start - wanted) + turned + growth * u * across;
      if (std::abs(excess) <= std::numeric_limits<S>::epsilon() * (std::abs(wanted) + rho * std::abs(radial)))
        break;
      (sense * excess > S(0) ? high : low) = u;
      const S first = growth * across + rho * along;
      const S second = 2 * growth * along - rho * across;
      const S root = std::sqrt(std::max(S(0), first * first - 2 * excess * second));
      const S next = std::clamp(u - 2 * excess / (first + sense * root), low, high);
      const S step = next - u;
      u = next;
      if (std::abs(step * step * step) <= std::numeric_limits<S>::epsilon()) break;
    }
    return u;
  }
};

}  // namespace cncplan::path
