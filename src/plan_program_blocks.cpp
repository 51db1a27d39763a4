// Planning along the blocks of programs.
#include "cncplan/compiled.hpp"

namespace cncplan {

CNCPLAN_PLAN_BLOCKS(, Machine<3>, ProgramBlock<Machine<3>>)

}  // namespace cncplan
