#include "plan_of.hpp"

namespace simulate {

template Plan plan(const Options&, const support::Machine&, const Mill<3>&, const Program<Mill<3>>&);

}  // namespace simulate
