#include "instances/instances.hpp"

namespace cncplan {

CNCPLAN_MACHINE(, Machine<1>)

}  // namespace cncplan
