// Machine files that name their kinematics.
#pragma once

#include "options.hpp"
#include "support/machine_file.hpp"

namespace simulate {

/// Runs a program on the machine that a file names. Options that do not go with
/// maps are refused by name. Throws `Failure`.
int run_mapped(const Options& options, const support::Machine& file);

}  // namespace simulate
