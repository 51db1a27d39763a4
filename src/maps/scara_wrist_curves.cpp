#include "maps/maps.hpp"

namespace cncplan {

CNCPLAN_PLAN_SMOOTH(, MappedMachine<kinematics::ScaraWrist>,
                    ProgramBlock<MappedMachine<kinematics::ScaraWrist>>)

}  // namespace cncplan
