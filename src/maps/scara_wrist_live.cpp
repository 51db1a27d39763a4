#include "maps/maps.hpp"

namespace cncplan {

CNCPLAN_RUN_BLOCKS(, MappedMachine<kinematics::ScaraWrist>,
                   ProgramBlock<MappedMachine<kinematics::ScaraWrist>>)
CNCPLAN_RUN_LEVELS(, MappedMachine<kinematics::ScaraWrist>,
                   ProgramBlock<MappedMachine<kinematics::ScaraWrist>>)

}  // namespace cncplan
