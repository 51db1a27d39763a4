#include "live_machines.hpp"

namespace simulate {

template serve::LiveRun::Fresh live_machines(const Options&, const support::Machine&, const Mill<3>&,
                                             const Program<Mill<3>>&);

}  // namespace simulate
