#include "instances/instances.hpp"

namespace cncplan {

CNCPLAN_PLANNED_MACHINE(, Machine<5>)

}  // namespace cncplan
