// How fast the junction between two blocks may be passed: a policy for the tool, the corners of the axes.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "cncplan/block.hpp"
#include "cncplan/junction/geometry.hpp"
#include "cncplan/junction/policy_ref.hpp"
#include "cncplan/machine.hpp"
#include "cncplan/tool.hpp"

namespace cncplan::detail {

/// How a junction between two blocks looks to the axes and to the tool.
template <std::floating_point S, int N>
struct BasicBlockJunction {
  VectorN<S, N> before, after;  ///< derivatives of the axes by length
  junction::BasicGeometry<S> tool;
};

/// The highest speed at which the axes may change from one block's direction to the next one's, if the
/// junction were rounded within the tolerances: over a blend of half length l the derivative of an axis
/// changes by d, so v^2 d / (2 l) is its acceleration; where that has no limit, a blend at the jerk J has v^3
/// d / l^2 = J. The tool's deviation of a blend with jump D of its direction is l D / 4, that of an axis l d
/// / 4 (a rotary one: rad): the shortest l that one of them allows holds. Infinite where no axis with a limit
/// of acceleration or jerk changes its direction.
template <MachineModel M>
[[nodiscard]] typename M::Scalar axis_corner_speed(
    const BasicBlockJunction<typename M::Scalar, M::axis_count>& junction, const M& machine,
    typename M::Scalar tolerance, typename M::Scalar rotary_tolerance) {
  using S = typename M::Scalar;
  constexpr S none = std::numeric_limits<S>::infinity();
  constexpr S rounding = S(64) * std::numeric_limits<S>::epsilon();
  S blend = none;
  const S tool_jump = (junction.tool.after.tangent - junction.tool.before.tangent).norm();
  if (tool_jump > rounding) blend = S(4) * tolerance / tool_jump;
  const auto jump_of = [&](int axis) {
    const S before = junction.before[axis], after = junction.after[axis];
    const S jump = std::abs(after - before);
    return jump > rounding * (std::abs(before) + std::abs(after)) ? jump : S(0);
  };
  // Under a map the joints turn with the tool's path, or where angles are coordinates by themselves.
  constexpr bool linear = !MappedModel<M>, turned = linear || program_coordinates < M >> 3;
  for (int i = 0; i < M::axis_count; ++i)
    if (const S jump = jump_of(i); jump > S(0)) {
      const bool rotary = machine.axes[static_cast<std::size_t>(i)].kind == AxisKind::rotary;
      if (rotary ? turned : linear)
        blend = std::min(blend, S(4) * (rotary ? rotary_tolerance : tolerance) / jump);
    }
  S speed = none;
  for (int i = 0; i < M::axis_count; ++i) {
    const BasicAxis<S>& axis = machine.axes[static_cast<std::size_t>(i)];
    const S jump = jump_of(i), limit = least_acceleration(axis);
    if (!(jump > S(0))) continue;
    if (std::isfinite(limit))
      speed = std::min(speed, std::sqrt(S(2) * blend * limit / jump));
    else if (std::isfinite(axis.jerk))
      speed = std::min(speed, std::cbrt(blend * blend * axis.jerk / jump));
  }
  return speed;
}

/// The axes at both ends of a path.
template <class Vector>
struct PathEnds {
  PathPoint<Vector> start, end;

  template <Path P>
  explicit PathEnds(const P& path)
      : start(path.point_at(typename P::Scalar(0))), end(path.point_at(path.length())) {}
};
template <class P>
PathEnds(const P&) -> PathEnds<typename P::Vector>;

/// The direction of a vector; zero has none. What is a unit vector already stays as it is.
template <class Vector>
[[nodiscard]] Vector unit(const Vector& v) {
  using S = typename Vector::Scalar;
  const S norm_sq = v.squaredNorm();
  if (std::abs(norm_sq - S(1)) <= S(4) * std::numeric_limits<S>::epsilon() || !(norm_sq > S(0))) return v;
  return v / std::sqrt(norm_sq);
}

/// Where a path meets a junction.
enum class PathEnd : std::uint8_t { start, end };

/// One side of a junction, as junction policies see it: a path of a kind (an arc is told by the path itself),
/// with what its axes are at its ends.
template <Path P>
[[nodiscard]] inline junction::BasicSide<typename P::Scalar> tool_side(
    const P& path, junction::Kind kind, const PathEnds<typename P::Vector>& ends, PathEnd junction,
    const std::array<int, 3>& tool) {
  using S = typename P::Scalar;
  using Vector3 = BasicVector3<S>;
  if constexpr (requires { path.visit([](const auto&) {}); }) {
    return path.visit([&](const auto& inside) { return tool_side(inside, kind, ends, junction, tool); });
  } else {
    junction::BasicSide<S> side;
    side.kind = kind;
    const auto set = [&](const Vector3& first, const Vector3& second, const Vector3& chord) {
      side.tangent = unit(first);
      side.curvature = second;
      side.chord = chord;
    };
    if constexpr (tells_tool<P>) {
      const auto start = tool_point(path, S(0), tool);
      const auto end = tool_point(path, path.length(), tool);
      const auto& at = junction == PathEnd::end ? end : start;
      set(at.first, at.second, end.position - start.position);
    } else {
      const auto& at = junction == PathEnd::end ? ends.end : ends.start;
      set(in_space(at.first, tool), path::is_line<P> ? Vector3(Vector3::Zero()) : in_space(at.second, tool),
          in_space(VectorN<S, P::Vector::RowsAtCompileTime>(ends.end.position - ends.start.position), tool));
    }
    if constexpr (std::same_as<P, path::BasicArc<S>>) {
      side.kind = junction::Kind::arc;
      side.plane = path.plane();
      side.turn = path.turn();
      const auto [first, second, third] = cncplan::axes(path.plane());
      side.closed = side.chord[first] == S(0) && side.chord[second] == S(0);
    }
    return side;
  }
}

/// Rules for joints: a policy for the tool, and for the axes the tolerances within which corners count as
/// rounded (negative: the policy alone).
template <std::floating_point S>
struct BasicJunctionRules {
  junction::BasicPolicyRef<S> policy;
  S tolerance{};
  S rotary_tolerance{};
};

using JunctionRules = BasicJunctionRules<double>;

}  // namespace cncplan::detail
