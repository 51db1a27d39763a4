// Planning along blocks made by hand.
#include "cncplan/compiled.hpp"

namespace cncplan {

CNCPLAN_PLAN_BLOCKS(, Machine<3>, Block<3>)

}  // namespace cncplan
