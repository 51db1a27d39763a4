#include "mapped_motion_of.hpp"

namespace simulate {

template std::unique_ptr<Planned> mapped_motion(const support::Machine&,
                                                MappedTrajectory<cncplan::kinematics::ThreeJoints>&&);

}  // namespace simulate
