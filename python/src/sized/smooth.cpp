// The levels good and best, for machines of AXES axes.
#include "cncplan/compiled.hpp"
#include "planned.hpp"

extern template cncplan::Expected<
    cncplan::Trajectory<cncplan::Machine<AXES>, cncplan::python::ReadBlock<AXES>>, cncplan::ProgramError>
cncplan::plan::plan_own_blocks(std::pmr::vector<cncplan::python::ReadBlock<AXES>>&&,
                               const cncplan::Machine<AXES>&, const cncplan::PlanOptions&);

namespace cncplan::python {

template <>
PlannedOrError<AXES> plan_at<AXES>(SmoothLevel level, const std::vector<ReadBlock<AXES>>& blocks,
                                   const Machine<AXES>& machine, const PlanOptions& options,
                                   std::pmr::memory_resource* memory) {
  return plan_smooth(blocks, machine, options, level, memory);
}

}  // namespace cncplan::python
