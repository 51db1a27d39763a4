// The levels good and best, for machines of AXES axes.
#include "cncplan/plan/smooth_blocks.hpp"
#include "planned.hpp"

extern template cncplan::Expected<
    cncplan::Trajectory<cncplan::Machine<AXES>, cncplan::ProgramBlock<cncplan::Machine<AXES>>>,
    cncplan::ProgramError>
cncplan::plan_blocks(std::span<const cncplan::ProgramBlock<cncplan::Machine<AXES>>>&&,
                     const cncplan::Machine<AXES>&, const cncplan::PlanOptions&, std::pmr::memory_resource*);

namespace cncplan::python {

template <>
PlannedOrError<AXES> plan_at<AXES>(SmoothLevel level, const std::vector<ReadBlock<AXES>>& blocks,
                                   const Machine<AXES>& machine, const PlanOptions& options,
                                   std::pmr::memory_resource* memory) {
  return plan_smooth(blocks, machine, options, level, memory);
}

}  // namespace cncplan::python
