// Programs from texts and files.
#include "cncplan/compiled.hpp"

namespace cncplan {

CNCPLAN_PLAN_PROGRAM(, Machine<3>)

}  // namespace cncplan
