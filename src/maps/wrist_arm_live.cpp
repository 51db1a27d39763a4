#include "maps/maps.hpp"

namespace cncplan {

CNCPLAN_RUN_BLOCKS(, MappedMachine<kinematics::WristArm>, ProgramBlock<MappedMachine<kinematics::WristArm>>)
CNCPLAN_RUN_LEVELS(, MappedMachine<kinematics::WristArm>, ProgramBlock<MappedMachine<kinematics::WristArm>>)

}  // namespace cncplan
