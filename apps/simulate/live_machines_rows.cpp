#include "live_machines.hpp"

namespace simulate {

template serve::LiveRun::Fresh live_machines(const Options&, const support::Machine&, const Rows&,
                                             const Program<Rows>&);

}  // namespace simulate
