// X, Y and Z among the axes of a machine.
#pragma once

#include <array>

#include "cncplan/core/vector.hpp"

namespace cncplan {

/// X Y Z of the axes' positions, or of their derivatives. `tool` has their numbers; -1 for one that the
/// machine lacks, which stays 0.
template <class V>
[[nodiscard]] BasicVector3<typename V::Scalar> in_space(const V& axes, const std::array<int, 3>& tool) {
  const auto along = [&](int axis) { return axis >= 0 ? axes[axis] : typename V::Scalar(0); };
  return {along(tool[0]), along(tool[1]), along(tool[2])};
}

}  // namespace cncplan
