#include "plan_blocks.hpp"

namespace simulate {

template Plan plan_blocks(const Options&, const support::Machine&, const Mill<6>&, const Program<Mill<6>>&);

}  // namespace simulate
