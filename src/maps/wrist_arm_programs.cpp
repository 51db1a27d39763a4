#include "maps/maps.hpp"

namespace cncplan {

CNCPLAN_PLAN_LOOK_AHEAD(, MappedMachine<kinematics::WristArm>,
                        ProgramBlock<MappedMachine<kinematics::WristArm>>)
CNCPLAN_PLAN_PROGRAM(, MappedMachine<kinematics::WristArm>)

}  // namespace cncplan
