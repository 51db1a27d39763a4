// From blocks to a trajectory, and what it answers, for machines of SIZE axes.
#include "planner.hpp"

namespace cncplan {

CNCPLAN_PLAN_BLOCKS(, Machine<SIZE>, ProgramBlock<Machine<SIZE>>)

}  // namespace cncplan
