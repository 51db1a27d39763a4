// A path of axes at one length, and the motion of the axes there.
#pragma once

#include <cmath>

#include "cncplan/core/curve_point.hpp"
#include "cncplan/core/state.hpp"
#include "cncplan/core/vector.hpp"

namespace cncplan {

/// Position of each axis and its derivatives by the length that the feed counts, q, q', q'' and q'''. Units:
/// mm (rad of a rotary axis), and these per mm, mm^2, mm^3. None of them needs to be a unit vector.
template <class V>
struct PathPoint {
  V position = V::Zero();
  V first = V::Zero();
  V second = V::Zero();
  V third = V::Zero();
};

/// What the axes do at one instant: mm or rad, and these per s, s^2, s^3.
template <class V>
struct AxisMotion {
  V position;
  V velocity;
  V acceleration;
  V jerk;
};

/// The axes' motion where the motion along the path has velocity v, acceleration a and jerk j:
///
///     q' v,     q'' v^2 + q' a,     q''' v^3 + 3 q'' v a + q' j
template <class V>
[[nodiscard]] AxisMotion<V> motion(const PathPoint<V>& at, const BasicState<typename V::Scalar>& along) {
  const auto [s, v, a, j] = along;
  return {at.position, at.first * v, at.second * (v * v) + at.first * a,
          at.third * (v * v * v) + at.second * (3 * v * a) + at.first * j};
}

/// A curve over any parameter, given with its third derivative by that, as a path by its own length.
template <class V>
[[nodiscard]] PathPoint<V> by_length(const CurvePoint<V>& at, const V& third) {
  using S = typename V::Scalar;
  const S speed_sq = at.first.squaredNorm();
  if (!(speed_sq > S(0))) return {at.position, V::Zero(), V::Zero(), V::Zero()};
  const S speed = std::sqrt(speed_sq);
  // Derivatives of the speed by the parameter, then of the parameter by the length.
  const S slope = at.first.dot(at.second) / speed;
  const S bend = (at.second.squaredNorm() + at.first.dot(third) - slope * slope) / speed;
  const S u1 = S(1) / speed;
  const S u2 = -slope * u1 * u1 * u1;
  const S u3 = (S(3) * slope * slope * u1 - bend) * u1 * u1 * u1 * u1;
  return {at.position, at.first * u1, at.second * (u1 * u1) + at.first * u2,
          third * (u1 * u1 * u1) + at.second * (S(3) * u1 * u2) + at.first * u3};
}

}  // namespace cncplan
