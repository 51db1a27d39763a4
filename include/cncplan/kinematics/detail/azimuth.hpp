// The angle about the table's axis, without a jump.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>
#include <numbers>

#include "cncplan/core/jet.hpp"

namespace cncplan::kinematics {

/// The angle that differs from `angle` by whole turns and lies nearest to `reference`, rad.
template <std::floating_point S>
[[nodiscard]] S near_turn(S angle, S reference) {
  constexpr S turn = S(2) * std::numbers::pi_v<S>;
  return angle + turn * std::round((reference - angle) / turn);
}

/// The whole turns, rad, that bring angles from `low` to `high` into a travel that may have no ends: as few
/// as will do. Where no number of turns does, those after which they leave it least.
template <std::floating_point S>
[[nodiscard]] S turns_into(S low, S high, S travel_low, S travel_high) {
  constexpr S turn = S(2) * std::numbers::pi_v<S>;
  constexpr S rounding = S(64) * std::numeric_limits<S>::epsilon();
  const S fewest = std::ceil((travel_low - low) / turn - rounding);
  const S most = std::floor((travel_high - high) / turn + rounding);
  if (fewest <= most) return turn * std::clamp(S(0), fewest, most);
  return turn * std::round(((travel_low - low) + (travel_high - high)) / (S(2) * turn));
}

/// Angles measured from a direction of one's choice: smooth all round but for the opposite direction, and
/// whole turns count. What keeps a rotary table from unwinding where atan2 jumps.
template <std::floating_point S>
class BasicAzimuth {
 public:
  BasicAzimuth() = default;

  /// Round the direction of (x, y), which is not the origin; its own angle is the one nearest to `reference`.
  BasicAzimuth(S x, S y, S reference)
      : cosine_(x / std::hypot(x, y)),
        sine_(y / std::hypot(x, y)),
        angle_(near_turn(std::atan2(y, x), reference)) {}

  /// Of the direction itself.
  [[nodiscard]] S angle() const { return angle_; }

  /// Of a point, number or jet, that is not the origin.
  template <NumberOver<S> T>
  [[nodiscard]] T of(const T& x, const T& y) const {
    using std::atan2;
    return T(angle_) + atan2(T(cosine_) * y - T(sine_) * x, T(cosine_) * x + T(sine_) * y);
  }

  friend bool operator==(const BasicAzimuth&, const BasicAzimuth&) = default;

 private:
  S cosine_ = S(1);
  S sine_{};
  S angle_{};
};

using Azimuth = BasicAzimuth<double>;

}  // namespace cncplan::kinematics
