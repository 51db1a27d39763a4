#include "maps/maps.hpp"

namespace cncplan {

CNCPLAN_PLAN_LOOK_AHEAD(, MappedMachine<kinematics::FiveAxes>,
                        ProgramBlock<MappedMachine<kinematics::FiveAxes>>)
CNCPLAN_PLAN_PROGRAM(, MappedMachine<kinematics::FiveAxes>)

}  // namespace cncplan
