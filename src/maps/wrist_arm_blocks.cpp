#include "maps/maps.hpp"

namespace cncplan {

CNCPLAN_PLAN_BLOCKS(, MappedMachine<kinematics::WristArm>, ProgramBlock<MappedMachine<kinematics::WristArm>>)

}  // namespace cncplan
