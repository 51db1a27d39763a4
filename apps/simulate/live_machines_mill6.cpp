#include "live_machines.hpp"

namespace simulate {

template serve::LiveRun::Fresh live_machines(const Options&, const support::Machine&, const Mill<6>&,
                                             const Program<Mill<6>>&);

}  // namespace simulate
