#include "instances/instances.hpp"

namespace cncplan {

CNCPLAN_MACHINE(, Machine<5>)

}  // namespace cncplan
