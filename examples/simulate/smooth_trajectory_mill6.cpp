#include "smooth_trajectory_of.hpp"

namespace simulate {

template cncplan::Expected<Pieces<6>, cncplan::ProgramError> smooth_trajectory<6>(const Options&,
                                                                                  const Mill<6>&,
                                                                                  const Program<Mill<6>>&);

}  // namespace simulate
