// Smoothing of curves of 3 and 6 coordinates, whatever path they come from.
#include "cncplan/compiled/smooth.hpp"

namespace cncplan::detail {

CNCPLAN_SMOOTH_CURVES(, 3)
CNCPLAN_SMOOTH_CURVES(, 6)

}  // namespace cncplan::detail
