#include "plan_of.hpp"

namespace simulate {

template Plan plan(const Options&, const support::Machine&, const Rows&, const Program<Rows>&);

}  // namespace simulate
