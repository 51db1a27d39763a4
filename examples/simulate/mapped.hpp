// Machine files that name their kinematics.
#pragma once

#include "options.hpp"
#include "support/machine_file.hpp"

namespace simulate {

/// Runs a program on the machine that a file names. Of the options, those for the plan, the samples and the
/// summary go; another one is refused by name. Throws `Failure`.
int run_mapped(const Options& options, const support::Machine& file);

}  // namespace simulate
