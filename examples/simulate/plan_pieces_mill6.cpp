#include "plan_pieces.hpp"

namespace simulate {

template Plan plan_pieces(const Options&, const support::Machine&, const Mill<6>&, const Program<Mill<6>>&);

}  // namespace simulate
