// Trajectories of blocks.
#include "cncplan/compiled.hpp"

namespace cncplan {

CNCPLAN_PLAN_BLOCKS(, Machine<3>, Block<3>)
CNCPLAN_PLAN_BLOCKS(, Machine<6>, Block<6>)

}  // namespace cncplan
