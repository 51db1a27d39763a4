// Smoothing of curves of 4 and 5 coordinates, whatever path they come from.
#include "cncplan/compiled/smooth.hpp"

namespace cncplan::detail {

CNCPLAN_SMOOTH_CURVES(, 4)
CNCPLAN_SMOOTH_CURVES(, 5)

}  // namespace cncplan::detail
