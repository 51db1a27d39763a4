// Planning by look-ahead, for machines of SIZE axes.
#include "planner.hpp"

namespace cncplan {

CNCPLAN_PLAN_LOOK_AHEAD(, Machine<SIZE>, ProgramBlock<Machine<SIZE>>)

}  // namespace cncplan
