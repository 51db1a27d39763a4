#include "cncplan/gcode/subprograms.hpp"

#include <string>

#include "gcode/support.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

/// Line and X of every motion, and the error.
std::string run(std::string_view text) {
  std::string all;
  gcode::Reader reader;
  gcode::SubprogramLines lines(text);
  const auto done = gcode::read_program(lines, reader, [&](const gcode::Item& item) {
    if (const auto* motion = std::get_if<gcode::Motion>(&item))
      all.append(std::to_string(motion->line))
          .append(1, ':')
          .append(std::to_string(static_cast<int>(motion->end[0])))
          .append(1, ' ');
  });
  if (!done)
    all.append(std::to_string(done.error().line)).append(1, ' ').append(gcode::to_text(done.error()));
  return all;
}

}  // namespace

TEST_CASE("a subprogram runs where it is called, and its lines keep their numbers") {
  CHECK(run("O1\nG91 G0 X1\nN5 M98 P7 (twice) L2\nX1\nM30\nO7\nX10\nM99\n") == "2:1 7:11 7:21 4:22 ");
  CHECK(run("G91 G0 X1\nM98 P20007\nX1\nM30\nO0007\nX10\nM99\n") == "1:1 6:11 6:21 3:22 ");
}

TEST_CASE("a subprogram may call others") {
  CHECK(run("G91 G0\nM98 P1\nM2\nO1\nX1\nM98 P2 L2\nX1\nM99\nO2\nX10\nM99\n") == "5:1 10:11 10:21 7:22 ");
}

TEST_CASE("M99 in the main program ends it") { CHECK(run("G0 X1\nM99\nG0 X2\n") == "1:1 "); }

TEST_CASE("a call that leads nowhere is refused where it stands") {
  CHECK(run("G0 X1\nM98 P3\nM30\n") == "1:1 2 M98 finds no subprogram here");
  CHECK(run("M98 P3 X1\nM30\nO3\nM99\n") == "1 M98 finds no subprogram here");
  CHECK(run("M98 P3\nM30\nO3\nM98 P3\nM99\n") == "4 M98 finds no subprogram here");  // 16 deep
}
