#include "maps/maps.hpp"

namespace cncplan {

CNCPLAN_PLAN_LOOK_AHEAD(, MappedMachine<kinematics::ScaraWrist>,
                        ProgramBlock<MappedMachine<kinematics::ScaraWrist>>)
CNCPLAN_PLAN_PROGRAM(, MappedMachine<kinematics::ScaraWrist>)

}  // namespace cncplan
