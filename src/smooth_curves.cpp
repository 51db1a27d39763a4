// Smoothing of curves, whatever path they come from.
#include "cncplan/compiled/smooth.hpp"

namespace cncplan::detail {

CNCPLAN_SMOOTH_CURVES(, 3)
CNCPLAN_SMOOTH_CURVES(, 6)

}  // namespace cncplan::detail
