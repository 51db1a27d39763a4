#include "plan_blocks.hpp"

namespace simulate {

template Plan plan_blocks(const Options&, const support::Machine&, const Mill<3>&, const Program<Mill<3>>&);

}  // namespace simulate
