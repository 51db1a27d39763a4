// The tools of a dialect, as programs name them and set them: T, H, D, and G10 L1, L10 and L11.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>

#include "cncplan/gcode/block.hpp"
#include "cncplan/gcode/dialect.hpp"
#include "cncplan/gcode/modal.hpp"
#include "cncplan/gcode/work_coordinates.hpp"

namespace cncplan::gcode {

/// The entry of a tool; nullptr where the table has none.
[[nodiscard]] inline Tool* find_tool(Dialect& dialect, int number) {
  const auto found = std::find_if(dialect.tools.begin(), dialect.tools.end(),
                                  [number](const Tool& tool) { return tool.number == number; });
  return found == dialect.tools.end() ? nullptr : &*found;
}

/// The letter of the first word of a line that names a tool which the table lacks: T, H of G43 and G43.2, D
/// of G41 and G42, Q of M61. Tool 0 is none at all.
[[nodiscard]] inline std::optional<char> missing_tool(const Block& block, Dialect& dialect) {
  const Code length = block.code(Group::tool_length), radius = block.code(Group::compensation);
  Letters names = bit('T');
  if (length == code(43) || length == code(43.2)) names |= bit('H');
  if (radius == code(41) || radius == code(42)) names |= bit('D');
  if (block.code(Group::tool_change) == code(61)) names |= bit('Q');
  for (Letters left = names & block.letters(); left != 0;) {
    const char letter = block.first_in_text(left);
    left &= ~bit(letter);
    const int number = static_cast<int>(block.number(letter));
    if (number != 0 && find_tool(dialect, number) == nullptr) return letter;
  }
  return std::nullopt;
}

/// Whether a tool has an entry, or room for one without the heap.
[[nodiscard]] inline bool has_room_for(Dialect& dialect, int number) {
  return dialect.tools.size() < dialect.tools.capacity() || find_tool(dialect, number) != nullptr;
}

/// Sets what is given of a tool, mm or rad along the axes; `has_room_for` has said that it can.
inline void set_tool(Dialect& dialect, int number, const NamedCoordinates& offset,
                     std::optional<double> radius) {
  Tool* tool = find_tool(dialect, number);
  if (tool == nullptr) tool = &dialect.tools.emplace_back(Tool{.number = number});
  for (std::size_t i = 0; i < dialect.axes.size(); ++i)
    if (offset[i]) (dialect.axes[i].letter == 'Z' ? tool->length : tool->beside[i]) = *offset[i];
  if (radius) tool->diameter = 2.0 * *radius;
}

}  // namespace cncplan::gcode
