// Planning along the blocks of programs at the levels good and best.
#include "cncplan/compiled.hpp"

namespace cncplan {

CNCPLAN_PLAN_SMOOTH(, Machine<3>, ProgramBlock<Machine<3>>)

}  // namespace cncplan
