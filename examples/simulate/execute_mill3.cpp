#include "execute_program.hpp"

namespace simulate {

template int execute(const Options&, const support::Machine&, const Mill<3>&);

}  // namespace simulate
