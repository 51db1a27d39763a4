// Planning at the levels good and best, on machines of 6 axes.
#include "cncplan/compiled.hpp"

namespace cncplan {

CNCPLAN_PLAN_SMOOTH(, Machine<6>, Block<6>)

}  // namespace cncplan
