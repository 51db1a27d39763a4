#include "instances/instances.hpp"

namespace cncplan {

CNCPLAN_PLANNED_MACHINE(, MappedMachine<test::Scara>)

}  // namespace cncplan
