#include "maps/maps.hpp"

namespace cncplan {

CNCPLAN_PLAN_SMOOTH(, MappedMachine<kinematics::ThreeJoints>,
                    ProgramBlock<MappedMachine<kinematics::ThreeJoints>>)

}  // namespace cncplan
