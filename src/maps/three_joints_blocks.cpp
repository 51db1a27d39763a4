#include "maps/maps.hpp"

namespace cncplan {

CNCPLAN_PLAN_BLOCKS(, MappedMachine<kinematics::ThreeJoints>,
                    ProgramBlock<MappedMachine<kinematics::ThreeJoints>>)

}  // namespace cncplan
