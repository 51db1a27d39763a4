// Two arms that hold one tool between them.
#pragma once

#include <array>
#include <cmath>

#include "cncplan/core/jet.hpp"
#include "cncplan/kinematics/scara.hpp"

namespace cncplan::kinematics {

/// Five-bar linkage: two motors, rad, at (-apart / 2, 0) and (apart / 2, 0), with an upper and a fore link
/// each, whose ends meet in the tool; and a slide, mm. Program: X Y Z, mm, y > 0. The elbows stand outwards:
/// each arm's angles are those of an arm of two links. Singular where an arm is stretched (the edge of its
/// reach), and for the inverse where both fore links lie in one line. Source: Campos, Bourbonnais, Bonev,
/// Bigras, 2010, "Development of a five-bar parallel robot with large workspace", ASME DETC2010-28962.
template <std::floating_point S>
struct BasicFiveBar {
  using Scalar = S;
  static constexpr int axis_count = 3;

  S apart = S(120);  ///< mm: between the motors
  S upper = S(150);  ///< mm: motor to elbow
  S fore = S(200);   ///< mm: elbow to tool

  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> joints(const std::array<T, 3>& p) const {
    const T half(apart / S(2));
    return {two_links(p[0] + half, p[1], upper, fore, true)[0],
            two_links(p[0] - half, p[1], upper, fore, false)[0], p[2]};
  }
  /// The tool lies on the far side of the elbows.
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> point(const std::array<T, 3>& q) const {
    using std::cos, std::sin, std::sqrt;
    const T half(apart / S(2));
    const std::array<T, 2> left{T(upper) * cos(q[0]) - half, T(upper) * sin(q[0])};
    const std::array<T, 2> right{T(upper) * cos(q[1]) + half, T(upper) * sin(q[1])};
    const T x = (right[0] - left[0]) / T(2), y = (right[1] - left[1]) / T(2);
    const T width_sq = square(x) + square(y);
    const T rise = sqrt((T(fore * fore) - width_sq) / width_sq);
    return {left[0] + x - rise * y, left[1] + y + rise * x, q[2]};
  }
};

using FiveBar = BasicFiveBar<double>;

}  // namespace cncplan::kinematics
