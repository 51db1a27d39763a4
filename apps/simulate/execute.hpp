// A program read, checked, planned and written out on one kind of machine.
#pragma once

#include "options.hpp"
#include "support/machine_file.hpp"

namespace simulate {

/// Does what the options ask for; the exit code of the program. Defined for each kind of machine in a file of
/// its own, as each takes long to compile. Throws `Failure`.
template <class M>
int execute(const Options& options, const support::Machine& file, const M& machine);

}  // namespace simulate
