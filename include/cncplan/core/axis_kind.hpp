// What an axis of a machine does: it slides or it turns.
#pragma once

#include <cstdint>

#include "cncplan/core/compiler.hpp"

namespace cncplan {

/// Positions of a linear axis are mm, those of a rotary one rad.
enum class AxisKind : std::uint8_t { linear, rotary };

}  // namespace cncplan
