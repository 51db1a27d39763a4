// Planning at the levels good and best, on machines of 3 axes.
#include "cncplan/compiled.hpp"

namespace cncplan {

CNCPLAN_PLAN_SMOOTH(, Machine<3>, Block<3>)

}  // namespace cncplan
