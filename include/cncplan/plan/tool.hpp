// Where the tool is and goes, while the axes are at a place of their path.
#pragma once

#include <array>
#include <cstddef>

#include "cncplan/core/path_point.hpp"
#include "cncplan/plan/machine.hpp"

namespace cncplan {

/// Which axes are X, Y and Z, by their letters; -1 for one that the machine lacks.
template <MachineModel M>
[[nodiscard]] constexpr std::array<int, 3> tool_axes(const M& machine) {
  std::array<int, 3> result{-1, -1, -1};
  for (std::size_t k = 0; k < result.size(); ++k)
    for (int i = 0; i < M::axis_count; ++i)
      if (machine.axes[static_cast<std::size_t>(i)].letter == "XYZ"[k]) result[k] = i;
  return result;
}

/// X Y Z of the axes' positions, or of their derivatives.
template <class V>
[[nodiscard]] BasicVector3<typename V::Scalar> in_space(const V& axes, const std::array<int, 3>& tool) {
  BasicVector3<typename V::Scalar> result = BasicVector3<typename V::Scalar>::Zero();
  for (int k = 0; k < 3; ++k)
    if (const int axis = tool[static_cast<std::size_t>(k)]; axis >= 0) result[k] = axes[axis];
  return result;
}

/// The tool's point and its derivatives by length: what a path says of it, else the axes X, Y and Z.
template <Path P>
[[nodiscard]] PathPoint<BasicVector3<typename P::Scalar>> tool_point(const P& path, typename P::Scalar s,
                                                                     const std::array<int, 3>& tool) {
  if constexpr (requires { path.tool_point_at(s); }) {
    return path.tool_point_at(s);
  } else if constexpr (requires { path.visit([](const auto&) {}); }) {
    return path.visit([&](const auto& inside) { return tool_point(inside, s, tool); });
  } else {
    const auto at = path.point_at(s);
    return {in_space(at.position, tool), in_space(at.first, tool), in_space(at.second, tool),
            in_space(at.third, tool)};
  }
}

}  // namespace cncplan
