// A run as the report that a browser shows.
#pragma once

#include "measures.hpp"
#include "options.hpp"
#include "plan.hpp"
#include "program.hpp"
#include "support/machine_file.hpp"
#include "support/report.hpp"

namespace simulate {

/// A plan as one of those of a report; how far it is from the programmed path at most, mm.
[[nodiscard]] report::Plan plan_of(const Options& options, const ProgramText& program, const Plan& plan,
                                   double deviation);

/// What there is to be seen of a run.
[[nodiscard]] report::Report html_report(const Options& options, const support::Machine& file,
                                         const ProgramText& program, const Measures& measures,
                                         const Plan& plan);

}  // namespace simulate
