#include "cncplan/gcode/detail/compensation.hpp"

#include <cmath>
#include <complex>
#include <iomanip>
#include <sstream>
#include <string>

#include "gcode/support.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

/// Kind, X and Y of every motion's end, to a thousandth; dwells.
std::string run(const std::string& text, const gcode::Dialect& dialect = {}) {
  std::ostringstream all;
  all << std::fixed << std::setprecision(3);
  const auto reading = test::read("F100 G1\n" + text, dialect);
  gcode::Position here{};
  for (const auto& item : reading.items) {
    if (std::holds_alternative<gcode::Dwell>(item)) all << "dwell ";
    const auto* motion = std::get_if<gcode::Motion>(&item);
    if (motion == nullptr) continue;
    CHECK(motion->start == here);
    CHECK(motion->tool_radius == 0.0);
    here = motion->end;
    const char* const names[] = {"rapid", "line", "radius", "arc"};
    all << names[static_cast<int>(motion->kind)] << ' ' << motion->end[0] + 0.0 << ',' << motion->end[1] + 0.0
        << ' ';
  }
  return all.str() + reading.error;
}

}  // namespace

TEST_CASE("a square from outside has arcs at its corners") {
  CHECK(run("G41.1 D4 Y10\nY20\nX10\nY10\nG40 X0 Y0\n") ==
        "line -2.000,10.000 line -2.000,20.000 arc 0.000,22.000 line 10.000,22.000 arc 12.000,20.000 "
        "line 12.000,10.000 line 0.000,0.000 ");
}

TEST_CASE("a square from inside has none") {
  CHECK(run("G42.1 D4 Y10\nY20\nX10\nG40 X0 Y0\n") ==
        "line 2.000,10.000 line 2.000,18.000 line 10.000,18.000 line 0.000,0.000 ");
}

TEST_CASE("arcs keep their centres, and meet lines at inner corners") {
  CHECK(run("G41.1 D4 X10\nG3 X20 Y10 J10\nG1 Y20\n") ==
        "line 10.000,2.000 arc 18.000,10.000 line 18.000,20.000 ");
  CHECK(run("G42.1 D4 X10\nG3 X20 Y10 J10\nG1 Y20\n") ==
        "line 10.000,-2.000 arc 22.000,10.000 line 22.000,20.000 ");
  // The line y = 2 and the circle of radius 8 about (20, 0), 2 within that of radius 10.
  const double x = 20.0 - std::sqrt(64.0 - 4.0);
  std::ostringstream met;
  met << std::fixed << std::setprecision(3) << "line 5.000,2.000 line " << x << ",2.000 ";
  CHECK(run("G41.1 D4 X5\nX10\nG3 X30 R10\n").substr(0, met.str().size()) != met.str());  // it bends away
  // A line into the outside of the circle of radius 10 + 2 about (20, 0): it goes round its top.
  const double outside = 20.0 - std::sqrt(144.0 - 4.0);
  std::ostringstream over;
  over << std::fixed << std::setprecision(3) << "line 5.000,2.000 line " << outside
       << ",2.000 arc 32.000,0.000 ";
  CHECK(run("G41.1 D4 X5\nX10\nG2 X30 R10\n") == over.str());
}

TEST_CASE("what turns back goes around the end, or into the cusp") {
  CHECK(run("G41.1 D4 X10\nX15\nX5\n") ==
        "line 10.000,2.000 line 15.000,2.000 arc 15.000,-2.000 line 5.000,-2.000 ");
  // x = 2 and the circle of radius 12 about (10, 10): y = 10 - sqrt(80)
  CHECK(run("G42.1 D4 Y10\nG3 X20 Y10 I10\n") == "line 2.000,1.056 arc 22.000,10.000 ");
}

TEST_CASE("the first motion may be an arc, which keeps its tangent at the end") {
  const auto reading = test::read("F100 G41.1 D4\nG3 X10 Y10 J10\n");
  REQUIRE(reading.motions().size() == 1);
  const gcode::Motion arc = reading.motions()[0];
  CHECK(arc.end[0] == Approx(8.0));
  CHECK(arc.end[1] == Approx(10.0));
  // |(0, 0) - (c, 10)| = 8 - c
  CHECK(arc.center[0] == Approx(-2.25));
  CHECK(arc.center[1] == Approx(10.0));
}

TEST_CASE("words keep their place, and motions beside the plane stay beside the path") {
  CHECK(
      run("G41.1 D4 Y10\nY20\nG4 P1\nZ-1\nX10\n") ==
      "line -2.000,10.000 line -2.000,20.000 dwell line -2.000,20.000 arc 0.000,22.000 line 10.000,22.000 ");
}

TEST_CASE("the radius is the tool's, and its sign the side") {
  gcode::Dialect dialect;
  dialect.tools = {{1, 0.0, 4.0}, {2, 0.0, -4.0}};
  CHECK(run("G41 D1 Y10\n", dialect) == "line -2.000,10.000 ");
  CHECK(run("G41 D2 Y10\n", dialect) == "line 2.000,10.000 ");
  CHECK(run("T2 M6\nG42 Y10\n", dialect) == "line -2.000,10.000 ");
  CHECK(run("G20 G42.1 D2 Y10\n", dialect) == "line 25.400,254.000 ");
}

TEST_CASE("an arc around a corner has the speed of the motion behind it under inverse time") {
  const auto motions = test::read("G93 G41.1 D4\nG1 Y10 F60\nY20 F60\nX10 F60\n").motions();
  REQUIRE(motions.size() == 4);
  // 10 mm in a second; the quarter of 2 mm has pi mm.
  CHECK(*motions[2].feed == Approx(10.0 / (2.0 * std::acos(-1.0) / 2.0)));
  CHECK(*motions[3].feed == Approx(1.0));
  // Before a whole circle, whose ends differ by rounding: 89.5 mm in half a minute.
  const auto before_circle = test::read(
                                 "G90 G93\nG0 X32.82 Y29.864\nG42.1 D4\nG1 X25.957 Y19.591 F20\n"
                                 "X19.094 Y12.318 F20\nG2 I-14.453 J7.626 F2\nG40\nG1 X32.82 Y29.864 F20\n")
                                 .motions();
  REQUIRE(before_circle.size() == 6);
  const auto& corner = before_circle[3];
  const auto way = [&](const gcode::Position& at) {
    return std::complex(at[0] - corner.center[0], at[1] - corner.center[1]);
  };
  const double length = 2.0 * std::abs(std::arg(way(corner.end) / way(corner.start)));
  const double around = 2.0 * std::acos(-1.0) * (std::hypot(14.453, 7.626) - 2.0);
  CHECK(*corner.feed * length == Approx(around * 2.0 / 60.0));
}

TEST_CASE("a whole circle is long enough behind an inner corner, and before one") {
  CHECK(run("G0 X-41.002 Y25.112\nG41.1 D4\nG1 X-33.823 Y20.834\nX-19.67 Y29.926\nG3 I-16.686 J2.133\n"
            "G1 X-36.356 Y32.059\nG40\nX-41.002 Y25.112\n")
            .find("error") == std::string::npos);
}
