#include "instances/instances.hpp"

namespace cncplan {

CNCPLAN_PLANNED_MACHINE(, Machine<1>)

}  // namespace cncplan
