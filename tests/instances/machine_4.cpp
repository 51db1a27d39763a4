#include "instances/instances.hpp"

namespace cncplan {

CNCPLAN_MACHINE(, Machine<4>)

}  // namespace cncplan
