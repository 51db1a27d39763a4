// The summary of a run: JSON for programs, a table for people.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "measures.hpp"
#include "options.hpp"
#include "support/machine_file.hpp"

namespace simulate {

[[nodiscard]] std::string json_summary(const ProgramText& program, const Options& options,
                                       const support::Machine& machine, const Measures& measures);
/// Names and values of what was measured of the whole run, in order.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> summary_rows(const ProgramText& program,
                                                                            const Options& options,
                                                                            const Measures& measures);
/// These, and a row for each axis.
[[nodiscard]] std::string table_summary(const ProgramText& program, const Options& options,
                                        const support::Machine& machine, const Measures& measures);

}  // namespace simulate
