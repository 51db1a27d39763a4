#include "plan_blocks.hpp"

namespace simulate {

template Plan plan_blocks(const Options&, const support::Machine&, const Table&, const Program<Table>&);

}  // namespace simulate
