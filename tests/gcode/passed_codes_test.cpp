// Codes that are handed on: whose the words beside them are, in every dialect and wherever a line stands.
#include <string>
#include <vector>

#include "cncplan/gcode/controls.hpp"
#include "cncplan/gcode/language/program_lines.hpp"
#include "gcode/support.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"

using namespace cncplan;
using gcode::Dialect;
using gcode::Word;

namespace {

Dialect dialect_of(std::string_view control) { return gcode::with({}, *gcode::find_control(control)); }

const std::vector<std::string> all_controls{"linuxcnc", "grbl", "fanuc", "marlin", "mach3"};

/// The error of a program; "" for none.
std::string error(const std::string& text, const Dialect& dialect = {}) {
  return test::read(text, dialect).error;
}

}  // namespace

TEST_CASE(
    "a word beside an unknown M code is not a motion's, a feed or a tool, unless a code on the line takes "
    "it") {
  // Every state a line may find, and every word that acts without a code of its own.
  for (const std::string before :
       {"", "G0 X1\n", "G1 X1 F60\n", "G2 X2 I1 F60\n", "G81 X1 Y1 Z-1 R1 F60\n", "G80\n", "G91 G1 X1 F60\n"})
    for (const std::string control : {"linuxcnc", "grbl", "mach3", "marlin"})
      for (const std::string word : {"X5", "Y-5", "Z0", "F900", "T1", "X5 Y5", "X1 F5"})
        for (const std::string& line : {"M88 " + word, word + " M88", "N5 M88" + word, "M3 S5 M88 " + word}) {
          const std::string text = before + line;
          CAPTURE(control, text);
          const auto reading = test::read(text, dialect_of(control));
          const auto motions_before = test::read(before, dialect_of(control)).motions();
          CHECK(reading.error.find("M88 is beside a word that may be its own (" + word.substr(0, 1) + ")") !=
                std::string::npos);
          CHECK(reading.motions().size() == motions_before.size());
        }
}

TEST_CASE("a code of motion on its line owns the axis words beside an unknown M code") {
  for (const std::string& control : all_controls) {
    CAPTURE(control);
    const auto reading = test::read("G1 X10 F60 M88 P4\nM88 G0 X0 T3\nG92 X3 M88\nG28 X0 M88\nG0 X1 M88 S5",
                                    dialect_of(control));
    CHECK(reading.error == "");
    CHECK(reading.motions()[0].end[0] == 10.0);
    CHECK(reading.motions()[0].feed == 1.0);
    const auto words = reading.all<Word>();
    REQUIRE(words.size() == 7);
    CHECK(words[0] == Word{'M', 88, 1, 12, {{'P', 4}}});
    CHECK(words[2].letter == 'T');
    CHECK(words[6].letter == 'S');  // a speed stays the spindle's
  }
}

TEST_CASE("a modal motion moves beside an unknown M code in Fanuc's dialect alone") {
  const auto reading = test::read("G1 X1 F60\nX10 M88\nM88 F120\nM88 Y5 T2\n", dialect_of("fanuc"));
  CHECK(reading.error == "");
  REQUIRE(reading.motions().size() == 3);
  CHECK(reading.motions()[1].end[0] == 10.0);
  CHECK(reading.motions()[2].feed == 2.0);
  for (const std::string control : {"linuxcnc", "grbl", "marlin", "mach3"})
    CHECK(error("G1 X1 F60\nX10 M88", dialect_of(control)) ==
          "2:5: M88 is beside a word that may be its own (X)");
}

TEST_CASE("P and Q belong to LinuxCNC's user codes, axis words to the modal motion") {
  const auto reading = test::read("G1 X1 F60\nM101 P1 Q-2 X5\nM199 F120 Y2 T1\n");
  CHECK(reading.error == "");
  REQUIRE(reading.motions().size() == 3);
  CHECK(reading.motions()[1].end[0] == 5.0);
  CHECK(reading.motions()[2].feed == 2.0);
  const auto words = reading.all<Word>();
  REQUIRE(words.size() == 3);
  CHECK(words[0] == Word{'M', 101, 2, 1, {{'P', 1}, {'Q', -2}}});
  CHECK(words[2].letter == 'T');
  CHECK(error("M101 X5") == "1:6: G0, G1, G2 or G3: a required word is missing");
  CHECK(error("G1 X1 F60\nM99 X5") == "2:1: M99 finds no subprogram here");
  CHECK(error("G1 X1 F60\nM200 X5") == "2:1: M200 is beside a word that may be its own (X)");
  CHECK(error("G1 X1 F60\nM101 X5", dialect_of("grbl")) ==
        "2:1: M101 is beside a word that may be its own (X)");
}

TEST_CASE("a printer's codes own their lines") {
  const Dialect marlin = dialect_of("marlin");
  const auto reading = test::read(
      "M201 X500 Y500 Z100 E5000\nM203 F9000 X200\nM104 S200 T1\nM92 X80 Y80\nM48 P4 X10 Y10\nM106 S255\n"
      "G28\nM205 X8 Z0.4 E5 B20000 S0 T0 J0.013\nM665 L250 R125 H300 S100 A0 B0 C0 X0 Y0 Z0\nM73 P10 R5\n"
      "M810 G0 X10 Y10|G1 Z5\nM23 /dir/file.gco\nM117 X5 G1\nM140 S60\nM900 K0.2 ; E5\nG1 X1 F60\nM82\nX2\n",
      marlin);
  CHECK(reading.error == "");
  CHECK(reading.all<gcode::Warning>().empty());
  REQUIRE(reading.motions().size() == 2);
  CHECK(reading.motions()[0].end == gcode::Position{1, 0, 0});
  CHECK(reading.motions()[0].feed == 1.0);
  const auto words = reading.all<Word>();
  REQUIRE(words.size() == 15);
  CHECK(words[0] == Word{'M', 201, 1, 1, {{'X', 500}, {'Y', 500}, {'Z', 100}, {'E', 5000}}});
  CHECK(words[1] == Word{'M', 203, 2, 1, {{'F', 9000}, {'X', 200}}});
  CHECK(words[2] == Word{'M', 104, 3, 1, {{'S', 200}, {'T', 1}}});
  CHECK(words[7].arguments.size() == 10);
  CHECK(words[7].arguments.find('H') == 300.0);
  CHECK(words[7].arguments.find('T') == std::nullopt);
  for (const Word& word : words) CHECK(word.letter == 'M');
  CHECK(error("M665 L250 R125 H300 S100 A0 B0 C0 X0 Y0 Z0 P1", marlin) ==
        "1:44: number of words of one code: 11 is above the limit 10");
  // A letter without a number is no place: a code of motion does not take it.
  const auto bare = test::read("G1 X1 F60\nM84 X Y E\nM155 S2 C\nG1 M18 X\nM18 X G1", marlin);
  CHECK(bare.error == "");
  CHECK(bare.motions().size() == 1);
  CHECK(bare.all<Word>() == std::vector<Word>{{'M', 84, 2, 1, {{'X', 0}, {'Y', 0}, {'E', 0}}},
                                              {'M', 155, 3, 1, {{'S', 2}, {'C', 0}}},
                                              {'M', 18, 4, 4, {{'X', 0}}},
                                              {'M', 18, 5, 1, {{'X', 0}}}});
  CHECK(error("M84 X X", marlin) == "1:7: X has no number");
  CHECK(error("M84 X Y") == "1:5: X has no number: 'Y' follows");
  CHECK(error("M56 P", dialect_of("grbl")) == "1:5: P has no number");
  // A code of motion on the line keeps what is its own.
  const auto both = test::read("G1 X5 F60 M106 S255", marlin);
  CHECK(both.motions()[0].end[0] == 5.0);
  CHECK(both.all<Word>() == std::vector<Word>{{'M', 106, 1, 11, {{'S', 255}}}});
}

TEST_CASE(
    "every M code of Marlin's table owns axis words, F, S and T, at a program's start and behind a motion") {
  const Dialect marlin = dialect_of("marlin");
  for (const std::int16_t number : gcode::detail::marlin_codes)
    for (const std::string before : {"", "G1 Y1 F60\n", "G81 X1 Y1 Z-1 R1 F60\n"}) {
      const std::string text = before + "M" + std::to_string(number) + " X500 F9 S8 T7\n";
      CAPTURE(text);
      const auto reading = test::read(text, marlin);
      CHECK(reading.error == "");
      CHECK(reading.motions().size() == test::read(before, marlin).motions().size());
      CHECK(reading.all<Word>().size() == 1);
      CHECK(reading.all<Word>()[0].arguments == gcode::Arguments{{'X', 500}, {'F', 9}, {'S', 8}, {'T', 7}});
    }
}

TEST_CASE("words to pass through own the letters that are declared, and leave others alone") {
  Dialect dialect;
  dialect.pass_through = {
      {'M', 201.0, gcode::bits("XF")}, {'M', 88.0, gcode::Letters{0}}, {'M', 62.0}, {'D', {}}};
  REQUIRE(gcode::validate(dialect));
  const auto reading =
      test::read("G1 X1 F60\nM201 X5 F9\nM201 X5 F9 Y7\nX6 M88\nM62 P3\nG1 X8 M201\nM201 D5 X9\n", dialect);
  CHECK(reading.error == "");
  REQUIRE(reading.motions().size() == 4);
  CHECK(reading.motions()[1].end[1] == 7.0);
  CHECK(reading.motions()[1].end[0] == 1.0);
  CHECK(reading.motions()[1].feed == 1.0);
  CHECK(reading.motions()[2].end[0] == 6.0);
  CHECK(reading.motions()[3].end[0] == 8.0);
  CHECK(reading.all<Word>() == std::vector<Word>{{'M', 201, 2, 1, {{'X', 5}, {'F', 9}}},
                                                 {'M', 201, 3, 1, {{'X', 5}, {'F', 9}}},
                                                 {'M', 88, 4, 4},
                                                 {'M', 62, 5, 1, {{'P', 3}}},
                                                 {'M', 201, 6, 7},
                                                 {'M', 201, 7, 1, {{'X', 9}}},
                                                 {'D', 5, 7, 6}});
  CHECK(error("G1 X1 F60\nM62 X5", dialect) == "2:1: M62 is beside a word that may be its own (X)");
  CHECK(error("M62 T5", dialect) == "1:1: M62 is beside a word that may be its own (T)");
  dialect.pass_through = {{'G', 251.0, gcode::bits("XP")}};
  CHECK(gcode::validate(dialect).error().code == ErrorCode::not_to_pass);
}

TEST_CASE("words belong to the code that stands before them") {
  CHECK(test::read("M88 P1 M89 Q2 L3").all<Word>() ==
        std::vector<Word>{{'M', 88, 1, 1, {{'P', 1}}}, {'M', 89, 1, 8, {{'Q', 2}, {'L', 3}}}});
  CHECK(error("G1 X1 F60\nG93 G80 M88 P1 F5") == "2:16: F is used by nothing on this line");
  CHECK(test::read("P1 M88").all<Word>() == std::vector<Word>{{'M', 88, 1, 4, {{'P', 1}}}});
}

TEST_CASE("behind a line that an unknown code has put in error nothing moves to its words") {
  std::vector<gcode::Item> items;
  gcode::Reader reader;
  int problems = 0;
  gcode::read_program(
      gcode::TextLines("G1 X1 F60\nM201 X500 F9000\nY2\nX3\nG0 X4 Y4"), reader,
      [&](const gcode::Item& item) { items.push_back(item); },
      [&](const gcode::Diagnostic&) { return ++problems != 0; });
  CHECK(problems == 1);
  for (const auto& item : items)
    if (const auto* motion = std::get_if<gcode::Motion>(&item)) {
      CHECK(motion->end[0] <= 4.0);
      CHECK((!motion->feed || *motion->feed == 1.0));
    }
}

TEST_CASE("the language hands codes on as the reader does") {
  std::vector<gcode::Item> items;
  gcode::Reader reader(dialect_of("marlin"));
  gcode::TextLines text("#1=500\nM201 X#1 Y[#1+1]\nM73 P10 R5\nG1 X1 F60\nM104 S[200] T1\n");
  gcode::ProgramLines lines(text, reader);
  REQUIRE(gcode::read_program(lines, reader, [&](const gcode::Item& item) { items.push_back(item); }));
  REQUIRE(items.size() == 4);
  CHECK(std::get<Word>(items[0]) == Word{'M', 201, 2, 1, {{'X', 500}, {'Y', 501}}});
  CHECK(std::get<Word>(items[1]) == Word{'M', 73, 3, 1, {{'P', 10}, {'R', 5}}});
  CHECK(std::get<Word>(items[3]) == Word{'M', 104, 5, 1, {{'S', 200}, {'T', 1}}});
}

TEST_CASE("codes are handed on without the heap") {
  gcode::Reader reader(dialect_of("marlin"));
  std::vector<gcode::Item> items(gcode::max_items_per_line);
  CHECK(test::heap_allocations_of([&] {
          CHECK(reader.read_line("M201 X500 Y500 Z100 E5000", items.data()));
          CHECK_FALSE(reader.read_line("M98 X5", items.data()));
          CHECK_FALSE(reader.read_line("M1234 X5", items.data()));
        }) == 0);
}
