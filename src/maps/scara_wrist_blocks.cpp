#include "maps/maps.hpp"

namespace cncplan {

CNCPLAN_PLAN_BLOCKS(, MappedMachine<kinematics::ScaraWrist>,
                    ProgramBlock<MappedMachine<kinematics::ScaraWrist>>)

}  // namespace cncplan
