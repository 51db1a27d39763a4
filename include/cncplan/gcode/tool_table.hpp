// The tools of a dialect, as programs set them: G10 L1, L10 and L11.
#pragma once

#include <algorithm>
#include <optional>

#include "cncplan/gcode/dialect.hpp"

namespace cncplan::gcode {

/// The entry of a tool; nullptr where the table has none.
[[nodiscard]] inline Tool* find_tool(Dialect& dialect, int number) {
  const auto found = std::find_if(dialect.tools.begin(), dialect.tools.end(),
                                  [number](const Tool& tool) { return tool.number == number; });
  return found == dialect.tools.end() ? nullptr : &*found;
}

/// Whether a tool has an entry, or room for one without the heap.
[[nodiscard]] inline bool has_room_for(Dialect& dialect, int number) {
  return dialect.tools.size() < dialect.tools.capacity() || find_tool(dialect, number) != nullptr;
}

/// Sets what is given of a tool, mm; `has_room_for` has said that it can.
inline void set_tool(Dialect& dialect, int number, std::optional<double> length,
                     std::optional<double> radius) {
  Tool* tool = find_tool(dialect, number);
  if (tool == nullptr) tool = &dialect.tools.emplace_back(Tool{number, 0.0, 0.0});
  if (length) tool->length = *length;
  if (radius) tool->diameter = 2.0 * *radius;
}

}  // namespace cncplan::gcode
