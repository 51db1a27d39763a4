#include "instances/instances.hpp"

namespace cncplan {

CNCPLAN_MACHINE(, Machine<2>)

}  // namespace cncplan
