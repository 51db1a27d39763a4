// Running blocks as they come in.
#include "cncplan/compiled.hpp"

namespace cncplan {

CNCPLAN_RUN_BLOCKS(, Machine<3>, Block<3>)
CNCPLAN_RUN_LEVELS(, Machine<3>, Block<3>)
CNCPLAN_RUN_BLOCKS(, Machine<6>, Block<6>)
CNCPLAN_RUN_LEVELS(, Machine<6>, Block<6>)

}  // namespace cncplan
