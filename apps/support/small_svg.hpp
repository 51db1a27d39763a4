// Less text for the same picture.
#pragma once

#include <string>
#include <string_view>

namespace support {

/// A picture of gnuplot's SVG terminal without its empty groups, with coordinates to 0.1 px, without points
/// of lines that lie within 0.1 px of the straight way between their neighbours, and with dots of one colour
/// as one path.
[[nodiscard]] std::string small_svg(std::string_view svg);

}  // namespace support
