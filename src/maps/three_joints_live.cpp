#include "maps/maps.hpp"

namespace cncplan {

CNCPLAN_RUN_BLOCKS(, MappedMachine<kinematics::ThreeJoints>,
                   ProgramBlock<MappedMachine<kinematics::ThreeJoints>>)
CNCPLAN_RUN_LEVELS(, MappedMachine<kinematics::ThreeJoints>,
                   ProgramBlock<MappedMachine<kinematics::ThreeJoints>>)

}  // namespace cncplan
