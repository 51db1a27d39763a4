// The tools of a dialect, as programs name them and set them: T, H, D, and G10 L1, L10 and L11.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>

#include "cncplan/core/compiled.hpp"
#include "cncplan/gcode/detail/block.hpp"
#include "cncplan/gcode/detail/modal.hpp"
#include "cncplan/gcode/dialect.hpp"
#include "cncplan/gcode/work_coordinates.hpp"

namespace cncplan::gcode {

/// The entry of a tool; nullptr where the table has none.
[[nodiscard]] Tool* find_tool(Dialect& dialect, int number);

/// The letter of the first word of a line that names a tool which the table lacks: T, H of G43 and G43.2, D
/// of G41 and G42, Q of M61. Tool 0 is none at all.
[[nodiscard]] std::optional<char> missing_tool(const Block& block, Dialect& dialect);

/// Whether a tool has an entry, or room for one without the heap.
[[nodiscard]] inline bool has_room_for(Dialect& dialect, int number) {
  return dialect.tools.size() < dialect.tools.capacity() || find_tool(dialect, number) != nullptr;
}

/// Sets what is given of a tool, mm or rad along the axes; `has_room_for` has said that it can.
void set_tool(Dialect& dialect, int number, const NamedCoordinates& offset, std::optional<double> radius);

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/tool_table-inl.hpp"
#endif
