#include "plan_of.hpp"

namespace simulate {

template Plan plan(const Options&, const support::Machine&, const Table&, const Program<Table>&);

}  // namespace simulate
