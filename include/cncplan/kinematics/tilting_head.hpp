// Five-axis mills whose spindle tilts: with a table that turns, or with both rotary axes in the head.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "cncplan/core/jet.hpp"
#include "cncplan/kinematics/detail/rotation.hpp"

namespace cncplan::kinematics {

/// Where the axes X Y Z stand for a tip in the machine and a direction of the tool. They show the tip of a
/// tool without length while the spindle is upright; the spindle turns about a pivot above it. With both
/// lengths negated, the other way.
template <class T, class S>
[[nodiscard]] std::array<T, 3> at_tip(const std::array<T, 3>& tip, const std::array<T, 3>& direction,
                                      S pivot_length, S tool_length) {
  const T arm(pivot_length + tool_length);
  return {tip[0] + arm * direction[0], tip[1] + arm * direction[1],
          tip[2] + arm * direction[2] - T(pivot_length)};
}
/// The same of a head that has both rotary axes, the last two coordinates.
template <class T, class S>
[[nodiscard]] std::array<T, 5> axes_of_head(const std::array<T, 5>& at, const std::array<T, 3>& direction,
                                            S pivot_length, S tool_length) {
  const auto q = at_tip(std::array<T, 3>{at[0], at[1], at[2]}, direction, pivot_length, tool_length);
  return {q[0], q[1], q[2], at[3], at[4]};
}
/// A spindle that tilts about B over a table that turns about C. Program: X Y Z of the tip in the part, mm, B
/// and C, rad. The tip stands in the machine at center + Rz(c) (p - center), the tool along
/// t = (sin b, 0, cos b), and the axes X Y Z at that tip + (pivot_length + tool_length) t - pivot_length ez.
/// Singular for B 0, where C turns the part under the tool and no direction asks for it. Source: LinuxCNC,
/// maxkins.
template <std::floating_point S>
struct BasicHeadTable {
  using Scalar = S;
  static constexpr int axis_count = 5;
  static constexpr std::string_view coordinates = "XYZBC";
  static constexpr bool switchable = true;

  std::array<S, 3> center{};  ///< mm, machine coordinates: a point of C's axis
  S pivot_length{};           ///< mm: from the nose of the spindle to the axis of B
  S tool_length{};            ///< mm

  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 5> joints(const std::array<T, 5>& at) const {
    const auto& [x, y, z, b, c] = at;
    const auto tip = sum<T>(about_z(c, difference<T>(std::array<T, 3>{x, y, z}, center)), center);
    const auto q = at_tip(tip, tilted(b), pivot_length, tool_length);
    return {q[0], q[1], q[2], b, c};
  }
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 5> point(const std::array<T, 5>& at) const {
    const auto& [x, y, z, b, c] = at;
    const auto tip = at_tip(std::array<T, 3>{x, y, z}, tilted(b), -pivot_length, -tool_length);
    const auto p = sum<T>(about_z(-c, difference<T>(tip, center)), center);
    return {p[0], p[1], p[2], b, c};
  }

  /// Of the tool in the part, of length 1, from the tip to the spindle.
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> direction(const std::array<T, 5>& joints) const {
    return about_z(-joints[4], tilted(joints[3]));
  }
  /// The two positions of B and C that give a direction, rad; C is 0 of an upright one.
  [[nodiscard]] std::array<std::array<S, 2>, 2> angles(const std::array<S, 3>& direction) const {
    return tilt_and_turn(direction, direction[0], -direction[1]);
  }

 private:
  template <class T>
  static std::array<T, 3> tilted(const T& b) {
    using std::cos, std::sin;
    return {sin(b), T(0), cos(b)};
  }
};

using HeadTable = BasicHeadTable<double>;

/// A fork that turns about C and holds a spindle that tilts about A or B. Program: X Y Z of the tip, mm, A or
/// B and C, rad. The tool lies along t = Rz(c) Rx(a) ez = (sin a sin c, -sin a cos c, cos a), or along
/// Rz(c) Ry(b) ez = (sin b cos c, sin b sin c, cos b), and the axes X Y Z stand at
/// p + (pivot_length + tool_length) t - pivot_length ez. Singular where it is upright: every C gives the same
/// direction. Source: LinuxCNC, Five Axis Kinematics, and 5axiskins.
template <std::floating_point S, Tilt tilt>
struct BasicHeadHead {
  using Scalar = S;
  static constexpr int axis_count = 5;
  static constexpr std::string_view coordinates = tilt == Tilt::a ? "XYZAC" : "XYZBC";
  static constexpr bool switchable = true;

  S pivot_length{};  ///< mm: from the nose of the spindle to where both axes meet
  S tool_length{};   ///< mm

  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 5> joints(const std::array<T, 5>& at) const {
    return axes_of_head(at, direction(at), pivot_length, tool_length);
  }
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 5> point(const std::array<T, 5>& at) const {
    return axes_of_head(at, direction(at), -pivot_length, -tool_length);
  }

  /// Of the tool, of length 1, from the tip to the spindle.
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> direction(const std::array<T, 5>& joints) const {
    return about_z(joints[4], about_tilt<tilt>(joints[3], std::array<T, 3>{T(0), T(0), T(1)}));
  }
  /// The two positions of the tilting axis and C that give a direction, rad; C is 0 of an upright one.
  [[nodiscard]] std::array<std::array<S, 2>, 2> angles(const std::array<S, 3>& direction) const {
    const auto& [i, j, k] = direction;
    return tilt == Tilt::a ? tilt_and_turn(direction, -j, i) : tilt_and_turn(direction, i, j);
  }
};

template <std::floating_point S>
using BasicHeadHeadAC = BasicHeadHead<S, Tilt::a>;
template <std::floating_point S>
using BasicHeadHeadBC = BasicHeadHead<S, Tilt::b>;

using HeadHeadAC = BasicHeadHeadAC<double>;
using HeadHeadBC = BasicHeadHeadBC<double>;

/// A head that turns about C and carries a spindle on an axis B that leans by `lean` from Z (nutating head):
/// the axis of B is n = (0, sin lean, cos lean) at C 0. Program: X Y Z of the tip, mm, B and C, rad. With
/// s = sin lean and k = cos lean the tool lies along
///
///     t = Rz(c) (s sin b, s k (1 - cos b), cos b + k^2 (1 - cos b))
///
/// and the axes X Y Z stand at p + (pivot_length + tool_length) t - pivot_length ez. The tool tilts by twice
/// the lean at most. Singular for B 0. Source: Rodrigues' formula; She, Huang 2007, Int. J. Adv. Manuf.
/// Technol. 32, "Postprocessor development of a five-axis machine tool with nutating head and table
/// configuration".
template <std::floating_point S>
struct BasicNutatingHead {
  using Scalar = S;
  static constexpr int axis_count = 5;
  static constexpr std::string_view coordinates = "XYZBC";
  static constexpr bool switchable = true;

  S lean = std::numbers::pi_v<S> / S(4);  ///< rad, in (0, pi / 2]
  S pivot_length{};                       ///< mm: from the nose of the spindle to where both axes meet
  S tool_length{};                        ///< mm

  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 5> joints(const std::array<T, 5>& at) const {
    return axes_of_head(at, direction(at), pivot_length, tool_length);
  }
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 5> point(const std::array<T, 5>& at) const {
    return axes_of_head(at, direction(at), -pivot_length, -tool_length);
  }

  /// Of the tool, of length 1, from the tip to the spindle.
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> direction(const std::array<T, 5>& joints) const {
    using std::cos, std::sin;
    const T s(std::sin(lean)), k(std::cos(lean));
    const T& b = joints[3];
    const T rest = T(1) - cos(b);
    return about_z(joints[4], std::array<T, 3>{s * sin(b), s * k * rest, T(1) - s * s * rest});
  }
  /// The two positions of B and C that give a direction, rad; C is 0 of an upright one. Of a direction that
  /// is tilted by more than twice the lean they are not numbers.
  [[nodiscard]] std::array<std::array<S, 2>, 2> angles(const std::array<S, 3>& direction) const {
    const S s = std::sin(lean), k = direction[2], across = std::hypot(direction[0], direction[1]);
    if (!(across > S(0)) && k > S(0)) return {};
    // Of an angle's half the sine is known: sin(tilt / 2) = s sin(b / 2).
    const S half = std::sqrt((S(1) - k) / S(2)) / s;
    const S b = S(2) * std::asin(half <= S(1) + S(1e-12) ? std::min(half, S(1)) : half);
    const auto turned = [&](S angle) {
      const S rest = S(1) - std::cos(angle);
      return std::atan2(direction[1], direction[0]) -
             std::atan2(s * std::cos(lean) * rest, s * std::sin(angle));
    };
    return {{{b, turned(b)}, {-b, turned(-b)}}};
  }
};

using NutatingHead = BasicNutatingHead<double>;

}  // namespace cncplan::kinematics
