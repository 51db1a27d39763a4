// Speeds over cells of a curve, whatever machine they are planned for.
#include "cncplan/compiled/smooth.hpp"

namespace cncplan::detail {

CNCPLAN_PLAN_SPEED(, 1)
CNCPLAN_PLAN_SPEED(, 2)
CNCPLAN_PLAN_SPEED(, 3)
CNCPLAN_PLAN_SPEED(, 4)
CNCPLAN_PLAN_SPEED(, 5)
CNCPLAN_PLAN_SPEED(, 6)
CNCPLAN_PLAN_SPEED(, 7)
CNCPLAN_PLAN_SPEED(, 8)
CNCPLAN_PLAN_SPEED(, 9)

}  // namespace cncplan::detail
