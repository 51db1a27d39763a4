// X, Y and Z among the axes of a machine.
#pragma once

#include <array>

#include "cncplan/core/path_point.hpp"
#include "cncplan/core/vector.hpp"

namespace cncplan {

/// X Y Z of the axes' positions, or of their derivatives. `tool` has their numbers; -1 for one that the
/// machine lacks, which stays 0.
template <class V>
[[nodiscard]] BasicVector3<typename V::Scalar> in_space(const V& axes, const std::array<int, 3>& tool) {
  const auto along = [&](int axis) { return axis >= 0 ? axes[axis] : typename V::Scalar(0); };
  return {along(tool[0]), along(tool[1]), along(tool[2])};
}
/// The same of a point of a path, with its derivatives.
template <class V>
[[nodiscard]] PathPoint<BasicVector3<typename V::Scalar>> in_space(const PathPoint<V>& axes,
                                                                   const std::array<int, 3>& tool) {
  return {in_space(axes.position, tool), in_space(axes.first, tool), in_space(axes.second, tool),
          in_space(axes.third, tool)};
}

}  // namespace cncplan
