// What comes of a run, whatever its machine: files, pictures and the summary.
#pragma once

#include <functional>

#include "options.hpp"
#include "plan.hpp"
#include "program.hpp"
#include "support/machine_file.hpp"

namespace simulate {

/// Plans a program as options say.
using PlanAs = std::function<Plan(const Options&)>;

/// Plans, makes samples and steps as far as they are wanted, and writes all that the options ask for. The
/// exit code of the program. Throws `Failure`.
int write_outputs(const Options& options, const support::Machine& file, const ProgramText& program,
                  const PlanAs& plan_as);

}  // namespace simulate
