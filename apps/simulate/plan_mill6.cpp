#include "plan_of.hpp"

namespace simulate {

template Plan plan(const Options&, const support::Machine&, const Mill<6>&, const Program<Mill<6>>&);

}  // namespace simulate
