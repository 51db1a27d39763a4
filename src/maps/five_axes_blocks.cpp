#include "maps/maps.hpp"

namespace cncplan {

CNCPLAN_PLAN_BLOCKS(, MappedMachine<kinematics::FiveAxes>, ProgramBlock<MappedMachine<kinematics::FiveAxes>>)

}  // namespace cncplan
