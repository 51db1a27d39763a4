// Where the tool is and goes, while the axes are at a place of their path; what the path's length counts.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "cncplan/core/concepts.hpp"
#include "cncplan/core/in_space.hpp"
#include "cncplan/core/path_point.hpp"
#include "cncplan/machine.hpp"
#include "cncplan/path/segment.hpp"

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

/// The tool's point and its derivatives by length: what a path says of it, else the axes X, Y and Z.
template <Path P>
[[nodiscard]] PathPoint<BasicVector3<typename P::Scalar>> tool_point(const P& path, typename P::Scalar s,
                                                                     const std::array<int, 3>& tool) {
  if constexpr (requires { path.tool_point_at(s); }) {
    return path.tool_point_at(s);
  } else if constexpr (requires { path.visit([](const auto&) {}); }) {
    return path.visit([&](const auto& inside) { return tool_point(inside, s, tool); });
  } else {
    return in_space(path.point_at(s), tool);
  }
}

/// The coordinates at which joints stand, by the inverse of a map.
template <path::InvertibleMap Map>
[[nodiscard]] VectorN<typename Map::Scalar, path::coordinate_count<Map>> coordinates_at(
    const Map& map, const VectorN<typename Map::Scalar, static_cast<int>(Map::axis_count)>& position) {
  using S = typename Map::Scalar;
  path::MapJoints<Map, S> joints;
  for (std::size_t i = 0; i < joints.size(); ++i) joints[i] = position[static_cast<Eigen::Index>(i)];
  const auto point = map.point(joints);
  return Eigen::Map<const VectorN<S, path::coordinate_count<Map>>>(point.data());
}

/// Where the tool is while the axes stand at a place, whatever path they are on: the axes X Y Z, or of a map
/// what its inverse says. Not numbers where the map has none.
template <MachineModel M>
[[nodiscard]] BasicVector3<typename M::Scalar> tool_of_axes(
    const M& machine, const VectorN<typename M::Scalar, M::axis_count>& position,
    const std::array<int, 3>& tool) {
  using S = typename M::Scalar;
  if constexpr (!MappedModel<M>)
    return in_space(position, tool);
  else if constexpr (path::InvertibleMap<MapOf<M>>)
    return in_space(coordinates_at(machine.map, position), path::coordinates_in_space<MapOf<M>>);
  else
    return BasicVector3<S>::Constant(std::numeric_limits<S>::quiet_NaN());
}

/// Whether the coordinates of a path are those of the axes though the machine has a map: the program has
/// switched it off.
template <class P>
[[nodiscard]] bool is_direct(const P& path) {
  if constexpr (requires { path.map().on; })
    return !path.map().on;
  else if constexpr (requires { path.visit([](const auto&) { return true; }); })
    return path.visit([](const auto& inside) { return is_direct(inside); });
  else
    return false;
}

/// Where the tool is at a length of a path, the axes at `position`: under a map the tip in the part, also
/// where the axes are driven directly.
template <MachineModel M, Path P>
[[nodiscard]] BasicVector3<typename M::Scalar> tool_position(
    const M& machine, const P& path, typename M::Scalar s,
    const VectorN<typename M::Scalar, M::axis_count>& position, const std::array<int, 3>& tool) {
  if constexpr (MappedModel<M>) {
    if constexpr (path::switchable<MapOf<M>>)
      if (is_direct(path)) return tool_of_axes(machine, position, tool);
    return tool_point(path, s, tool).position;
  } else {
    return in_space(position, tool);
  }
}

/// Whether a path may say more of the tool than its axes do.
template <class P>
inline constexpr bool tells_tool = requires(const P& path, typename P::Scalar s) {
  path.tool_point_at(s);
};

/// What the length of a path counts: the way of the tool; where that stands still, that of linear axes (both
/// mm), or that of rotary ones (rad).
enum class LengthOf : std::uint8_t { tool, linear_axes, rotary_axes };

/// Under a map the axes do not tell: what is no way of the tool is that of rotary coordinates.
template <MachineModel M, Path P>
[[nodiscard]] LengthOf length_of(const P& path, const M& machine) {
  using S = typename M::Scalar;
  const auto bounds = path.bounds(S(0), S(0));
  if (bounds.tool.first > S(0)) return LengthOf::tool;
  if constexpr (!MappedModel<M>)
    for (int i = 0; i < M::axis_count; ++i)
      if (machine.axes[static_cast<std::size_t>(i)].kind == AxisKind::linear && bounds.first[i] > S(0))
        return LengthOf::linear_axes;
  return LengthOf::rotary_axes;
}

}  // namespace cncplan
