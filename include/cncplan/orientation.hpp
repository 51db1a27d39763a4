// How the tool turns along a line of tool-point control.
#pragma once

#include <cstdint>

namespace cncplan {

/// Between the ends of a line under tool-point control (G43.4, G43.5, M428): the rotary axes turn in
/// proportion to the tip's way (Siemens: ORIAXES), or the tool's direction in the part goes along the great
/// circle from the one to the other, at a constant rate by the tip's way (large-circle or vector
/// interpolation, ORIVECT).
enum class Orientation : std::uint8_t { joints, great_circle };

}  // namespace cncplan
