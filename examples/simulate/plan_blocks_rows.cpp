#include "plan_blocks.hpp"

namespace simulate {

template Plan plan_blocks(const Options&, const support::Machine&, const Rows&, const Program<Rows>&);

}  // namespace simulate
