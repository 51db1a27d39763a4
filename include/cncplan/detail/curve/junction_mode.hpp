// How motion passes from one block to the next.
#pragma once

#include "cncplan/core/compiler.hpp"

#include <cstdint>

namespace cncplan::detail {

/// How the motion passes the start of a block: at rest; on the exact path, as fast as a junction policy
/// allows; or without a jump of velocity or acceleration, as fast as the bends allow.
enum class JunctionMode : std::uint8_t { stop, exact, smooth };

}  // namespace cncplan::detail
