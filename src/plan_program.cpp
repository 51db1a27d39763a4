// Programs from texts and files.
#include "cncplan/compiled.hpp"

namespace cncplan {

CNCPLAN_READ_BLOCKS(, Machine<3>)
CNCPLAN_READ_BLOCKS(, Machine<6>)
CNCPLAN_PLAN_PROGRAM(, Machine<3>)
CNCPLAN_PLAN_PROGRAM(, Machine<6>)

}  // namespace cncplan
