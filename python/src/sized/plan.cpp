// Planning by look-ahead, and trajectories, for machines of SIZE axes.
#include "planner.hpp"

namespace cncplan {

CNCPLAN_PLAN_BLOCKS(, Machine<SIZE>, ProgramBlock<Machine<SIZE>>)
CNCPLAN_PLAN_LOOK_AHEAD(, Machine<SIZE>, ProgramBlock<Machine<SIZE>>)

}  // namespace cncplan
