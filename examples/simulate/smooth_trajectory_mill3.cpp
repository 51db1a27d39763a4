#include "smooth_trajectory_of.hpp"

namespace simulate {

template cncplan::Expected<Pieces<3>, cncplan::ProgramError> smooth_trajectory<3>(const Options&,
                                                                                  const Mill<3>&,
                                                                                  const Program<Mill<3>>&);

}  // namespace simulate
