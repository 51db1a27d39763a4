#include "maps/maps.hpp"

namespace cncplan {

CNCPLAN_MAPPED_LIVE(, MappedMachine<kinematics::WristArm>)

}  // namespace cncplan
