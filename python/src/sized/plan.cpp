// Planning by look-ahead, and trajectories, for machines of AXES axes.
#include "planner.hpp"

namespace cncplan {

CNCPLAN_PLAN_BLOCKS(, Machine<AXES>, ProgramBlock<Machine<AXES>>)
CNCPLAN_PLAN_LOOK_AHEAD(, Machine<AXES>, ProgramBlock<Machine<AXES>>)

}  // namespace cncplan
