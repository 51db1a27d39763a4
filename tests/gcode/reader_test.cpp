#include "cncplan/gcode/reader.hpp"

#include <array>
#include <cmath>
#include <string>
#include <variant>

#include "gcode/support.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"

using namespace cncplan;
using gcode::Dialect;
using gcode::FeedMode;
using gcode::Motion;
using gcode::MotionKind;
using gcode::Position;
using test::read;

namespace {

Position xyz(double x, double y, double z) { return {x, y, z}; }

/// The only motion of a program.
Motion motion(std::string_view text, const Dialect& dialect = {}) {
  const auto reading = read(text, dialect);
  INFO(text << " -> " << reading.error);
  REQUIRE(reading.error.empty());
  const auto motions = reading.motions();
  REQUIRE(motions.size() == 1);
  return motions[0];
}

std::vector<Position> ends(std::string_view text, const Dialect& dialect = {}) {
  const auto reading = read(text, dialect);
  INFO(text << " -> " << reading.error);
  REQUIRE(reading.error.empty());
  std::vector<Position> found;
  for (const Motion& each : reading.motions()) found.push_back(each.end);
  return found;
}

}  // namespace

TEST_CASE("straight motions") {
  const Motion rapid = motion("G0 X1 Y2 Z3");
  CHECK(rapid.kind == MotionKind::rapid);
  CHECK(rapid.plane == Plane::xy);
  CHECK(rapid.start == xyz(0, 0, 0));
  CHECK(rapid.end == xyz(1, 2, 3));
  CHECK_FALSE(rapid.feed);
  CHECK(rapid.line == 1);
  CHECK(rapid.column == 4);
  CHECK_FALSE(motion("G1 X1").feed);
  CHECK(*motion("G1 X1 F90").feed == 1.5);
  CHECK(*motion("F120\nG1 X1").feed == 2);
  CHECK(*motion("F0\nF120\nG1 X1").feed == 2);
}

TEST_CASE("motions that go nowhere do not come out, and still set the mode") {
  CHECK(read("G1\nG0 X0\n").motions().empty());
  CHECK(motion("G1\nX5").kind == MotionKind::line);
  CHECK(ends("G1 X5\nX5\nX6") == std::vector{xyz(5, 0, 0), xyz(6, 0, 0)});
}

TEST_CASE("inches") {
  CHECK(motion("G20 G0 X1").end[0] == 25.4);
  CHECK(ends("G20 G0 X1\nG21 Y1") == std::vector{xyz(25.4, 0, 0), xyz(25.4, 1, 0)});
  CHECK(*motion("G20\nG1 X1 F60").feed == 25.4);
  CHECK(*motion("G20 G1 X1 F60").feed == 25.4);       // the block's units are its feed's too
  CHECK(*motion("G20 F60\nG21 G1 X1").feed == 25.4);  // and the feed stays what it is
  CHECK(motion("G20 G2 X2 I1").center[0] == 25.4);
  CHECK(motion("G20 G2 X2 R1").radius == 25.4);
}

TEST_CASE("incremental distances") {
  CHECK(ends("G91 G0 X1 Y1\nX1\nG90 X1") == std::vector{xyz(1, 1, 0), xyz(2, 1, 0), xyz(1, 1, 0)});
}

TEST_CASE("arcs") {
  const Motion by_radius = motion("G2 X5 Y5 R5 P2 F60");
  CHECK(by_radius.kind == MotionKind::arc_radius);
  CHECK(by_radius.turn == Turn::clockwise);
  CHECK(by_radius.radius == 5);
  CHECK(by_radius.extra_turns == 1);
  CHECK(*by_radius.feed == 1);
  CHECK(by_radius.column == 10);
  const Motion by_center = motion("G18 G3 X10 Z1 I5 K.5");
  CHECK(by_center.kind == MotionKind::arc_center);
  CHECK(by_center.turn == Turn::counterclockwise);
  CHECK(by_center.plane == Plane::zx);
  CHECK(by_center.center == Vector3(5, 0, 0.5));
  CHECK(by_center.column == 15);
  CHECK(motion("G90.1 G2 X2 I1 J0").center == Vector3(1, 0, 0));
  const auto offset = read("G0 X10 Y20 Z30\nG2 I1\nG90.1 G2 I11 J20\nG91.1 G19 K2").motions();
  REQUIRE(offset.size() == 4);
  CHECK(offset[1].center == Vector3(11, 20, 30));  // the third coordinate is the start's
  CHECK(offset[2].center == Vector3(11, 20, 30));
  CHECK(offset[3].center == Vector3(10, 20, 32));  // I J K alone turn on
  CHECK(offset[3].end == offset[3].start);         // full circles do come out
  Dialect printed;
  printed.g18 = Plane::xz_printed;
  CHECK(motion("G18 G2 X2 I1", printed).plane == Plane::xz_printed);
}

TEST_CASE("inverse time") {
  const Motion timed = motion("G93 G1 X1 F30");
  CHECK(timed.feed_mode == FeedMode::inverse_time);
  CHECK(*timed.feed == 0.5);
  CHECK(read("G93 G1 X1 F30\nX2").error == "2:1: F: a required word is missing");
  CHECK(read("G93 G0 X1\nX2").error.empty());
  CHECK(read("G93 F10").error == "1:5: F is used by nothing on this line");
  CHECK(read("G1 X1 F60\nG93 X2 F30\nG94 X3").error == "3:5: F: a required word is missing");
  CHECK(read("G1 X1 F60\nG93\nG94\nX3").error == "4:1: F: a required word is missing");
  CHECK(read("G93\nG94 F0\nG1 X3").error == "3:1: F must be greater than zero");
  CHECK(*read("G93\nG94\nF60\nG1 X3").motions()[0].feed == 1.0);
  CHECK(*read("G93 G20 G1 X1 F60\nG94 X2 F60").motions()[1].feed == 25.4);
}

TEST_CASE("exact stop and the tolerance that is ignored once") {
  const auto reading = read("G61 G1 X1\nG64 P.1 Q.2 X2\nG61.1 X3\nG64 P1\n");
  REQUIRE(reading.motions().size() == 3);
  CHECK(reading.motions()[0].exact_stop);
  CHECK_FALSE(reading.motions()[1].exact_stop);
  CHECK(reading.motions()[2].exact_stop);
  const auto warnings = reading.all<gcode::Warning>();
  REQUIRE(warnings.size() == 2);
  CHECK(gcode::to_text("f.nc", warnings[0].about, "warning") ==
        "f.nc:2:5: warning: tolerance of G64 is ignored");
  CHECK(gcode::to_text("f.nc", warnings[1].about, "warning") == "f.nc:2:9: warning: Q of G64 is ignored");
  CHECK(read("G64\n").items.empty());
}

TEST_CASE("one line's items come in the order of RS274/NGC") {
  Dialect dialect;
  dialect.tools = {{5}};
  const auto reading = read("M30 G1 X1 F60 M8 G4 P2 M3 S100 T5 M6", dialect);
  REQUIRE(reading.error.empty());
  REQUIRE(reading.items.size() == 8);
  CHECK(std::get<gcode::Word>(reading.items[0]) == gcode::Word{'S', 100, 1, 27});
  CHECK(std::get<gcode::Word>(reading.items[1]).letter == 'T');
  CHECK(std::get<gcode::Stop>(reading.items[2]) == gcode::Stop{6, 1});
  CHECK(std::get<gcode::Word>(reading.items[3]) == gcode::Word{'M', 3, 1, 24});
  CHECK(std::get<gcode::Word>(reading.items[4]).number == 8);
  CHECK(std::get<gcode::Dwell>(reading.items[5]) == gcode::Dwell{2, 1});
  CHECK(std::holds_alternative<Motion>(reading.items[6]));
  CHECK(std::get<gcode::Stop>(reading.items[7]) == gcode::Stop{30, 1});
}

TEST_CASE("the fullest line fits the buffer that is promised to take it") {
  Dialect dialect;
  dialect.pass_through = {{'C', {}}};
  dialect.lenient = true;
  std::string line = "G33.1 X5 K1 I2 S1 T1 $0 M6 M3 M8 M30 M48 M66 P1 E1 L1 Q1 G96 D1 G15 G50 G69 A1 M40";
  for (int i = 1; i < gcode::max_passed; ++i) line += " C1";
  const auto reading = read(line, dialect);
  CHECK(reading.error.empty());
  CHECK(reading.items.size() == gcode::max_items_per_line);
}

TEST_CASE("work coordinate systems") {
  Dialect dialect;
  for (int i = 0; i < gcode::work_systems; ++i)
    dialect.work_offsets[static_cast<std::size_t>(i)] = xyz(i, 0, 0);
  const auto offset_of = [&](const std::string& code) {
    return motion(code + " G0 X100", dialect).offset[0];
  };
  const char* const codes[] = {"G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3"};
  for (int i = 0; i < gcode::work_systems; ++i) CHECK(offset_of(codes[i]) == i);
  const auto moves = read("G0 X10\nG55 G0 X10\n", dialect).motions();
  CHECK(moves[1].start[0] == 9);  // the machine stays where it is
  dialect.work_offsets[0] = xyz(5, 6, 7);
  CHECK(motion("G0 X1", dialect).start == xyz(-5, -6, -7));  // the machine begins at its zero
}

TEST_CASE("machine coordinates for one line") {
  Dialect dialect;
  dialect.work_offsets[0] = xyz(5, 0, 0);
  dialect.tools = {{1, 20.0}};
  CHECK(ends("G53 G0 X10\nX10", dialect) == std::vector{xyz(5, 0, 0), xyz(10, 0, 0)});
  CHECK(ends("G43 H1\nG53 G1 Z-10", dialect)[0][2] == -30);
}

TEST_CASE("G92 and its kin") {
  CHECK(ends("G0 X10\nG92 X1\nG0 X2") == std::vector{xyz(10, 0, 0), xyz(2, 0, 0)});
  const auto offsets = read("G0 X10\nG92 X1\nX2\nG92.2\nX3\nG92.3\nX4\nG92.1\nX5\nG92.3\nX6").motions();
  REQUIRE(offsets.size() == 6);
  CHECK(offsets[1].offset[0] == 9);
  CHECK(offsets[2].offset[0] == 0);
  CHECK(offsets[2].start[0] == 11);
  CHECK(offsets[3].offset[0] == 9);
  CHECK(offsets[4].offset[0] == 0);
  CHECK(offsets[5].offset[0] == 0);
  CHECK(read("G0 X.1\nG92 X.3\nG0 X.3\n").motions().size() == 1);  // exactly there: nowhere to go
}

TEST_CASE("a change of offset leaves no motion of a rounding's length") {
  Dialect dialect;
  dialect.home_g28 = xyz(0.3, 0, 0);
  dialect.work_offsets[1] = xyz(0.1, 0, 0);
  dialect.work_offsets[2] = xyz(0.7, 0, 0);
  CHECK(read("G28\nG55 G28\nG56 G28\nG92 X.9\nG28\nG92.1\nG54 G28\n", dialect).motions().size() == 1);
  const auto circle = read("G55 G0 X.6\nG56\nG55 G2 X.6 I1", dialect).motions();
  REQUIRE(circle.size() == 2);
  CHECK(circle[1].end == circle[1].start);
}

TEST_CASE("tool lengths") {
  Dialect dialect;
  dialect.tools = {{1, 20.0}, {2, 30.0}};
  const auto length = [&](const std::string& code) { return motion(code + "\nG0 X1", dialect).offset[2]; };
  CHECK(length("") == 0);
  CHECK(length("G43 H2") == 30);
  CHECK(length("T2 M6 G43") == 30);
  CHECK(length("T2\nG43") == 0);  // selected, not yet loaded
  CHECK(length("G43 H1\nG49") == 0);
  CHECK(length("G43.1 Z1.5") == 1.5);
  CHECK(length("G20 G43.1 Z1\nG21") == 25.4);
  CHECK(motion("G0 G43 H1 Z5", dialect).end[2] == 5);
}

TEST_CASE("home by way of a point") {
  Dialect dialect;
  dialect.home_g28 = xyz(1, 2, 3);
  dialect.home_g30 = xyz(4, 5, 6);
  dialect.work_offsets[0] = xyz(10, 10, 10);
  const auto all = read("G0 X0 Y0 Z0\nG28\n", dialect).motions();
  REQUIRE(all.size() == 2);
  CHECK(all[1].end == xyz(-9, -8, -7));
  CHECK(all[1].kind == MotionKind::rapid);
  CHECK(all[1].column == 1);
  CHECK(ends("G0 X0 Y0 Z0\nG91 G28 Z5\n", dialect) == std::vector{xyz(0, 0, 0), xyz(0, 0, 5), xyz(0, 0, -7)});
  CHECK(ends("G1 X0 Y0 Z0\nG30 X1 Y1\nX2", dialect) ==
        std::vector{xyz(0, 0, 0), xyz(1, 1, 0), xyz(-6, -5, 0), xyz(2, -5, 0)});
  CHECK(ends("G0 G28 X5", dialect).size() == 2);
  CHECK(read("G1 X1\nG28\nX2").motions()[2].kind == MotionKind::line);  // the mode survives
}

TEST_CASE("the shell of a program") {
  CHECK(ends("\xEF\xBB\xBFG0 X1\r\n\r\n%\n") == std::vector{xyz(1, 0, 0)});
  CHECK(ends("(head)\n%\nO0001 (name)\nN10 G0 X1\n") == std::vector{xyz(1, 0, 0)});
  CHECK(ends("/G0 X1\n / X2\nG0 X3") == std::vector{xyz(3, 0, 0)});
  Dialect dialect;
  dialect.block_delete = false;
  CHECK(ends("/G0 X1\n / X2\nX3", dialect).size() == 3);
  CHECK(read("O100 sub").error == "1:1: O-word is not supported");
  CHECK(read("G0 X1\nO100\nX2").motions().size() == 2);  // names what follows, and does no more
  CHECK(read("G0 X1\nG1 O100").error == "2:4: O-word is not supported");
  CHECK(
      read("00001").error ==
      "1:1: 0 belongs to no letter, or a blank is in a number");  // no tape's beginning: no program's number
  CHECK(read("% G0 X1").error == "1:1: % is used by nothing on this line");
}

TEST_CASE("a line in error changes nothing") {
  gcode::Reader reader;
  std::array<gcode::Item, gcode::max_items_per_line> items;
  CHECK_FALSE(reader.read_line("G20 G91 G1 X1 F60 S5 Y", items.data()));
  CHECK_FALSE(reader.read_line("G20 G91 G1 X1 F60 K5", items.data()));
  CHECK(reader.position() == Position{});
  CHECK(reader.read_line("X1", items.data()).error().error.code == ErrorCode::missing_word);
  REQUIRE(reader.read_line("G0 X1", items.data()));
  CHECK(reader.position()[0] == 1);
  CHECK(reader.line() == 4);
}

TEST_CASE("reading a line does not touch the heap") {
  gcode::Reader reader;
  std::array<gcode::Item, gcode::max_items_per_line> items;
  int errors = 0;
  CHECK(test::heap_allocations_of([&] {
          for (const char* line :
               {"G2 X5 Y5 R5 F100", "G64 P1 M3 S1", "G92 X1", "G28 X0", "bad", "G0 X99999999999999999999"})
            errors += reader.read_line(line, items.data()) ? 0 : 1;
        }) == 0);
  CHECK(errors == 2);
}

TEST_CASE("G80 beside a motion code leaves it, and alone ends it") {
  CHECK(motion("N1 G00 G17 G21 G40 G49 G80 G90\nX5").kind == MotionKind::rapid);
  CHECK(motion("G80 G1 X5").kind == MotionKind::line);
  CHECK(motion("G1 G80 X5").kind == MotionKind::line);
  CHECK(read("G1 X5\nG80\nX6").error == "3:1: G0, G1, G2 or G3: a required word is missing");
  CHECK(read("G1 G80 G0 X5").error == "1:8: G0: words exclude each other (G1)");
}

TEST_CASE("an unknown letter is told before what its line lacks") {
  CHECK(read("G92 E0").error == "1:5: E is not supported");
  CHECK(read("G92").error == "1:1: axis: a required word is missing");
}

TEST_CASE("text that is no word says what stands where a number should") {
  CHECK(read("gsw").error == "1:1: G has no number: 's' follows");
  CHECK(read("M").error == "1:1: M has no number");
  CHECK(read("G1 X\xC3").error == "1:4: X has no number: byte 195 follows");
}

TEST_CASE("motions carry how closely the path is kept") {
  using gcode::PathMode;
  const auto motions =
      read("G1 X1\nG61 X2\nG61.1 X3\nG64 P.1 Q.02 X4\nG20 G64 P1\nG21 X5\nG64 P0 X6\nG64 X7").motions();
  REQUIRE(motions.size() == 7);
  const PathMode modes[] = {PathMode::continuous, PathMode::exact_path, PathMode::exact_stop,
                            PathMode::continuous, PathMode::continuous, PathMode::exact_path,
                            PathMode::continuous};
  for (std::size_t i = 0; i < motions.size(); ++i) CHECK(motions[i].path_mode == modes[i]);
  CHECK(motions[3].tolerance == 0.1);
  CHECK(motions[3].merge_tolerance == 0.02);
  CHECK(motions[4].tolerance == 25.4);
  CHECK(motions[4].merge_tolerance == 0.0);
  for (const int i : {0, 1, 2, 5, 6}) CHECK_FALSE(motions[static_cast<std::size_t>(i)].tolerance);
}

TEST_CASE("a program begins where the axes stand") {
  gcode::Dialect dialect;
  dialect.work_offsets[0] = {1.0, 0.0, 0.0};
  gcode::Reader reader(dialect, {5.0, -2.0, 3.0});
  std::array<gcode::Item, gcode::max_items_per_line> items;
  CHECK(reader.position()[0] == 4.0);
  REQUIRE(reader.read_line("G91 G1 X1 F600", items.begin()));
  const auto motion = std::get<gcode::Motion>(items[0]);
  CHECK(motion.start[0] + motion.offset[0] == 5.0);
  CHECK(motion.end[0] + motion.offset[0] == 6.0);
  REQUIRE(reader.read_line("G90 G53 G0 X0", items.begin()));
  CHECK(std::get<gcode::Motion>(items[0]).start[0] == 5.0);
  gcode::Reader nowhere({}, {std::nan(""), 0.0, 0.0});
  const auto refused = nowhere.read_line("G1 X1 F600", items.begin());
  REQUIRE_FALSE(refused);
  CHECK(refused.error().error.code == ErrorCode::not_finite);
}
