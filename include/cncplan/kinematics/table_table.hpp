// Five-axis mills whose table tilts and turns: the tool stays upright, the part moves under it.
#pragma once

#include <array>
#include <string_view>

#include "cncplan/core/jet.hpp"
#include "cncplan/kinematics/detail/rotation.hpp"

namespace cncplan::kinematics {

/// A table that turns about C on a cradle that tilts about A or B (trunnion). Program: X Y Z of the tip in
/// the part, mm, A or B and C, rad. With the axes where the machine is at A0 C0 or B0 C0, the tip stands in
/// the machine at
///
///     center + apart + Rx(a) (Rz(c) (p - center) - apart)    or    ... Ry(b) ...
///
/// and the axes X Y Z there, Z higher by the length of the tool. The tool's direction in the part is
/// (sin a sin c, sin a cos c, cos a), or (-sin b cos c, sin b sin c, cos b): upright it is the same for every
/// C (singular: a program that passes there may have to turn C fast; the axis' own limits slow it). Source:
/// LinuxCNC, Five Axis Kinematics, xyzac-trt and xyzbc-trt, with the sense of both angles of the table
/// itself.
template <std::floating_point S, Tilt tilt>
struct BasicTableTable {
  using Scalar = S;
  static constexpr int axis_count = 5;
  static constexpr std::string_view coordinates = tilt == Tilt::a ? "XYZAC" : "XYZBC";
  static constexpr bool switchable = true;

  std::array<S, 3> center{};  ///< mm, machine coordinates: a point of C's axis, at the height of the cradle's
  std::array<S, 3> apart{};   ///< mm: from C's axis to that of the cradle; on some machines they do not meet
  S tool_length{};            ///< mm

  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 5> joints(const std::array<T, 5>& at) const {
    const auto& [x, y, z, a, c] = at;
    const auto turned = about_z(c, difference<T>(std::array<T, 3>{x, y, z}, center));
    const auto tip = sum<T>(about_tilt<tilt>(a, difference<T>(turned, apart)), sum<S>(center, apart));
    return {tip[0], tip[1], tip[2] + T(tool_length), a, c};
  }
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 5> point(const std::array<T, 5>& at) const {
    const auto& [x, y, z, a, c] = at;
    const std::array<T, 3> tip{x, y, z - T(tool_length)};
    const auto level = sum<T>(about_tilt<tilt>(-a, difference<T>(tip, sum<S>(center, apart))), apart);
    const auto p = sum<T>(about_z(-c, level), center);
    return {p[0], p[1], p[2], a, c};
  }

  /// Of the tool in the part, of length 1, from the tip to the spindle.
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> direction(const std::array<T, 5>& joints) const {
    return about_z(-joints[4], about_tilt<tilt>(-joints[3], std::array<T, 3>{T(0), T(0), T(1)}));
  }
  /// The two positions of the cradle and C that give a direction, rad; C is 0 of an upright one.
  [[nodiscard]] std::array<std::array<S, 2>, 2> angles(const std::array<S, 3>& direction) const {
    const auto& [i, j, k] = direction;
    return tilt == Tilt::a ? tilt_and_turn(direction, j, i) : tilt_and_turn(direction, -i, j);
  }
};

template <std::floating_point S>
using BasicTableTableAC = BasicTableTable<S, Tilt::a>;
template <std::floating_point S>
using BasicTableTableBC = BasicTableTable<S, Tilt::b>;

using TableTableAC = BasicTableTableAC<double>;
using TableTableBC = BasicTableTableBC<double>;

}  // namespace cncplan::kinematics
