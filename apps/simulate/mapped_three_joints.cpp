#include "run_on_map.hpp"

namespace simulate {

template int run_on_map(const Options&, const support::Machine&, const std::string&,
                        const cncplan::kinematics::ThreeJoints&);

}  // namespace simulate
