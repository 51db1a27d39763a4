// Plans a program block by block, as KK22 does (set-up).
#pragma once

#include <iterator>
#include <span>
#include <utility>
#include <vector>

#include "cncplan/plan_program.hpp"
#include "cncplan/published/block_planning.hpp"

namespace cncplan::published {

/// Plans a program on the exact path with one profile a block and zero acceleration at every junction, under
/// a policy for junctions and a law for changes of speed. Errors as for `cncplan::plan_program`.
template <MachineModel M, JunctionPolicy<typename M::Scalar> Policy,
          profile::RampLaw<typename M::Scalar> Law = profile::SevenPhase>
[[nodiscard]] Expected<Trajectory<M, ProgramBlock<M>>, ProgramError> plan_program(const Program<M>& program,
                                                                                  const M& machine,
                                                                                  const Policy& policy,
                                                                                  const Law& law = {}) {
  using S = typename M::Scalar;
  using B = ProgramBlock<M>;
  return detail::planned<M>(
      program, program.start(), false, [&]() -> Expected<Trajectory<M, B>, ProgramError> {
        if (const auto ok = validate(machine); !ok)
          return tl::unexpected(ProgramError{{ok.error(), 0, 0, {}}});
        std::pmr::vector<B> blocks(program.blocks().begin(), program.blocks().end());
        const std::span<const B> all(blocks);
        const detail::BasicJunctionRules<S> rules{policy, S(-1), S(-1)};
        const auto cells = detail::make_cells<WholeBlocks>(all, machine, rules);
        if (!cells) return tl::unexpected(detail::error_in(all, cells.error()));
        std::vector<detail::BasicSpan<S>> spans;
        std::vector<S> speeds(cells->segment_limits.size() + 1);
        const auto done = plan_blocks(std::span<const detail::BasicSegmentLimits<S>>(cells->segment_limits),
                                      law, std::span(speeds), std::back_inserter(spans));
        if (!done) return tl::unexpected(ProgramError{{done.error(), 0, 0, {}}});
        auto phases = detail::block_phases(std::span<const detail::BasicSpan<S>>(spans), *cells);
        return Trajectory<M, B>(machine, std::move(blocks), std::move(phases));
      });
}

}  // namespace cncplan::published
