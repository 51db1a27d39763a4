// The map of an arm, as a program of one's own would have it.
#pragma once

#include <array>
#include <cmath>

#include "cncplan/core/vector.hpp"

namespace cncplan::test {

/// Shoulder, elbow (rad) and slide (mm) of an arm; `tool` is its way back from joints to X Y Z.
struct Scara {
  using Scalar = double;
  static constexpr int axis_count = 3;
  double upper = 200, fore = 150;  // mm

  template <class T>
  [[nodiscard]] std::array<T, 3> joints(const std::array<T, 3>& point) const {
    using std::atan2, std::sqrt;
    const auto& [x, y, z] = point;
    const T cosine = (x * x + y * y - T(upper * upper + fore * fore)) / T(2 * upper * fore);
    const T sine = sqrt(T(1) - cosine * cosine);
    return {atan2(y, x) - atan2(T(fore) * sine, T(upper) + T(fore) * cosine), atan2(sine, cosine), z};
  }
  [[nodiscard]] Vector3 tool(const Vector3& joints) const {
    const double shoulder = joints[0], both = joints[0] + joints[1];
    return {upper * std::cos(shoulder) + fore * std::cos(both),
            upper * std::sin(shoulder) + fore * std::sin(both), joints[2]};
  }
};

}  // namespace cncplan::test
