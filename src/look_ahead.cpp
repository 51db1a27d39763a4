// Planning by look-ahead.
#include "cncplan/compiled.hpp"

namespace cncplan {

CNCPLAN_PLAN_LOOK_AHEAD(, Machine<3>, Block<3>)
CNCPLAN_PLAN_LOOK_AHEAD(, Machine<6>, Block<6>)

}  // namespace cncplan
