// Definitions of warnings.hpp.
#pragma once

#include "cncplan/gcode/warnings.hpp"

namespace cncplan::gcode {

CNCPLAN_INLINE bool Warnings::first(bool& told) {
  const bool is = !told;
  told = true;
  return is;
}

CNCPLAN_INLINE bool Warnings::first_of_group(Group group) {
  const std::uint32_t mark = 1U << static_cast<unsigned>(group);
  const bool is = (groups_ & mark) == 0;
  groups_ |= mark;
  return is;
}

}  // namespace cncplan::gcode
