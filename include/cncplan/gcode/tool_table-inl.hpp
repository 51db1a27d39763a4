// Definitions of tool_table.hpp.
#pragma once

#include "cncplan/gcode/tool_table.hpp"

namespace cncplan::gcode {

CNCPLAN_INLINE Tool* find_tool(Dialect& dialect, int number) {
  const auto found = std::find_if(dialect.tools.begin(), dialect.tools.end(),
                                  [number](const Tool& tool) { return tool.number == number; });
  return found == dialect.tools.end() ? nullptr : &*found;
}

CNCPLAN_INLINE std::optional<char> missing_tool(const Block& block, Dialect& dialect) {
  const Code length = block.code(Group::tool_length), radius = block.code(Group::compensation);
  Letters names = bit('T');
  if (length == code(43) || length == code(43.2) || length == code(43.4) || length == code(43.5))
    names |= bit('H');
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

CNCPLAN_INLINE void set_tool(Dialect& dialect, int number, const NamedCoordinates& offset,
                             std::optional<double> radius) {
  Tool* tool = find_tool(dialect, number);
  if (tool == nullptr) tool = &dialect.tools.emplace_back(Tool{.number = number});
  for (std::size_t i = 0; i < dialect.axes.size(); ++i)
    if (offset[i]) (dialect.axes[i].letter == 'Z' ? tool->length : tool->beside[i]) = *offset[i];
  if (radius) tool->diameter = 2.0 * *radius;
}

}  // namespace cncplan::gcode
