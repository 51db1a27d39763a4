// The junction of two blocks: whether it is smoothed, and what that needs.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <limits>
#include <numbers>

#include "cncplan/block.hpp"
#include "cncplan/core/detail/fixed_list.hpp"
#include "cncplan/detail/block_checks.hpp"
#include "cncplan/detail/curve/junction_mode.hpp"
#include "cncplan/detail/curve/kernel_sizes.hpp"
#include "cncplan/detail/speed/limits_along.hpp"
#include "cncplan/tool.hpp"

namespace cncplan::detail {

/// Tolerances for smoothing.
template <std::floating_point S>
struct SmoothingRules {
  S tolerance{};         ///< mm, > 0, of blocks that do not say their own
  S rotary_tolerance{};  ///< rad, > 0
  bool exact_between_rapids_and_feeds{};
};

/// Turns sharper than this stay exact: where a tool goes back the way it came, the depth counts.
template <std::floating_point S>
inline constexpr S sharpest_smooth_turn = S(175) * std::numbers::pi_v<S> / S(180);

/// Exact junctions of the exact path mode that turn by no more than this are passed.
template <std::floating_point S>
inline constexpr S flattest_stop = std::numbers::pi_v<S> / S(1800);

/// Two blocks that follow each other without a rest between them.
template <MachineModel M, BlockModel B>
struct Junction {
  using S = typename M::Scalar;
  using Vector = VectorN<S, M::axis_count>;

  Vector direction, curvature;  ///< their jumps
  S turn{};                     ///< of the tool, rad; of the axes where it stands still

  Junction(const B& before, const B& after, const std::array<int, 3>& tool) {
    const auto last = before.path.point_at(before.path.length()), first = after.path.point_at(S(0));
    direction = first.first - last.first;
    curvature = first.second - last.second;
    BasicVector3<S> a = in_space(last.first, tool), b = in_space(first.first, tool);
    if constexpr (MappedModel<M>) {  // the axes do not tell
      a = tool_point(before.path, before.path.length(), tool).first;
      b = tool_point(after.path, S(0), tool).first;
    }
    turn = a.norm() > S(0) && b.norm() > S(0) ? between(a, b) : between(last.first, first.first);
  }

 private:
  template <class V>
  static S between(const V& a, const V& b) {
    const V x = a.normalized(), y = b.normalized();
    return S(2) * std::atan2((y - x).norm(), (y + x).norm());
  }
};

/// How far smoothing may take the tool from a block, mm; 0 where it may not.
template <BlockModel B, std::floating_point S>
[[nodiscard]] S tolerance_of(const B& block, const SmoothingRules<S>& rules) {
  return block.exact_path ? S(0) : (S(1) - block.merged) * block.tolerance.value_or(rules.tolerance);
}

/// How the motion passes from one block to the next, both of a length > 0, without a rest between them.
template <BlockModel B, MachineModel M>
[[nodiscard]] JunctionMode junction_mode_between(const B& before, const B& after, const M& machine,
                                                 const SmoothingRules<typename M::Scalar>& rules) {
  using S = typename M::Scalar;
  if (length_of(before.path, machine) != length_of(after.path, machine)) return JunctionMode::stop;
  const S turn = Junction<M, B>(before, after, tool_axes(machine)).turn;
  const bool exact = !(std::min(tolerance_of(before, rules), tolerance_of(after, rules)) > S(0)) ||
                     (rules.exact_between_rapids_and_feeds && before.rapid != after.rapid);
  if (exact) return turn > flattest_stop<S> ? JunctionMode::stop : JunctionMode::exact;
  return turn > sharpest_smooth_turn<S> ? JunctionMode::stop : JunctionMode::smooth;
}

/// The limits of a block as it is programmed.
template <MachineModel M, BlockModel B>
[[nodiscard]] BasicLimits<typename M::Scalar> top_limits(const B& block, const M& machine) {
  using S = typename M::Scalar;
  return limits_along(block.path.bounds(S(0), block.path.length()), machine,
                      requested_speed(block, machine, length_of(block.path, machine)),
                      top_speed(block, machine));
}

/// The tolerances of a machine's axes.
template <MachineModel M>
[[nodiscard]] BasicAxisTolerances<typename M::Scalar, M::axis_count> axis_tolerances(
    const M& machine, const SmoothingRules<typename M::Scalar>& rules) {
  using S = typename M::Scalar;
  BasicAxisTolerances<S, M::axis_count> tolerances{.tool = tool_axes(machine)};
  const auto& tool = tolerances.tool;
  for (int i = 0; i < M::axis_count; ++i) {
    if (std::find(tool.begin(), tool.end(), i) != tool.end()) continue;
    const bool rotary = machine.axes[static_cast<std::size_t>(i)].kind == AxisKind::rotary;
    (rotary ? tolerances.per_angle : tolerances.linear)[i] = rotary ? S(1) / rules.rotary_tolerance : S(1);
  }
  return tolerances;
}

/// The jumps between two blocks that follow each other, of direction and of curvature, as far as that tells
/// what their corrections have to keep to; one that is only rounding is none. `at` is where the junction is,
/// `speed` what both blocks allow.
template <MachineModel M, BlockModel B>
[[nodiscard]] FixedList<BasicSizing<typename M::Scalar, M::axis_count>, 2> jumps_between(
    const B& before, const B& behind, LongLength<typename M::Scalar> at, typename M::Scalar speed,
    const M& machine) {
  using S = typename M::Scalar;
  using Sizing = BasicSizing<S, M::axis_count>;
  constexpr S rounding = S(64) * std::numeric_limits<S>::epsilon();
  constexpr S smallest = S(1e-3);  // mm: what is only rounding has the size of what is next to it
  const auto tool = tool_axes(machine);
  const Junction<M, B> junction(before, behind, tool);
  FixedList<Sizing, 2> jumps;
  const auto add = [&](Jump kind, const VectorN<S, M::axis_count>& step) {
    if (!(step.cwiseAbs().maxCoeff() > rounding)) return;
    Sizing sizing{.at = at, .jump = kind, .step = step, .wanted = smallest};
    const auto want = [&](S size, S acceleration, S jerk) {
      sizing.wanted = std::max(sizing.wanted, wanted_size(kind, size, speed, acceleration, jerk));
    };
    want(in_space(step, tool).norm(), machine.limits.acceleration, machine.limits.jerk);
    for (int i = 0; i < M::axis_count; ++i) {
      const auto& axis = machine.axes[static_cast<std::size_t>(i)];
      want(std::abs(step[i]), least_acceleration(axis), axis.jerk);
    }
    jumps.push_back(sizing);
  };
  add(Jump::direction, junction.direction);
  add(Jump::curvature, junction.curvature);
  return jumps;
}

/// What a junction has to know of a block beside it.
template <std::floating_point S>
struct BasicBeside {
  S length{};
  BasicLimits<S> limits;  ///< as it is programmed
};

/// Whether coming to rest at a corner takes less time than going round it: at the speed u at which its kernel
/// of length 4 w takes two fifths of the jerk J, with a ramp down to that and one up again. On each side,
/// from V to u at J a ramp loses sqrt((V - u) / J) (V - u) / V. V is what the block there has room for.
template <std::floating_point S, int N>
[[nodiscard]] bool faster_at_rest(const BasicSizing<S, N>& sizing, const BasicBeside<S>& before,
                                  const BasicBeside<S>& behind) {
  if (sizing.jump != Jump::direction || !(sizing.size < sizing.wanted)) return false;
  const S J = std::min(before.limits.jerk, behind.limits.jerk), w = sizing.size;
  const S highest = std::cbrt(S(0.6) * J * w * w / sizing.step.norm());
  S rest = S(0), round = S(0);
  for (const auto& [length, limits] : {before, behind}) {
    const S V = std::min(limits.velocity, std::cbrt(J * length * length / S(4)));
    const S u = std::min(V, highest);
    rest += std::sqrt(V / J);
    round += std::sqrt((V - u) / J) * (V - u) / V + S(2) * w * (S(1) / u - S(1) / V);
  }
  return rest < round;
}

}  // namespace cncplan::detail
