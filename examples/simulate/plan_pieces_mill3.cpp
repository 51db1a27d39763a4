#include "plan_pieces.hpp"

namespace simulate {

template Plan plan_pieces(const Options&, const support::Machine&, const Mill<3>&, const Program<Mill<3>>&);

}  // namespace simulate
