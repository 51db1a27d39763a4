// The summary of a run: JSON for programs, a table for people.
#pragma once

#include <string>

#include "run.hpp"

namespace simulate {

[[nodiscard]] std::string json_summary(const Program& program, const Plan& plan, const Options& options,
                                       const Machine& machine, const Measures& measures);
[[nodiscard]] std::string table_summary(const Program& program, const Plan& plan, const Machine& machine,
                                        const Measures& measures);

}  // namespace simulate
