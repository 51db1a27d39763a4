// Planning along blocks made by hand at the levels good and best.
#include "cncplan/compiled.hpp"

namespace cncplan {

CNCPLAN_PLAN_SMOOTH(, Machine<3>, Block<3>)

}  // namespace cncplan
