// A piece of a mold's profile: a line or an arc of the (R, Z) half-plane, by its length.
#pragma once

#include <cmath>
#include <concepts>
#include <numbers>

#include "cncplan/core/jet.hpp"
#include "cncplan/core/vector.hpp"

namespace cncplan::kinematics {

template <std::floating_point S>
using BasicVector2 = VectorN<S, 2>;
using Vector2 = BasicVector2<double>;

/// A pair of numbers or jets in the half-plane: R, Z.
template <class T>
struct InPlane {
  T r;
  T z;
};

/// The side of a profile, seen in its direction, that a tool stands on.
enum class Side { left, right };

/// Begins at `start` in the direction `heading` and turns evenly by `turning` rad/mm: a line where that is
/// zero, an arc otherwise. The normal is the tangent turned by 90 degrees to the tool's side, so along a
/// chain it stays on one side (K17 Eqs. 3.7-3.33, whose lines have it on the right). A kink is a piece too:
/// its radius and length are zero, and only the normal turns.
template <std::floating_point S>
struct BasicProfilePiece {
  BasicVector2<S> start = BasicVector2<S>::Zero();
  S heading{};  ///< rad, of the tangent at the start
  S turning{};  ///< rad/mm, > 0 counter-clockwise
  S radius{};   ///< mm, signed as `turning`; 0 for a line and for a kink
  S length{};   ///< mm
  S from{};     ///< mm of the chain before it
  Side side = Side::right;

  [[nodiscard]] bool is_kink() const { return turning != S(0) && radius == S(0); }
  [[nodiscard]] S end_heading() const { return heading + turning * length; }
  [[nodiscard]] BasicVector2<S> end() const {
    const auto [r, z] = point(length);
    return {r, z};
  }

  /// The point after q mm.
  template <NumberOver<S> T>
  [[nodiscard]] InPlane<T> point(const T& q) const {
    if (turning == S(0))
      return {T(start.x()) + q * T(std::cos(heading)), T(start.y()) + q * T(std::sin(heading))};
    using std::cos, std::sin;
    const T angle = T(heading) + q * T(turning);
    return {T(start.x() - radius * std::sin(heading)) + T(radius) * sin(angle),
            T(start.y() + radius * std::cos(heading)) - T(radius) * cos(angle)};
  }

  /// The outward normal after q mm, unit length.
  template <NumberOver<S> T>
  [[nodiscard]] InPlane<T> normal(const T& q) const {
    using std::cos, std::sin;
    const T angle = T(heading) + q * T(turning);
    if (side == Side::left) return {-sin(angle), cos(angle)};
    return {sin(angle), -cos(angle)};
  }

  /// Tilt of a tool along the normal after q mm: the normal is (-sin tilt, cos tilt). In [-pi, pi] at the
  /// start, and from there without a jump.
  template <NumberOver<S> T>
  [[nodiscard]] T tilt(const T& q) const {
    const S upwards = side == Side::left ? S(0) : std::numbers::pi_v<S>;  // the heading whose normal is up
    return T(std::remainder(heading - upwards, S(2) * std::numbers::pi_v<S>)) + q * T(turning);
  }

  friend bool operator==(const BasicProfilePiece&, const BasicProfilePiece&) = default;
};

using ProfilePiece = BasicProfilePiece<double>;

/// How far the normal jumps from the end of one piece to the start of the next, rad in [-pi, pi].
template <std::floating_point S>
[[nodiscard]] S kink_angle(const BasicProfilePiece<S>& before, const BasicProfilePiece<S>& after) {
  return std::remainder(after.heading - before.end_heading(), S(2) * std::numbers::pi_v<S>);
}

/// The kink between two pieces as a piece of its own: 1 rad of turning for each mm of its parameter, which
/// goes to |kink_angle|.
template <std::floating_point S>
[[nodiscard]] BasicProfilePiece<S> kink(const BasicProfilePiece<S>& before,
                                        const BasicProfilePiece<S>& after) {
  return {after.start, before.end_heading(), std::copysign(S(1), kink_angle(before, after)), S(0), S(0),
          after.from,  before.side};
}

}  // namespace cncplan::kinematics
