// Planning at the levels good and best, for machines of AXES axes.
#include "planner.hpp"

namespace cncplan {

CNCPLAN_PLAN_SMOOTH(, Machine<AXES>, ProgramBlock<Machine<AXES>>)

}  // namespace cncplan
