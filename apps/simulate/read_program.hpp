// Reads a G-code file into blocks that can be planned.
#pragma once

#include <string>

#include "options.hpp"
#include "problems.hpp"
#include "program_blocks.hpp"
#include "support/machine_file.hpp"

namespace simulate {

/// All of the program that the options name, of standard input where it is that. Throws `Failure` for a file
/// that cannot be read.
[[nodiscard]] std::string program_text(const Options& options);

/// Reads a program; warnings go to standard error. Text that is not understood and motions that cannot be
/// made or leave the machine's travel are problems: the program cannot be run where there is one.
template <class M>
[[nodiscard]] Program<M> read_program(const Options& options, const support::Machine& file, const M& machine,
                                      Problems& problems);

}  // namespace simulate
