// What moves and turns work coordinates beside G92 and G54: G10 R, L10 and L11, G52, G28.1, and places by
// radius and angle. Expected places are of plane trigonometry, by hand.
#include <cmath>

#include "gcode/support.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

/// Machine coordinates at the end of the last motion.
Vector3 end_of(std::string_view program) {
  const auto reading = test::read(program);
  INFO(program << '\n' << reading.error);
  REQUIRE(reading.error.empty());
  REQUIRE_FALSE(reading.motions().empty());
  const gcode::Motion last = reading.motions().back();
  return Vector3(last.end[0], last.end[1], last.end[2]) +
         Vector3(last.offset[0], last.offset[1], last.offset[2]);
}

void check_end(std::string_view program, double x, double y, double z) {
  INFO(program);
  CHECK((end_of(program) - Vector3(x, y, z)).norm() < 1e-12);
}

}  // namespace

TEST_CASE("a work system may be rotated about Z") {
  const double c = std::sqrt(3.0) / 2.0, s = 0.5;  // of 30 degrees
  check_end("G10 L2 P1 R30\nG0 X10", 10.0 * c, 10.0 * s, 0.0);
  check_end("G10 L2 P1 X1 Y2 R30\nG0 X10 Y4", 1.0 + 10.0 * c - 4.0 * s, 2.0 + 10.0 * s + 4.0 * c, 0.0);
  check_end("G10 L2 P1 R30\nG0 X10\nG91 X10 Z3", 20.0 * c, 20.0 * s, 3.0);
  check_end("G10 L2 P1 R30\nG0 X10\nG10 L2 P1 R0\nG0 X0", 0.0, 10.0 * s, 0.0);  // the machine stands still
  check_end("G10 L2 P2 R30\nG0 X10\nG55 X0 Y5", -5.0 * s, 5.0 * c, 0.0);
  check_end("G10 L2 P1 R30\nG92 X1 Y1\nG0 X2 Y1", c, s, 0.0);              // the shift is turned as well
  check_end("G10 L2 P1 R30\nG0 X10\nG53 G0 X0", 0.0, 10.0 * s, 0.0);       // machine coordinates are not
  check_end("G10 L2 P1 R30\nG0 X10 Y5\nG28 X10", -5.0 * s, 5.0 * c, 0.0);  // X goes home, Y stays
  // L20: the axes, at 10 along the turned X, stand at X1 Y0 from now on.
  check_end("G10 L2 P1 R30\nG0 X10\nG10 L20 P1 X1 Y0\nG0 X0", 9.0 * c, 9.0 * s, 0.0);
}

TEST_CASE("arcs of a rotated system keep their radius about a turned centre") {
  const auto reading = test::read("F1 G10 L2 P1 R90\nG0 X10\nG2 X0 Y10 I-10 J0");
  const gcode::Motion arc = reading.motions().back();
  CHECK((arc.center - Vector3(0.0, 0.0, 0.0)).norm() < 1e-12);
  CHECK(std::abs(arc.start[1] - 10.0) + std::abs(arc.end[0] + 10.0) < 1e-12);
}

TEST_CASE("G52 sets the shift that G92 makes") {
  check_end("G0 X5\nG52 X2 Y3\nG0 X0 Y0", 2.0, 3.0, 0.0);
  check_end("G52 X2\nG52 X5\nG0 X0", 5.0, 0.0, 0.0);  // not in sum
  check_end("G52 X2\nG92.1\nG0 X1", 1.0, 0.0, 0.0);
}

TEST_CASE("G10 sets lengths and radii of tools from where the axes stand") {
  check_end("G10 L2 P1 Z3\nG0 Z10\nG10 L10 P1 Z4\nG43 H1\nG0 Z0", 0.0, 0.0, 9.0);  // 13 - 3 - 4 = 6
  check_end("G10 L2 P9 Z1\nG0 Z10\nG10 L11 P1 Z4\nG43 H1\nG0 Z0", 0.0, 0.0, 5.0);  // 10 - 1 - 4
  check_end("G92 Z1\nG0 Z10\nG10 L10 P1 Z4\nG43 H1\nG0 Z0", 0.0, 0.0, 5.0);  // 9 + 1 - 4, less the 1 of G92
  check_end("G10 L1 P1 Z6\nG10 L1 P2 Z2\nG43 H1\nG43.2 H2\nG0 Z0", 0.0, 0.0, 8.0);
  check_end("G10 L1 P1 X6 Y-2 Z1\nG43 H1\nG0 X1 Y1 Z1", 7.0, -1.0, 2.0);
  check_end("G0 X7 Y8\nG10 L10 P1 X3 Y1\nG43 H1\nG0 X0 Y0", 4.0, 7.0, 0.0);
  check_end("G10 L1 P1 X6\nG10 L2 P1 R90\nG43 H1\nG0 X1 Y2", 4.0, 1.0, 0.0);  // the tool is not turned
  check_end("G10 L1 P1 R2\nF1 G41 D1 G1 X10\nX20\nM2", 20.0, 2.0, 0.0);
}

TEST_CASE("G28.1 and G30.1 make homes of where the axes stand") {
  check_end("G0 X3 Y4\nG28.1\nG0 X9 Y9\nG28", 3.0, 4.0, 0.0);
  check_end("G54 G10 L2 P1 X1\nG0 X3\nG28.1\nG0 X9\nG28", 4.0, 0.0, 0.0);
  check_end("G54 G10 L2 P1 X1\nG0 X3\nG30.1\nG0 X9\nG30", 4.0, 0.0, 0.0);
}

TEST_CASE("places by radius and angle") {
  const double c = std::sqrt(3.0) / 2.0;
  check_end("G0 @10 ^30", 10.0 * c, 5.0, 0.0);
  check_end("G0 X10\n^30 Z1", 10.0 * c, 5.0, 1.0);
  check_end("G0 @10 ^30\n@20", 20.0 * c, 10.0, 0.0);
  check_end("G0 @10 ^10\nG91 @10 ^20", 20.0 * c, 10.0, 0.0);
  check_end("F1 G0 X5\nG2 @5 ^-90 R5", 0.0, -5.0, 0.0);
  check_end("F1 G0 X10 Z2\nG99 G91 G81 R0 Z-1 ^30 L3", 0.0, 10.0, 2.0);  // holes at 30, 60 and 90 degrees
}
