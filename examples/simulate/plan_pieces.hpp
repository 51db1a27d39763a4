// What `plan_pieces` does, for the files that define it for one kind of machine each.
#pragma once

#include <memory>
#include <utility>

#include "plan.hpp"
#include "planned_on.hpp"
#include "smooth_trajectory.hpp"
#include "support/failure.hpp"

namespace simulate {

template <int N>
Plan plan_pieces(const Options& options, const support::Machine& file, const Mill<N>& machine,
                 const Program<Mill<N>>& program) {
  Plan result;
  auto planned = smooth_trajectory<N>(options, machine, program);
  if (!planned) {
    auto error = planned.error();
    error.file = program.file;
    throw support::Failure(support::Exit::bad_input, cncplan::to_text(error));
  }
  const auto blocks = planned->program();
  for (const cncplan::Fallback& part : planned->fallbacks())
    result.other_levels.push_back({blocks[part.first].line, blocks[part.last].line, cncplan::name(part.level),
                                   cncplan::text(part.reason)});
  for (const auto& piece : blocks) result.motion_of.push_back(program.motion_of[piece.source]);
  result.motion = std::make_unique<PlannedOn<Mill<N>, typename Pieces<N>::Block>>(file, std::move(*planned));
  return result;
}

}  // namespace simulate
