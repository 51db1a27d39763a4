#include "maps/maps.hpp"

namespace cncplan {

CNCPLAN_PLAN_LOOK_AHEAD(, MappedMachine<kinematics::ThreeJoints>,
                        ProgramBlock<MappedMachine<kinematics::ThreeJoints>>)
CNCPLAN_PLAN_PROGRAM(, MappedMachine<kinematics::ThreeJoints>)

}  // namespace cncplan
