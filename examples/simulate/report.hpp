// The summary of a run: JSON for programs, a table for people.
#pragma once

#include <string>

#include "measures.hpp"
#include "options.hpp"
#include "support/machine_file.hpp"

namespace simulate {

[[nodiscard]] std::string json_summary(const ProgramText& program, const Options& options,
                                       const support::Machine& machine, const Measures& measures);
[[nodiscard]] std::string table_summary(const ProgramText& program, const support::Machine& machine,
                                        const Measures& measures);

}  // namespace simulate
