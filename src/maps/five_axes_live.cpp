#include "maps/maps.hpp"

namespace cncplan {

CNCPLAN_RUN_BLOCKS(, MappedMachine<kinematics::FiveAxes>, ProgramBlock<MappedMachine<kinematics::FiveAxes>>)
CNCPLAN_RUN_LEVELS(, MappedMachine<kinematics::FiveAxes>, ProgramBlock<MappedMachine<kinematics::FiveAxes>>)

}  // namespace cncplan
