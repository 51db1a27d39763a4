// The levels exact and fast, for machines of AXES axes.
#include "cncplan/compiled.hpp"
#include "planned.hpp"

namespace cncplan::python {

using Fast = Expected<Trajectory<Machine<AXES>, ReadBlock<AXES>>, ProgramError>;

template <>
PlannedOrError<AXES> plan_fast<AXES>(std::vector<ReadBlock<AXES>>&& blocks, const Machine<AXES>& machine,
                                     const PlanOptions& options, std::pmr::memory_resource* memory) {
  Fast planned = plan_blocks(std::span<const ReadBlock<AXES>>(blocks), machine, options, memory);
  if (!planned) return tl::unexpected(planned.error());
  std::pmr::vector<PlannedBlock<AXES>> own(memory);
  own.reserve(planned->program().size());
  for (const auto& block : planned->program()) own.push_back({block, own.size()});
  std::pmr::vector<Planned<AXES>::Phase> phases(planned->phases().begin(), planned->phases().end(), memory);
  Planned<AXES>::Smoothing smoothing(memory);
  smoothing.corrections.assign(planned->smoothing().corrections.begin(),
                               planned->smoothing().corrections.end());
  smoothing.blocks.assign(planned->smoothing().blocks.begin(), planned->smoothing().blocks.end());
  return Planned<AXES>(machine, std::move(own), std::move(phases), std::move(smoothing));
}

}  // namespace cncplan::python

// `plan_at` plans what it cannot smooth in this way.
#if !defined(CNCPLAN_COMPILED) || AXES != 3
template cncplan::python::Fast cncplan::plan::plan_own_blocks(
    std::pmr::vector<cncplan::python::ReadBlock<AXES>>&&, const cncplan::Machine<AXES>&,
    const cncplan::PlanOptions&);
#endif
