// SPDX-License-Identifier: GPL-2.0-or-later
// LinuxCNC's nine coordinates as a vector, in its units and in those of the library.
#pragma once

#include <cncplan/core/vector.hpp>

#include "linuxcnc.hpp"

namespace cncplan::linuxcnc {

inline constexpr int coordinate_count = 9;
inline constexpr char coordinate_letters[] = "XYZABCUVW";

/// X Y Z A B C U V W.
using Coordinates = VectorN<double, coordinate_count>;

[[nodiscard]] constexpr bool is_rotary(int coordinate) { return coordinate >= 3 && coordinate < 6; }

[[nodiscard]] inline Coordinates coordinates(const EmcPose& pose) {
  Coordinates result;
  result << pose.tran.x, pose.tran.y, pose.tran.z, pose.a, pose.b, pose.c, pose.u, pose.v, pose.w;
  return result;
}

[[nodiscard]] inline EmcPose pose(const Coordinates& at) {
  EmcPose result{};
  result.tran.x = at[0], result.tran.y = at[1], result.tran.z = at[2];
  result.a = at[3], result.b = at[4], result.c = at[5];
  result.u = at[6], result.v = at[7], result.w = at[8];
  return result;
}

[[nodiscard]] inline Vector3 in_space(const PmCartesian& point) { return {point.x, point.y, point.z}; }

/// What one unit of the machine is in the library's: mm for linear axes, rad for rotary ones.
struct Units {
  double linear = 1.0;
  double rotary = 0.017453292519943295;

  [[nodiscard]] double of(int coordinate) const { return is_rotary(coordinate) ? rotary : linear; }
  [[nodiscard]] Coordinates factors() const {
    Coordinates result;
    for (int i = 0; i < coordinate_count; ++i) result[i] = of(i);
    return result;
  }
};

}  // namespace cncplan::linuxcnc
