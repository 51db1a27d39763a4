// The mapped artwork as the report that a browser shows.
#pragma once

#include "conversion.hpp"
#include "machine.hpp"
#include "motion.hpp"
#include "options.hpp"
#include "report.hpp"
#include "support/report.hpp"

namespace tire_mold {

/// The tip over the wall, and the axes of the machine; the flat artwork above it.
[[nodiscard]] report::Report html_report(const Options& options,
                                         const cncplan::kinematics::Sidewall& sidewall,
                                         const Conversion& conversion, const Motion& motion,
                                         const Machine& machine, const Measures& measures);

}  // namespace tire_mold
