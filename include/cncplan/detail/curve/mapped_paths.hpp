// The paths of a machine with a map: switched on or off, with the turns that its joints take.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "cncplan/core/error.hpp"
#include "cncplan/core/vector.hpp"
#include "cncplan/detail/curve/follow_turns.hpp"
#include "cncplan/kinematics/detail/azimuth.hpp"
#include "cncplan/machine.hpp"
#include "cncplan/path/detail/switched.hpp"
#include "cncplan/path/mapped.hpp"
#include "cncplan/path/straight_in_joints.hpp"
#include "cncplan/tool.hpp"

namespace cncplan::detail {

/// Where a motion begins: the joints too, once anything has moved, and tool-point control as in
/// `gcode::Motion`.
template <std::floating_point S, int coordinates, int joints>
struct BasicMotionStart {
  VectorN<S, coordinates> place = VectorN<S, coordinates>::Zero();  ///< in the program's coordinates
  std::optional<VectorN<S, joints>> axes{};                         ///< behind a map
  std::optional<double> tool_point{};
};

/// The map of a block; `tool_point` has the length of the tool, mm, where a program has switched it on.
template <MappedModel M>
[[nodiscard]] auto block_map(const M& machine, const std::optional<double>& tool_point) {
  auto map = machine.map;
  if constexpr (path::switchable<MapOf<M>>) {
    const auto more = static_cast<typename M::Scalar>(tool_point.value_or(0.0));
    if constexpr (requires { map.tool_length; })
      map.tool_length += more;
    else if constexpr (requires { map.add_tool_length(more); })
      map.add_tool_length(more);
    return path::BlockMap<MapOf<M>>{map, tool_point.has_value()};
  } else {
    return map;
  }
}

/// An angle, and the fewest whole turns that bring it into the travel of an axis.
template <std::floating_point S>
[[nodiscard]] S into_travel(S angle, const BasicAxis<S>& axis) {
  const S more = kinematics::turns_into(angle, angle, axis.low, axis.high);
  return std::isfinite(more) ? angle + more : angle;
}

/// A feed move of the tool behind the map of a block; `axes`: where the joints stand, if that is known.
/// Errors: those of `follow_turns`.
template <MappedModel M, Path P>
[[nodiscard]] Expected<path::Mapped<path::BlockMap<MapOf<M>>, P>> mapped_path(
    const M& machine, const path::BlockMap<MapOf<M>>& map, const P& programmed,
    const std::optional<VectorN<typename M::Scalar, M::axis_count>>& axes) {
  using Mapped = path::Mapped<path::BlockMap<MapOf<M>>, P>;
  const Mapped path(map, programmed);
  if (is_direct(path)) return path;
  return follow_turns(path, machine, free_joints(machine, programmed.start()), axes)
      .map([&](const auto& turns) { return Mapped(map, programmed, turns); });
}

/// The same where a motion begins.
template <MappedModel M, Path P, class Start>
[[nodiscard]] auto mapped_path(const M& machine, const P& programmed, const std::optional<double>& tool_point,
                               const Start& start) {
  return mapped_path(machine, block_map(machine, tool_point), programmed, start.axes);
}

/// No motion, where a motion begins.
template <MappedModel M, Path P, class Start>
[[nodiscard]] auto mapped_rest(const M& machine, const P& programmed, const Start& start) {
  using Mapped = path::Mapped<path::BlockMap<MapOf<M>>, P>;
  const auto map = block_map(machine, start.tool_point);
  if (!start.axes) return Mapped(map, programmed);
  return Mapped(map, programmed, {*start.axes, *start.axes, rotary_joints(machine)});
}

/// A rapid, straight in the joints; those whose turns are free go the shorter way where their travel lets
/// them. Other rotary ones turn by what the program's angles alone would turn them, and from there the
/// shorter way: a wrist that counts against an arm does not unwind where the arm's formula jumps.
template <MappedModel M, Path P, class Start>
[[nodiscard]] auto mapped_rapid(const M& machine, const P& programmed,
                                const std::optional<double>& tool_point, const Start& start) {
  using Map = path::BlockMap<MapOf<M>>;
  const path::Mapped<Map, P> ends(block_map(machine, tool_point), programmed);
  auto from = ends.position_at(0), to = ends.position_at(programmed.length());
  typename path::StraightInJoints<Map>::Turning turning{};
  const bool direct = path::switchable<MapOf<M>> && !tool_point;
  const std::uint32_t joints = direct ? 0 : rotary_joints(machine);
  const std::uint32_t free = direct ? 0 : free_joints(machine, programmed.start());
  path::MapPoint<Map, typename M::Scalar> point;
  for (std::size_t k = 0; k < point.size(); ++k) {
    const bool angle = path::coordinate_kind(path::coordinate_letters<Map>[k]) == AxisKind::rotary;
    point[k] = (angle ? programmed.end() : programmed.start())[static_cast<Eigen::Index>(k)];
  }
  const auto turned = ends.map().joints(point);
  for (std::size_t k = 0; k < turning.size(); ++k) {
    turning[k] = ((joints >> k) & 1U) != 0;
    if (!turning[k]) continue;
    const auto i = static_cast<Eigen::Index>(k);
    const bool any = ((free >> k) & 1U) != 0;
    auto named = turned[k] - from[i];
    if (any || !std::isfinite(named)) named = 0;
    if (start.axes)
      from[i] = kinematics::near_turn(from[i], (*start.axes)[i]);
    else if (any)
      from[i] = into_travel(from[i], machine.axes[k]);
    to[i] = kinematics::near_turn(to[i], from[i] + named);
    if (any) to[i] = into_travel(to[i], machine.axes[k]);
  }
  return path::StraightInJoints<Map>(ends.map(), programmed.start(), programmed.end(), from, to, turning);
}

/// The joints with those rotary ones that give a direction of the tool, of all that do and that `allowed`
/// says yes to those nearest to `here`, and within the travel if any are; none where there are none.
template <MappedModel M, class Allowed>
[[nodiscard]] auto joints_of_direction(const M& machine, const std::array<typename M::Scalar, 3>& direction,
                                       const path::MapJoints<MapOf<M>, typename M::Scalar>& here,
                                       const Allowed& allowed) {
  using S = typename M::Scalar;
  constexpr S upright = S(1e-9);  // rad; nearer than that the second angle may be any
  std::optional<path::MapJoints<MapOf<M>, S>> best;
  S least{};
  bool within = false;
  for (const auto& angles : machine.map.angles(direction)) {
    auto there = here;
    S way{};
    bool inside = true;
    for (std::size_t k = 0; k < angles.size(); ++k) {
      const std::size_t i = here.size() - angles.size() + k;
      const auto& axis = machine.axes[i];
      if (k == 0 || std::abs(angles[0]) > upright) there[i] = kinematics::near_turn(angles[k], here[i]);
      there[i] = into_travel(there[i], axis);
      inside = inside && axis.low <= there[i] && there[i] <= axis.high;
      way += std::abs(there[i] - here[i]);
    }
    if (!std::isfinite(way) || !allowed(there)) continue;
    if (best && (within > inside || (within == inside && !(way < least)))) continue;
    best = there;
    least = way;
    within = inside;
  }
  return best;
}

}  // namespace cncplan::detail
