// Words that the reader does not carry out itself, and codes that change what others mean.
#include "gcode/support.hpp"
#include "support/catch.hpp"

using namespace cncplan;
using gcode::Dialect;
using gcode::Timing;
using gcode::Word;
using test::read;

TEST_CASE("outputs, inputs and overrides are handed out with the words that they take") {
  CHECK(read("M62 P3\nM67 E1 Q-2.5\nM66 P0 L3 Q5\nM51 P0\nM48\nG1 X1 M63 P2").all<Word>() ==
        std::vector<Word>{{'M', 62, 1, 1, {{'P', 3}}},
                          {'M', 67, 2, 1, {{'E', 1}, {'Q', -2.5}}},
                          {'M', 66, 3, 1, {{'P', 0}, {'L', 3}, {'Q', 5}}},
                          {'M', 51, 4, 1, {{'P', 0}}},
                          {'M', 48, 5, 1},
                          {'M', 63, 6, 7, {{'P', 2}}}});
  CHECK(read("M60").all<gcode::Stop>() == std::vector<gcode::Stop>{{60, 1}});
  CHECK(read("G4 P1 M62").error == "1:4: P: words exclude each other (two codes use it)");
}

TEST_CASE("words say when they take effect") {
  const auto of = [](char letter, double number) { return gcode::timing(Word{letter, number, 1, 1}); };
  for (const double code : {62, 63, 67}) CHECK(of('M', code) == Timing::next_motion);
  for (const double code : {61, 64, 65, 66, 68}) CHECK(of('M', code) == Timing::at_rest);
  for (const double code : {3, 4, 5, 7, 8, 9, 48, 53}) CHECK(of('M', code) == Timing::immediate);
  CHECK(of('T', 1) == Timing::at_rest);
  CHECK(of('S', 1000) == Timing::immediate);
}

TEST_CASE("codes of a head that end nothing are named once") {
  const auto reading = read("G15 G17 G50 G69 G40 G49 G80 G98\nG15 G69\nG0 X1");
  CHECK(reading.error.empty());
  CHECK(reading.motions().size() == 1);
  const auto warnings = reading.all<gcode::Warning>();
  REQUIRE(warnings.size() == 3);
  CHECK(gcode::to_text(warnings[0].about) == "G15 is ignored");
  CHECK(gcode::to_text(warnings[1].about) == "G50 is ignored");
  CHECK(gcode::to_text(warnings[2].about) == "G69 is ignored");
}

TEST_CASE("G10 sets work coordinate systems and tools") {
  Dialect dialect;
  dialect.work_offsets[1] = {1, 2, 3};
  const auto place = [&](const std::string& text) {
    const auto reading = read(text, dialect);
    INFO(text << " -> " << reading.error);
    REQUIRE(reading.error.empty());
    const auto motion = reading.motions().back();
    return Vector3(motion.end[0] + motion.offset[0], motion.end[1] + motion.offset[1],
                   motion.end[2] + motion.offset[2]);
  };
  CHECK(place("G10 L2 P2 X5 Z7\nG55 G0 X1 Y1 Z1") == Vector3(6, 3, 8));
  CHECK(place("G55\nG10 L2 P0 X5\nG0 X1 Y1 Z1") == Vector3(6, 3, 4));
  CHECK(place("G0 X10 Y20\nG10 L20 P1 X0 Y0\nX1 Y1") == Vector3(11, 21, 0));
  CHECK(place("G0 X10 Y20\nG10 L20 P2 X0 Y0\nG0 X1 Y1\nG55 Y2") == Vector3(1, 22, 0));
  CHECK(place("G20\nG10 L2 P1 X1\nG0 X1") == Vector3(50.8, 0, 0));
  CHECK(place("G10 L1 P7 Z12\nG43 H7 G0 Z1") == Vector3(0, 0, 13));
  CHECK(place("G10 L1 P7 Z12\nG10 L1 P7 Z13\nG43 H7 G0 Z1") == Vector3(0, 0, 14));
  std::string many;
  for (int i = 0; i < 65; ++i) many += "G10 L1 P" + std::to_string(i) + " Z1\n";
  CHECK(read(many).error == "65:8: P is not supported");
}

TEST_CASE("a tool that the table does not have is an error, and without a table a warning once") {
  Dialect dialect;
  dialect.tools = {{1, 12.0, 6.0}};
  for (const auto& [line, at] : {std::pair("T2 M6", "1:1: T2"),
                                 {"T2", "1:1: T2"},
                                 {"G0 X1\nM6 T2", "2:4: T2"},
                                 {"G43 H2", "1:5: H2"},
                                 {"G43.2 H2", "1:7: H2"},
                                 {"G41 D2", "1:5: D2"},
                                 {"G42 D2", "1:5: D2"},
                                 {"M61 Q2", "1:5: Q2"},
                                 {"T2 G43 H3", "1:1: T2"},
                                 {"T1 M6 G43 H3", "1:11: H3"}}) {
    CAPTURE(line);
    CHECK(read(line, dialect).error == std::string(at) + " names a tool that the table does not have");
  }
  for (const char* line : {"T1 M6", "T0 M6", "G43", "G43 H0", "G43 H1", "G41 D1", "G41 D0", "G41.1 D6",
                           "M61 Q1", "G10 L1 P2 Z5\nT2 M6\nG43 H2", "G49 H1"}) {
    CAPTURE(line);
    const std::string error = read(line, dialect).error;
    CHECK(error.find("names a tool") == std::string::npos);
    CHECK(read(line, dialect).all<gcode::Warning>().empty());
  }
  const auto warnings = [](const std::string& text) {
    std::string all;
    const auto reading = read(text);
    for (const auto& warning : reading.all<gcode::Warning>())
      all += gcode::to_text("", warning.about, "warning") + '\n';
    return all + reading.error;
  };
  const std::string sentence = " names a tool, and there is no tool table: its length and diameter are 0\n";
  CHECK(warnings("G0 X1\nT1 M6\nG43 H1\nT2 M6\nG41 D3") == "2:1: warning: T1" + sentence);
  CHECK(warnings("G43 H1") == "1:5: warning: H1" + sentence);
  CHECK(warnings("G41 D1") == "1:5: warning: D1" + sentence);
  CHECK(warnings("T0 M6\nG43\nG41\nG40\nG41.1 D6").empty());
  CHECK(warnings("G10 L1 P7 Z3\nT7 M6\nG43 H7").empty());
}

TEST_CASE("X words are diameters under G7") {
  const auto ends = read("G7 G0 X8 Z1\nG91 X2\nG8 X2").motions();
  REQUIRE(ends.size() == 3);
  CHECK(ends[0].end[0] == 4);
  CHECK(ends[1].end[0] == 5);
  CHECK(ends[2].end[0] == 7);
}

TEST_CASE("a feed per revolution is a feed at the spindle's speed") {
  const auto feed = [](const std::string& text) { return read(text).motions().back().feed.value(); };
  CHECK(feed("G95 S600 G1 X1 F.5") == Approx(5.0));
  CHECK(feed("S600\nG20 G95 G1 X1 F.01") == Approx(2.54));
  CHECK(feed("G95 S600 G1 X1 F.5\nS1200 X2") == Approx(10.0));
  CHECK(read("G95 S600 G1 X1 F.5").motions()[0].feed_mode == gcode::FeedMode::per_minute);
  CHECK(read("G95 S600 G1 X1 F.5\nG94 X2").error == "2:5: F: a required word is missing");
  // 60 m/min at 20 mm of radius: 1 m/s over 0.04 pi m a turn
  CHECK(feed("G95 G96 S60 G0 X20\nG1 Z-5 F.4") == Approx(0.4 / (0.04 * M_PI)));
  CHECK(feed("G95 G96 S60 D120 G0 X20\nG1 Z-5 F.4") == Approx(0.8));
  CHECK(feed("G95 G96 S60 G0 X20\nG97 S300 G1 Z-5 F.4") == Approx(2.0));
  CHECK(read("G96 D2500 S180").all<Word>() ==
        std::vector<Word>{{'S', 180, 1, 11}, {'G', 96, 1, 1, {{'D', 2500}}}});
}

TEST_CASE("a probing move goes to its end, with one warning") {
  const auto reading = read("G38.2 Z-5 F60\nG38.3 Z-6\nG1 Z0");
  const auto motions = reading.motions();
  REQUIRE(motions.size() == 3);
  CHECK(motions[0].probe);
  CHECK(motions[1].probe);
  CHECK_FALSE(motions[2].probe);
  CHECK(motions[1].end[2] == -6);
  const auto warnings = reading.all<gcode::Warning>();
  REQUIRE(warnings.size() == 1);
  CHECK(gcode::to_text(warnings[0].about) == "G38.2 goes to its end: no contact is known");
}
