#include "maps/maps.hpp"

namespace cncplan {

CNCPLAN_MAPPED_LIVE(, MappedMachine<kinematics::FiveAxes>)

}  // namespace cncplan
