// What look-ahead needs to know of a program: cells of its blocks, each with limits along the path (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "cncplan/core/error.hpp"
#include "cncplan/junction/geometry.hpp"
#include "cncplan/junction/stop_at_corners.hpp"
#include "cncplan/plan/caps.hpp"
#include "cncplan/plan/limits_along.hpp"
#include "cncplan/plan/machine_block.hpp"
#include "cncplan/plan/tool.hpp"
#include "cncplan/plan/turnings.hpp"

namespace cncplan::plan {

/// The rest of one block.
template <std::floating_point S>
struct BasicBlockPause {
  std::size_t cells{};  ///< how many cells come before it
  std::size_t block{};
  S seconds{};
};

/// The blocks of a program cut into cells, over each of which one set of limits holds.
template <std::floating_point S>
struct BasicCells {
  std::vector<BasicBlockCaps<S>> caps;     ///< of each cell, in order
  std::vector<std::size_t> blocks;         ///< to which each belongs
  std::vector<BasicBlockPause<S>> pauses;  ///< in order; the caps have those behind a cell as a sum
};

/// The limits of a part of a path.
template <class S>
struct PartLimits {
  S length{};
  BasicLimits<S> limits;
};

/// Cuts a part of a block's path where that makes it faster: it is halved as long as the halves at their own
/// speeds would take 2 % less time than the whole at its one, to 1/256 of it at most. `add` is called with
/// each.
struct CutByLimits {
  template <MachineModel M, BlockModel B, class Add>
  void operator()(const B& block, const M& machine, typename M::Scalar start, typename M::Scalar end,
                  typename M::Scalar speed, typename M::Scalar tool_speed, Add&& add) const {
    using S = typename M::Scalar;
    constexpr int deepest = 8;
    constexpr S worth_it = S(0.98);
    struct Part {
      S from, to;
      BasicLimits<S> limits;
      int depth;
    };
    const auto limits = [&](S from, S to) {
      return limits_along(block.path.bounds(from, to), machine, speed, tool_speed, block.path.length());
    };
    std::array<Part, static_cast<std::size_t>(deepest + 1)> open;
    std::size_t count = 0;
    open[count++] = {start, end, limits(start, end), 0};
    while (count > 0) {
      const Part part = open[--count];
      const S middle = part.from + (part.to - part.from) / S(2);
      if (part.depth < deepest && part.limits.velocity < speed) {
        const Part first{part.from, middle, limits(part.from, middle), part.depth + 1};
        const Part second{middle, part.to, limits(middle, part.to), part.depth + 1};
        const S halves = S(0.5) / first.limits.velocity + S(0.5) / second.limits.velocity;
        if (!(halves >= worth_it / part.limits.velocity)) {
          open[count++] = second;
          open[count++] = first;
          continue;
        }
      }
      add(PartLimits<S>{part.to - part.from, part.limits});
    }
  }
};

/// How a joint between two blocks looks to the axes and to the tool.
template <std::floating_point S, int N>
struct BasicJoint {
  PathPoint<VectorN<S, N>> before, after;
  junction::BasicGeometry<S> tool;
};

/// The highest speed at which the axes may change from one block's direction to the next one's, if the joint
/// were rounded within the tolerances: over a blend of half length l the derivative of an axis changes by d,
/// so v^2 d / (2 l) is its acceleration; where that has no limit, a blend at the jerk J has v^3 d / l^2 = J.
/// The tool's deviation of a blend with jump D of its direction is l D
/// / 4, that of a rotary axis l d / 4 (rad): the shortest l that one of them allows holds. Infinite where no
/// axis with a limit of acceleration or jerk changes its direction.
template <MachineModel M>
[[nodiscard]] typename M::Scalar axis_corner_speed(const BasicJoint<typename M::Scalar, M::axis_count>& joint,
                                                   const M& machine, typename M::Scalar tolerance,
                                                   typename M::Scalar rotary_tolerance) {
  using S = typename M::Scalar;
  constexpr S none = std::numeric_limits<S>::infinity();
  constexpr S rounding = S(64) * std::numeric_limits<S>::epsilon();
  S blend = none;
  const S tool_jump = (joint.tool.after.tangent - joint.tool.before.tangent).norm();
  if (tool_jump > rounding) blend = S(4) * tolerance / tool_jump;
  const auto jump_of = [&](int axis) {
    const S before = joint.before.first[axis], after = joint.after.first[axis];
    const S jump = std::abs(after - before);
    return jump > rounding * (std::abs(before) + std::abs(after)) ? jump : S(0);
  };
  if constexpr (!MappedModel<M>)
    for (int i = 0; i < M::axis_count; ++i)
      if (const S jump = jump_of(i);
          jump > S(0) && machine.axes[static_cast<std::size_t>(i)].kind == AxisKind::rotary)
        blend = std::min(blend, S(4) * rotary_tolerance / jump);
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

/// One side of a joint, as junction policies see it.
template <MachineModel M, BlockModel B>
[[nodiscard]] junction::BasicSide<typename M::Scalar> tool_side(const B& block, bool at_end,
                                                                const std::array<int, 3>& tool) {
  using S = typename M::Scalar;
  const auto at = tool_point(block.path, at_end ? block.path.length() : S(0), tool);
  junction::BasicSide<S> side;
  side.kind = block.rapid ? junction::Kind::rapid : junction::Kind::line;
  side.tangent = at.first.norm() > S(0) ? BasicVector3<S>(at.first.normalized()) : at.first;
  side.curvature = at.second;
  side.chord = tool_point(block.path, block.path.length(), tool).position -
               tool_point(block.path, S(0), tool).position;
  if constexpr (std::same_as<typename B::Path::Arc, path::BasicArc<S>>)
    if (const auto* arc = block.path.arc()) {
      side.kind = junction::Kind::arc;
      side.plane = arc->plane();
      side.turn = arc->turn();
      const auto [first, second, third] = cncplan::axes(arc->plane());
      side.closed = side.chord[first] == S(0) && side.chord[second] == S(0);
    }
  return side;
}

/// Rules for joints: a policy for the tool, and for the axes the tolerances within which corners count as
/// rounded (negative: the policy alone).
template <std::floating_point S, class Policy>
struct JointRules {
  Policy policy;
  S tolerance{};
  S rotary_tolerance{};
};

/// What went wrong with a block.
struct BlockFault {
  Error error;
  std::size_t block{};
};

/// The speed that a program asks of a block: mm/s, or rad/s where the tool stands still.
template <MachineModel M, BlockModel B>
[[nodiscard]] typename M::Scalar wanted_speed(const B& block, const M& machine, LengthOf counted) {
  using S = typename M::Scalar;
  const bool in_space = counted == LengthOf::tool;
  if (block.rapid) return in_space ? rapid_speed(machine) : std::numeric_limits<S>::infinity();
  return in_space ? std::min(block.feed, feed_speed(machine)) : block.feed;
}

/// Nothing, or the first axis that leaves its travel, and to where. What rounding adds is passed over.
template <MachineModel M, Path P>
[[nodiscard]] Expected<void> within_travel(const P& path, const M& machine) {
  using S = typename M::Scalar;
  const auto box = path.box();
  for (int i = 0; i < M::axis_count; ++i) {
    const BasicAxis<S>& axis = machine.axes[static_cast<std::size_t>(i)];
    const S rounding = S(64) * std::numeric_limits<S>::epsilon() *
                       std::max({std::abs(box.low[i]), std::abs(box.high[i]), S(1)});
    const auto refuse = [&](ErrorCode code, S value, S bound) {
      return tl::unexpected(
          Error{code, axis_name(axis.letter), static_cast<double>(value), static_cast<double>(bound)});
    };
    if (!std::isfinite(box.low[i]) || !std::isfinite(box.high[i]))
      return refuse(ErrorCode::unreachable, box.low[i], axis.low);
    if (!(box.low[i] >= axis.low - rounding)) return refuse(ErrorCode::below_limit, box.low[i], axis.low);
    if (!(box.high[i] <= axis.high + rounding)) return refuse(ErrorCode::above_limit, box.high[i], axis.high);
  }
  return {};
}

namespace detail {

/// Nothing, or the first axis that would have to jump from the end of a block to the start of the next one,
/// by more than 1e-6 mm or rad.
template <MachineModel M>
[[nodiscard]] Expected<void> joined(const std::optional<VectorN<typename M::Scalar, M::axis_count>>& end,
                                    const VectorN<typename M::Scalar, M::axis_count>& start,
                                    const M& machine) {
  using S = typename M::Scalar;
  if (!end) return {};
  for (int i = 0; i < M::axis_count; ++i) {
    const S rounding = std::max(S(1e-6), S(64) * std::numeric_limits<S>::epsilon() * std::abs(start[i]));
    if (std::abs(start[i] - (*end)[i]) > rounding)
      return tl::unexpected(Error{ErrorCode::discontinuous,
                                  axis_name(machine.axes[static_cast<std::size_t>(i)].letter),
                                  static_cast<double>(start[i]), static_cast<double>((*end)[i])});
  }
  return {};
}

template <MachineModel M, BlockModel B, class Policy>
[[nodiscard]] typename M::Scalar joint_speed(const B& before, const B& after, const M& machine,
                                             const JointRules<typename M::Scalar, Policy>& rules,
                                             const std::array<int, 3>& tool) {
  using S = typename M::Scalar;
  BasicJoint<S, M::axis_count> joint{
      before.path.point_at(before.path.length()),
      after.path.point_at(S(0)),
      {tool_side<M>(before, true, tool), tool_side<M>(after, false, tool), machine.limits}};
  joint.tool.limits.velocity =
      std::min(wanted_speed(before, machine, LengthOf::tool), wanted_speed(after, machine, LengthOf::tool));
  S speed_sq = rules.policy.speed_sq(joint.tool);
  if (before.exact_path)
    speed_sq = std::min(speed_sq, junction::BasicStopAtCorners<S>{}.speed_sq(joint.tool));
  const S speed = speed_sq > S(0) ? std::sqrt(speed_sq) : S(0);
  if (rules.tolerance < S(0)) return speed;
  return std::min(speed, axis_corner_speed(joint, machine, rules.tolerance, rules.rotary_tolerance));
}

}  // namespace detail

/// Cuts a program into cells, `cut` each block. A joint within one motion has no rules of its own; where an
/// axis with backlash turns round, the speed leaves its motors time for that. Errors: those of `validate` for
/// the limits of a block; below_limit and above_limit where an axis would leave its travel; unreachable where
/// the machine has no position for a place; discontinuous where a block begins elsewhere than the one before
/// it ends.
template <MachineModel M, BlockModel B, class Policy, class Cut = CutByLimits>
[[nodiscard]] Expected<BasicCells<typename M::Scalar>, BlockFault> make_cells(
    std::span<const B> blocks, const M& machine, const JointRules<typename M::Scalar, Policy>& rules,
    const Cut& cut = {}) {
  using S = typename M::Scalar;
  using Vector = VectorN<S, M::axis_count>;
  static_assert(M::axis_count == B::axis_count, "blocks have as many axes as the machine");
  constexpr S infinity = std::numeric_limits<S>::infinity();
  BasicCells<S> cells;
  const std::array<int, 3> tool = tool_axes(machine);
  const B* before = nullptr;  // the block that moved last, where the motion does not stop behind it
  LengthOf before_counted{};
  std::optional<Vector> end;  // of the block before
  Turnings<M> turnings(machine);
  const auto rest = [&](std::size_t block, S seconds) {
    if (!cells.caps.empty()) cells.caps.back().pause += seconds;
    cells.pauses.push_back({cells.caps.size(), block, seconds});
  };
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const B& block = blocks[i];
    const auto refuse = [&](const Error& error) { return tl::unexpected(BlockFault{error, i}); };
    if (auto ok = detail::joined(end, block.path.position_at(S(0)), machine); !ok) return refuse(ok.error());
    end = block.path.position_at(block.path.length());
    if (auto ok = within_travel(block.path, machine); !ok) return refuse(ok.error());
    if (block.path.length() > S(0)) {
      const LengthOf counted = length_of(block.path, machine);
      S entry = S(0);
      if (before != nullptr && counted == before_counted)
        entry = before->goes_on ? infinity : detail::joint_speed(*before, block, machine, rules, tool);
      std::optional<Error> wrong;
      S at = S(0);
      const auto& turns = turnings.next(block.path);
      auto turning = turns.begin();
      const auto add = [&](const PartLimits<S>& part) {
        if (const auto ok = validate(part.limits); !ok && !wrong) wrong = ok.error();
        for (; turning != turns.end() && !(turning->at > at); ++turning) {
          entry = std::min(entry, turning->speed(part.limits));
          if (entry > S(0) || cells.caps.empty()) continue;
          if (const S more = turning->pause(part.limits) - cells.caps.back().pause; more > S(0))
            rest(cells.blocks.back(), more);
        }
        cells.caps.push_back({part.length, entry, part.limits, S(0)});
        cells.blocks.push_back(i);
        entry = infinity;
      };
      const S speed = wanted_speed(block, machine, counted);
      const S tool_speed = block.rapid ? rapid_speed(machine) : machine.limits.velocity;
      while (at < block.path.length()) {
        auto next = turning;
        while (next != turns.end() && !(next->at > at)) ++next;
        const S to = next != turns.end() ? std::min(next->at, block.path.length()) : block.path.length();
        cut(block, machine, at, to, speed, tool_speed, add);
        at = to;
      }
      if (wrong) return refuse(*wrong);
      before = &block;
      before_counted = counted;
    }
    if (!block.exact_stop && !(block.pause > S(0))) continue;
    before = nullptr;
    if (block.pause > S(0)) rest(i, block.pause);
  }
  return cells;
}

}  // namespace cncplan::plan
