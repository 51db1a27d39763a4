// Smoothing of runs on machines without a map.
#include "cncplan/compiled/smooth.hpp"

namespace cncplan::detail {

CNCPLAN_SMOOTH_RUNS(, 3)
CNCPLAN_SMOOTH_RUNS(, 4)
CNCPLAN_SMOOTH_RUNS(, 6)

}  // namespace cncplan::detail
