// What other controls' programs have and LinuxCNC refuses: read by lenient dialects, with a warning each.
#include <string>

#include "cncplan/gcode/controls.hpp"
#include "gcode/support.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

test::Reading read(std::string_view text) {
  gcode::Dialect dialect;
  dialect.lenient = true;
  return test::read(text, dialect);
}

std::string warnings(std::string_view text) {
  const auto reading = read(text);
  std::string all = reading.error;
  for (const auto& warning : reading.all<gcode::Warning>())
    all += gcode::to_text("", warning.about, "warning") + '\n';
  return all;
}

}  // namespace

TEST_CASE("words of axes that the machine lacks are left out") {
  CHECK(warnings("G0 X1 A90\nG1 X2 A3 F1\nA5\nG92 E0\n") ==
        "1:7: warning: A names an axis that the machine lacks: it is left out\n"
        "4:5: warning: E names an axis that the machine lacks: it is left out\n");
  CHECK(read("G0 X1 A90\nG93 G1 A3 F1\nX2 F1").motions().size() == 2);
  CHECK(read("G0 X5 Y5\nG28 A0").motions().size() == 1);  // does not send the others home
  CHECK(warnings("M67 E0 Q1").empty());                   // E of its own
  CHECK(test::read("G0 X1 A90").error == "1:7: A names no axis of the machine");
}

TEST_CASE("an exponent is refused by lenient dialects too") {
  CHECK(read("G0 X1E5").error == "1:6: E is not supported");
  CHECK(read("G0 X1.E-5").error == "1:7: E is not supported");
  CHECK(read("G92 X1E0").error == "1:7: E is not supported");
  CHECK(read("G1 F60 X1 E5").motions().size() == 1);  // an extruder's word
  CHECK(read("M67E0Q1").error.empty());
  CHECK(read("M67E0Q1\nG0 X1 E5").error.empty());
  gcode::Dialect printer;
  printer.lenient = true;
  printer.axes.push_back({'E', AxisKind::linear});
  CHECK(test::read("G0 X1E5", printer).motions()[0].end[3] == 5.0);
}

TEST_CASE("a rapid where no motion code holds") {
  const auto behind_a_cycle = test::read("F1 G81 X1 Z-1 R1\nG80\nG80\nX5");
  CHECK(behind_a_cycle.error.empty());
  CHECK(behind_a_cycle.motions().back().kind == gcode::MotionKind::rapid);
  CHECK(behind_a_cycle.all<gcode::Warning>().size() == 1);
  CHECK_FALSE(test::read("F1 G1 X1\nG80\nX5").error.empty());
  CHECK(warnings("F1 G81 X1 Z-1 R1\nG80\nZ5\nZ6") ==
        "3:1: warning: motion is a rapid: no motion code holds here\n");
  CHECK(read("X5\nG1 F1 X6\nX7").motions()[0].kind == gcode::MotionKind::rapid);
  CHECK(read("X5\nG1 F1 X6\nX7").motions()[2].kind == gcode::MotionKind::line);
  CHECK(warnings("G0 X1\nX2").empty());
  CHECK_FALSE(test::read("X5").error.empty());
}

TEST_CASE("printers' words") {
  CHECK(read("G4 S2").all<gcode::Dwell>()[0].seconds == 2.0);
  CHECK(read("G1 F1\nG4 X2.5").all<gcode::Dwell>()[0].seconds == 2.5);  // Fanuc's
  CHECK(read("G1 F1\nG4 X2.5").motions().empty());
  CHECK(read("G4 P2 X3 G1 F1").motions().size() == 1);
  CHECK(read("G4 X-1").error == "1:4: X must not be negative");
  CHECK(read("G1 F1 G4 X1 Y2").error == "1:7: P: a required word is missing");
  CHECK(test::read("G1 F1 G4 X2").error == "1:7: P: a required word is missing");
  CHECK(read("G4 S2\nM3").all<gcode::Word>().size() == 1);  // S is no speed
  CHECK(read("G0 X5 Y5 Z5\nG28 X Y\nM117 Printing 50%\nG29").error.empty());
  CHECK(read("G0 X5 Y5 Z5\nG28 XY").motions().back().end == gcode::Position{0, 0, 5});
  CHECK_FALSE(read("G95 G4 S600 F0.2 G1 X3").error.empty());  // nor makes it a feed
  CHECK(read("G4 G96 S60").error == "1:1: P: a required word is missing");
  CHECK_FALSE(test::read("G4 S2").error.empty());
  CHECK_FALSE(test::read("G0 X Y5").error.empty());
}

TEST_CASE("G31 probes as G38.2 does") {
  const auto reading = test::read("F60 G31 Z-5");
  REQUIRE(reading.motions().size() == 1);
  CHECK(reading.motions()[0].probe);
  CHECK(reading.motions()[0].end[2] == -5.0);
  CHECK(reading.all<gcode::Warning>().size() == 1);  // that nothing is touched
}

TEST_CASE("codes that nothing is known of are handed on") {
  const auto reading = test::read("M106 S255\nM106 S0\nM40\nG0 X1");
  CHECK(reading.error.empty());
  CHECK(reading.all<gcode::Warning>().size() == 2);  // of M106 and of M40
  CHECK(reading.all<gcode::Word>().size() == 5);
  CHECK(test::read("M2000\nM9999").error.empty());
  CHECK(test::read("M10000").error == "1:1: M10000 is not supported");
  CHECK(gcode::timing({'M', 106, 1, 1}) == gcode::Timing::at_rest);
}

TEST_CASE("commands to a sender are passed over") {
  CHECK(warnings("$H\n$$\n? ; where\n$100=250\nG0 X1") ==
        "1:1: warning: $ is not known here: it is handed on\n");
  CHECK(test::read("$H\n$I  ; version\nG0 X1").motions().size() == 1);
  CHECK_FALSE(test::read("$1").error.empty());
}

TEST_CASE("a centre of 0 beside the plane says nothing") {
  CHECK(test::read("F1 G2 X10 I5 J0 K0").error.empty());
  CHECK_FALSE(test::read("F1 G90.1 G2 X10 I5 J0 K0").error.empty());
  CHECK_FALSE(test::read("F1 G2 X10 K0").error.empty());
}

TEST_CASE("controls other than LinuxCNC are lenient") {
  CHECK(gcode::with({}, *gcode::find_control("grbl")).lenient);
  CHECK_FALSE(gcode::with({}, *gcode::find_control("linuxcnc")).lenient);
}
