#include "cncplan/gcode/dialect.hpp"

#include "cncplan/gcode/controls.hpp"
#include "cncplan/gcode/writer.hpp"
#include "gcode/support.hpp"
#include "support/catch.hpp"

using namespace cncplan;
using gcode::AxisKind;
using gcode::Dialect;

TEST_CASE("a dialect is checked") {
  CHECK(gcode::validate({}));
  const auto with_axes = [](std::vector<gcode::Axis> axes) {
    Dialect dialect;
    dialect.axes = std::move(axes);
    const auto valid = gcode::validate(dialect);
    return valid ? std::string() : std::string(valid.error().field);
  };
  CHECK(with_axes({{'R', AxisKind::linear}, {'Z', AxisKind::linear}, {'A', AxisKind::rotary}}).empty());
  CHECK(with_axes({}) == "number of axes");
  CHECK(with_axes(std::vector<gcode::Axis>(10, {'X', AxisKind::linear})) == "number of axes");
  CHECK(with_axes({{'X', AxisKind::linear}, {'X', AxisKind::linear}}) == "X");
  CHECK(with_axes({{'F', AxisKind::linear}}) == "F");
  CHECK(with_axes({{'x', AxisKind::linear}}) == "axis letter");
  Dialect dialect;
  dialect.tools = {{1, NAN}};
  CHECK(gcode::validate(dialect).error().code == ErrorCode::not_finite);
  dialect.tools = {{1, 10.0}};
  CHECK(gcode::validate(dialect));
  dialect.axes = {{'X', AxisKind::linear}};
  CHECK(gcode::validate(dialect).error().field == "Z");
  dialect = {};
  dialect.work_offsets[8][5] = INFINITY;
  CHECK(gcode::validate(dialect).error().field == "work offset");
  dialect = {};
  dialect.home_g30[0] = NAN;
  CHECK(gcode::validate(dialect).error().field == "home position of G30");
}

TEST_CASE("the thesis' program reads back: R is an axis, A and C are degrees, its own words pass through") {
  Dialect dialect;
  dialect.axes = {
      {'R', AxisKind::linear}, {'Z', AxisKind::linear}, {'A', AxisKind::rotary}, {'C', AxisKind::rotary}};
  dialect.pass_through = {{'G', 251.0}, {'G', 8.0}, {'G', 5.0}};
  REQUIRE(gcode::validate(dialect));
  const auto reading = test::read(
      "%\n00001 ( )\nG17 G80 G49 G021 G40\nG251\nG08 P1\nG05 P10000 Q3\nT00 M6\n"
      "G00 G90 R244.365 Z134.545 A-3.006 C58.954 S20000 M03\nG43 R245.414 Z154.518 A-3.006 C58.954 H00\n"
      "G01 R244.354 Z134.346 A-3.006 C58.954 F1000.\nR244.349 Z134.346 A-3.003 C59.935\nM30\n%\n",
      dialect);
  REQUIRE(reading.error.empty());
  const auto words = reading.all<gcode::Word>();
  CHECK(words == std::vector<gcode::Word>{{'O', 1, 2, 1},
                                          {'G', 251, 4, 1},
                                          {'G', 8, 5, 1, {{'P', 1}}},
                                          {'G', 5, 6, 1, {{'P', 10000}, {'Q', 3}}},
                                          {'T', 0, 7, 1},
                                          {'S', 20000, 8, 43},
                                          {'M', 3, 8, 50}});
  const auto motions = reading.motions();
  REQUIRE(motions.size() == 4);
  CHECK(motions[0].end[0] == 244.365);
  CHECK(motions[0].end[2] == Approx(-3.006 * M_PI / 180));
  CHECK(motions[3].end[3] == Approx(59.935 * M_PI / 180));
  CHECK(motions[3].kind == gcode::MotionKind::line);
  CHECK(*motions[3].feed == Approx(1000.0 / 60));
  CHECK(motions[3].column == 1);
}

TEST_CASE("without a list nothing passes through") {
  CHECK(test::read("G251\n").error == "1:1: G251 is not supported");
  CHECK(test::read("G8 P1\n").error == "1:4: P is used by nothing on this line");
  CHECK(test::read("D3\n").error == "1:1: D is not supported");
}

TEST_CASE("a letter passes through with any number") {
  Dialect dialect;
  dialect.pass_through = {{'D', {}}, {'M', 98.0}};
  CHECK(test::read("G0 X1 D3\nD4\n", dialect).all<gcode::Word>().size() == 2);
  CHECK(test::read("M98 L2 P100\n", dialect).all<gcode::Word>() ==
        std::vector<gcode::Word>{{'M', 98, 1, 1, {{'L', 2}, {'P', 100}}}});
  CHECK(test::read("G4 P1 M98 L2\n", dialect).all<gcode::Word>() ==
        std::vector<gcode::Word>{{'M', 98, 1, 7, {{'L', 2}}}});  // P is G4's
  CHECK(test::read("M98 X1\n", dialect).error == "1:1: M98 is beside a word that may be its own (X)");
  CHECK(test::read("M98 G80 X1\n", dialect).error == "1:1: M98 is beside a word that may be its own (X)");
  std::string many;
  for (int i = 0; i < 17; ++i) many += "D1";
  CHECK(test::read(many, dialect).error == "1:33: number of words to pass through: 17 is above the limit 16");
}

TEST_CASE("R of a machine that has such an axis is that axis, and no word of M19") {
  Dialect dialect;
  dialect.axes.push_back({'R', AxisKind::linear});
  const auto homed = test::read("G0 R5\nG28 M19 R1\n", dialect);
  CHECK(homed.error == "");
  CHECK(homed.all<gcode::Word>() == std::vector<gcode::Word>{{'M', 19, 2, 5}});
  CHECK(homed.motions().size() == 3);
  CHECK(test::read("M19 R1\n", dialect).error == "1:5: G0, G1, G2 or G3: a required word is missing");
  CHECK(test::read("M19 R1\n").all<gcode::Word>() == std::vector<gcode::Word>{{'M', 19, 1, 1, {{'R', 1}}}});
}

TEST_CASE("a reader or writer of an invalid dialect takes nothing") {
  for (const auto& [letters, error] :
       {std::pair{"XYZABCUVWR", "1:1: number of axes: 10 is above the limit 9"},
        std::pair{"x", "1:1: axis letter: unknown character"}}) {
    Dialect dialect;
    dialect.axes.clear();
    for (const char letter : std::string_view(letters)) dialect.axes.push_back({letter, AxisKind::linear});
    CHECK(test::read("", dialect).error.empty());
    CHECK(test::read("G0 X1\n", dialect).error == error);
    gcode::Reader reader(dialect);
    gcode::Item item;
    CHECK_FALSE(reader.read_line("G0 X1", &item));
    CHECK(reader.read_line("", &item).error().line == 2);
    gcode::Writer writer(dialect);
    std::string text;
    for (const gcode::Item& refused : {gcode::Item(gcode::Motion()), gcode::Item(gcode::Stop{30, 1})})
      CHECK(writer.write(refused, std::back_inserter(text)).error() == gcode::validate(dialect).error());
    writer.finish(std::back_inserter(text));
    CHECK(text.empty());
  }
}

TEST_CASE("what moves the axes does not pass through") {
  const auto refused = [](gcode::PassThrough passed) {
    Dialect dialect;
    dialect.pass_through = {{'M', 100.0}, passed};
    const auto valid = gcode::validate(dialect);
    return !valid && valid.error().code == ErrorCode::not_to_pass;
  };
  for (const double code : {0.0, 1.0, 2.0, 3.0, 10.0, 28.0, 38.2, 43.1, 73.0, 81.0, 83.0, 92.0})
    CHECK(refused({'G', code}));
  CHECK(refused({'G', {}}));
  CHECK(refused({'X', {}}));
  CHECK(refused({'F', {}}));
  for (const double code : {5.0, 8.0, 17.0, 251.0}) CHECK_FALSE(refused({'G', code}));
  CHECK_FALSE(refused({'D', {}}));
  CHECK_FALSE(refused({'M', {}}));
  Dialect dialect;
  dialect.pass_through = {{'G', 181.0}};
  CHECK(test::read("G0 X1\nG181 X10 Y10\n", dialect).error ==
        "2:1: G181 says where or how the axes move, so it cannot be passed through");
  CHECK(test::read("G181 P1\nG181 G1 X10\n", dialect).error.empty());
}

TEST_CASE("controls differ in what a dwell counts and where a cycle goes back to") {
  const auto fanuc = gcode::find_control("fanuc");
  REQUIRE(fanuc);
  const Dialect dialect = gcode::with({}, *fanuc);
  for (const std::string look_ahead : {"G05.1 Q1", "G05 P10000", "G08 P1"}) {  // no splines, no radii
    const auto reading = test::read("G1 F100\n" + look_ahead + "\nX7", dialect);
    CHECK(reading.error.empty());
    REQUIRE(reading.all<gcode::Word>().size() == 1);
    CHECK(reading.all<gcode::Word>()[0].arguments.size() == 1);
    CHECK(reading.motions().size() == 1);
  }
  const auto reading = test::read("G0 Z9\nG82 X1 Z-1 R2 P500 F1\nG4 P1500\n", dialect);
  REQUIRE(reading.error.empty());
  const auto dwells = reading.all<gcode::Dwell>();
  REQUIRE(dwells.size() == 2);
  CHECK(dwells[0].seconds == 0.5);
  CHECK(dwells[1].seconds == 1.5);
  CHECK(reading.motions().back().end[2] == 9);
  CHECK(test::read("G0 Z9\nG82 X1 Z-1 R2 P.5 F1\n").motions().back().end[2] == 2);
  CHECK_FALSE(gcode::find_control("Fanuc"));
  const auto words = test::read("M29 S100\nM41\n", dialect).all<gcode::Word>();
  REQUIRE(words.size() == 3);
  CHECK(words[0].number == 29);
  CHECK(test::read("M29 S100\n", dialect).all<gcode::Warning>().empty());
  CHECK(test::read("M29 S100\n").all<gcode::Warning>().size() == 1);
  Dialect absolute;
  absolute.incremental_center = false;
  const auto arcs = test::read("G0 X10\nG2 X20 I15 J0 F1\nG91.1 X30 I5\n", absolute).motions();
  REQUIRE(arcs.size() == 3);
  CHECK(arcs[1].center[0] == 15.0);
  CHECK(arcs[2].center[0] == 25.0);
  for (const gcode::Control& control : gcode::controls) CHECK(gcode::validate(gcode::with({}, control)));
  std::string text;
  gcode::Writer writer(dialect);
  REQUIRE(writer.write(gcode::Dwell{0.123, 1}, std::back_inserter(text)));
  writer.finish(std::back_inserter(text));
  CHECK(test::read(text, dialect).all<gcode::Dwell>()[0].seconds == 0.123);
}

TEST_CASE("G70 and G71 are units in Mach3's dialect alone") {
  const Dialect mach3 = gcode::with({}, *gcode::find_control("mach3"));
  const auto ends = [&](const std::string& text) {
    std::vector<double> x;
    const auto reading = test::read(text, mach3);
    CHECK(reading.error == "");
    for (const auto& motion : reading.motions()) x.push_back(motion.end[0]);
    return x;
  };
  CHECK(ends("G70 G0 X1\nG71 X2\nG70\nX3\nG21 X4\nG20 X1") ==
        std::vector<double>{25.4, 2, 3 * 25.4, 4, 25.4});
  CHECK(test::read("G70 G21", mach3).error == "1:5: G21: words exclude each other (G20)");
  for (const char* control : {"linuxcnc", "grbl", "fanuc", "marlin"})
    for (const char* code : {"G70", "G71"})
      CHECK(test::read(code, gcode::with({}, *gcode::find_control(control))).error ==
            "1:1: " + std::string(code) + " is not supported");
}
