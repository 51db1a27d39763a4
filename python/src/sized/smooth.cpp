// Planning at the levels good and best, for machines of SIZE axes.
#include "planner.hpp"

namespace cncplan {

CNCPLAN_PLAN_SMOOTH(, Machine<SIZE>, ProgramBlock<Machine<SIZE>>)

}  // namespace cncplan
