// Whole programs planned in one call, in containers (set-up).
#pragma once

#include <concepts>
#include <cstddef>
#include <iterator>
#include <span>
#include <type_traits>
#include <vector>

#include "cncplan/plan/caps.hpp"
#include "cncplan/plan/joint/caps.hpp"
#include "cncplan/plan/laws.hpp"
#include "cncplan/plan/span_planner.hpp"

namespace cncplan::plan {

/// A planned program: what `Sampler`, `Timeline` and `Cursor` walk along.
template <std::floating_point S>
struct BasicPlan {
  std::vector<BasicSpan<S>> spans;
  std::vector<S> lengths;  ///< of each block, mm
  S duration{};            ///< s
};

using Plan = BasicPlan<double>;

/// The plan of blocks that are known by their caps, from rest to rest. Errors: those of `validate` for the
/// limits of each block, and those of profiles.
template <std::floating_point S, RampLaw<S> Law = SevenPhase>
[[nodiscard]] Expected<BasicPlan<S>> whole_plan(const std::vector<BasicBlockCaps<S>>& caps,
                                                const Law& law = {}) {
  for (const BasicBlockCaps<S>& block : caps)
    if (const auto ok = validate(block.limits); !ok) return tl::unexpected(ok.error());
  BasicPlan<S> plan;
  std::vector<BasicGate<S>> gates(caps.size() + 1);
  const auto planned = plan_spans(std::span<const BasicBlockCaps<S>>(caps), law, std::span(gates),
                                  std::back_inserter(plan.spans));
  if (!planned) return tl::unexpected(planned.error());
  for (const BasicBlockCaps<S>& block : caps) plan.lengths.push_back(block.length);
  plan.duration = duration(std::span<const BasicSpan<S>>(plan.spans));
  return plan;
}

/// The caps of a program of blocks: their junctions by a policy, their curves by a rule.
template <std::floating_point S, JunctionPolicy<S> Policy, CurveRule<S> Rule = ShareLimits>
[[nodiscard]] std::vector<BasicBlockCaps<S>> all_caps(const std::vector<BasicBlock<S>>& blocks,
                                                      const Policy& policy, const Rule& rule = {}) {
  std::vector<BasicBlockCaps<S>> all;
  all.reserve(blocks.size());
  for (std::size_t i = 0; i < blocks.size(); ++i)
    all.push_back(i == 0 ? caps_from_rest(blocks[i], rule) : caps(blocks[i - 1], blocks[i], policy, rule));
  return all;
}

/// The plan of a program of blocks, by `all_caps`.
template <std::floating_point S, JunctionPolicy<S> Policy, CurveRule<S> Rule = ShareLimits,
          RampLaw<S> Law = SevenPhase>
[[nodiscard]] Expected<BasicPlan<S>> whole_plan(const std::vector<BasicBlock<S>>& blocks,
                                                const Policy& policy, const Rule& rule = {},
                                                const Law& law = {}) {
  return whole_plan(all_caps(blocks, policy, rule), law);
}

/// The plan of a program in machine space, within the limits of its joints; see `joint_caps`.
/// Errors: those of `validate` for the joints' limits, and of the plan.
template <JointPath P, RampLaw<typename P::Scalar> Law = SevenPhase>
[[nodiscard]] Expected<BasicPlan<typename P::Scalar>> whole_plan(
    const std::vector<JointBlock<P>>& blocks,
    const BasicJointLimits<typename P::Scalar, P::Vector::RowsAtCompileTime>& joints,
    std::type_identity_t<typename P::Scalar> corner_time, const Law& law = {}) {
  if (const auto ok = validate(joints); !ok) return tl::unexpected(ok.error());
  std::vector<BasicBlockCaps<typename P::Scalar>> caps;
  joint_caps(std::span<const JointBlock<P>>(blocks), joints, corner_time, std::back_inserter(caps));
  return whole_plan(caps, law);
}

}  // namespace cncplan::plan
