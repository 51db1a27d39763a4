// What comes behind a part of a trajectory that a clock drives.
#pragma once

#include <cstdint>

namespace cncplan::detail {

/// What comes behind a part.
enum class PartLink : std::uint8_t {
  rest,      ///< it ends at rest, and there is nothing yet
  open,      ///< it ends at a speed: the tail, if nothing comes
  next,      ///< the next part
  tail,      ///< the tail, which is driven, and nothing yet
  tail_next  ///< the tail, and then the next part
};

}  // namespace cncplan::detail
