// Five-axis mills whose table tilts and turns: the tool stays upright, the part moves under it.
#pragma once

#include <array>
#include <cmath>
#include <numbers>
#include <string_view>

#include "cncplan/core/jet.hpp"
#include "cncplan/kinematics/rotation.hpp"

namespace cncplan::kinematics {

/// A table that turns about C on a cradle that tilts about A (trunnion). Program: X Y Z of the tip in the
/// part, mm, A and C, rad. With the axes where the machine is at A0 C0, the tip stands in the machine at
///
///     center + apart + Rx(a) (Rz(c) (p - center) - apart)
///
/// and the axes X Y Z there, Z higher by the length of the tool. The tool's direction in the part is
/// (sin a sin c, sin a cos c, cos a): for A 0 it is the same for every C (singular: a program that passes
/// upright may have to turn C fast; the axis' own limits slow it). Source: LinuxCNC, Five Axis Kinematics,
/// xyzac-trt, with the sense of both angles of the table itself.
template <std::floating_point S>
struct BasicTableTableAC {
  using Scalar = S;
  static constexpr int axis_count = 5;
  static constexpr std::string_view coordinates = "XYZAC";
  static constexpr bool switchable = true;

  std::array<S, 3> center{};  ///< mm, machine coordinates: a point of C's axis, at the height of A's
  std::array<S, 3> apart{};   ///< mm: from C's axis to that of A, which do not meet on every machine
  S tool_length{};            ///< mm

  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 5> joints(const std::array<T, 5>& at) const {
    const auto& [x, y, z, a, c] = at;
    const auto turned = about_z(c, difference<T>(std::array<T, 3>{x, y, z}, center));
    const auto tip = sum<T>(about_x(a, difference<T>(turned, apart)), sum<S>(center, apart));
    return {tip[0], tip[1], tip[2] + T(tool_length), a, c};
  }
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 5> point(const std::array<T, 5>& at) const {
    const auto& [x, y, z, a, c] = at;
    const std::array<T, 3> tip{x, y, z - T(tool_length)};
    const auto level = sum<T>(about_x(-a, difference<T>(tip, sum<S>(center, apart))), apart);
    const auto p = sum<T>(about_z(-c, level), center);
    return {p[0], p[1], p[2], a, c};
  }

  /// Of the tool in the part, of length 1, from the tip to the spindle.
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> direction(const std::array<T, 5>& joints) const {
    return about_z(-joints[4], about_x(-joints[3], std::array<T, 3>{T(0), T(0), T(1)}));
  }
  /// The two positions of A and C that give a direction, rad; C is 0 of an upright one.
  [[nodiscard]] std::array<std::array<S, 2>, 2> angles(const std::array<S, 3>& direction) const {
    const auto& [i, j, k] = direction;
    const S a = std::atan2(std::hypot(i, j), k), c = a > S(0) ? std::atan2(i, j) : S(0);
    return {{{a, c}, {-a, c + std::numbers::pi_v<S>}}};
  }
};

using TableTableAC = BasicTableTableAC<double>;

/// The same with a cradle that tilts about B: the tip stands in the machine at
///
///     center + apart + Ry(b) (Rz(c) (p - center) - apart)
///
/// and the tool's direction in the part is (-sin b cos c, sin b sin c, cos b); singular for B 0. Source:
/// LinuxCNC, Five Axis Kinematics, xyzbc-trt, with the sense of both angles of the table itself.
template <std::floating_point S>
struct BasicTableTableBC {
  using Scalar = S;
  static constexpr int axis_count = 5;
  static constexpr std::string_view coordinates = "XYZBC";
  static constexpr bool switchable = true;

  std::array<S, 3> center{};  ///< mm, machine coordinates: a point of C's axis, at the height of B's
  std::array<S, 3> apart{};   ///< mm: from C's axis to that of B
  S tool_length{};            ///< mm

  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 5> joints(const std::array<T, 5>& at) const {
    const auto& [x, y, z, b, c] = at;
    const auto turned = about_z(c, difference<T>(std::array<T, 3>{x, y, z}, center));
    const auto tip = sum<T>(about_y(b, difference<T>(turned, apart)), sum<S>(center, apart));
    return {tip[0], tip[1], tip[2] + T(tool_length), b, c};
  }
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 5> point(const std::array<T, 5>& at) const {
    const auto& [x, y, z, b, c] = at;
    const std::array<T, 3> tip{x, y, z - T(tool_length)};
    const auto level = sum<T>(about_y(-b, difference<T>(tip, sum<S>(center, apart))), apart);
    const auto p = sum<T>(about_z(-c, level), center);
    return {p[0], p[1], p[2], b, c};
  }

  /// Of the tool in the part, of length 1, from the tip to the spindle.
  template <NumberOver<S> T>
  [[nodiscard]] std::array<T, 3> direction(const std::array<T, 5>& joints) const {
    return about_z(-joints[4], about_y(-joints[3], std::array<T, 3>{T(0), T(0), T(1)}));
  }
  /// The two positions of B and C that give a direction, rad; C is 0 of an upright one.
  [[nodiscard]] std::array<std::array<S, 2>, 2> angles(const std::array<S, 3>& direction) const {
    const auto& [i, j, k] = direction;
    const S b = std::atan2(std::hypot(i, j), k), c = b > S(0) ? std::atan2(j, -i) : S(0);
    return {{{b, c}, {-b, c + std::numbers::pi_v<S>}}};
  }
};

using TableTableBC = BasicTableTableBC<double>;

}  // namespace cncplan::kinematics
