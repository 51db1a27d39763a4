#include "instances/instances.hpp"

namespace cncplan {

CNCPLAN_PLANNED_MACHINE(, Machine<2>)
CNCPLAN_RUN_BLOCKS(, Machine<2>, ProgramBlock<Machine<2>>)

}  // namespace cncplan
