// G-code in, G-code out: mirrors a program in X. Arcs turn the other way round; all else stays as it is.
#include <cncplan/gcode/lines.hpp>
#include <cncplan/gcode/read_program.hpp>
#include <cncplan/gcode/writer.hpp>
#include <iostream>
#include <iterator>
#include <variant>

using namespace cncplan;

namespace {

constexpr std::string_view text = R"(G21 G90 G17
G0 X10 Y5 (above the pocket)
M3 S8000
G1 Z-2 F300
G1 X40
G3 X45 Y10 R5
G1 Y30
M30
)";

gcode::Item mirrored(gcode::Item item) {
  if (auto* motion = std::get_if<gcode::Motion>(&item)) {
    motion->start[0] = -motion->start[0];
    motion->end[0] = -motion->end[0];
    motion->center.x() = -motion->center.x();
    if (motion->plane != Plane::yz)
      motion->turn = motion->turn == Turn::clockwise ? Turn::counterclockwise : Turn::clockwise;
  }
  return item;
}

}  // namespace

int main() {
  const std::ostreambuf_iterator<char> out(std::cout);
  gcode::Reader reader;
  gcode::Writer writer;
  bool written = true;
  const auto read = gcode::read_program(gcode::TextLines(text), reader, [&](const gcode::Item& item) {
    return written = writer.write(mirrored(item), out).has_value();
  });
  writer.finish(out);
  return read && written ? 0 : 1;
}
