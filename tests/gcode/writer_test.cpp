#include "cncplan/gcode/writer.hpp"

#include <fstream>
#include <sstream>
#include <string>

#include "cncplan/gcode/stream_lines.hpp"
#include "gcode/support.hpp"
#include "support/catch.hpp"
#include "support/no_heap.hpp"
#include "support/random.hpp"
#include "support/shared.hpp"

using namespace cncplan;
using gcode::AxisKind;
using gcode::Dialect;
using gcode::Item;
using gcode::Motion;

namespace {

std::string written(const std::vector<Item>& items, const Dialect& dialect = {}) {
  std::string text;
  gcode::Writer writer(dialect);
  for (const Item& item : items) REQUIRE(writer.write(item, std::back_inserter(text)));
  writer.finish(std::back_inserter(text));
  return text;
}

/// Without what a text of its own cannot keep: the place in the text it came from.
Item placeless(Item item) {
  std::visit(
      [](auto& value) {
        if constexpr (requires { value.line; }) value.line = 0;
        if constexpr (requires { value.column; }) value.column = 0;
      },
      item);
  return item;
}

std::vector<Item> placeless(const std::vector<Item>& items) {
  std::vector<Item> found;
  for (const Item& item : items)
    if (!std::holds_alternative<gcode::Warning>(item)) found.push_back(placeless(item));
  return found;
}

/// Index of the first item that differs, or -1.
int first_difference(const std::vector<Item>& a, const std::vector<Item>& b) {
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i)
    if (i >= a.size() || i >= b.size() || !(a[i] == b[i])) return static_cast<int>(i);
  return -1;
}

void check_round_trip(const std::vector<Item>& items, const Dialect& dialect = {}) {
  const std::string text = written(items, dialect);
  const auto again = test::read(text, dialect);
  CAPTURE(text);
  CHECK(again.error == "");
  CHECK(first_difference(placeless(items), placeless(again.items)) == -1);
}

/// A line of a program, whatever may stand on one.
std::string random_line(test::Random& random, bool rotary) {
  const auto number = [&](double range) {
    char text[32];
    std::snprintf(text, sizeof text, "%.*f", random.integer(0, 7), random.uniform(-range, range));
    return std::string(text);
  };
  const auto feed = [&] { return " F" + std::to_string(random.uniform(1, 9000)); };
  std::string line;
  switch (random.integer(0, 9)) {
    case 0:
      line += random.coin() ? "G20 " : "G21 ";
      break;
    case 1:
      line += random.coin() ? "G90 " : "G91 ";
      break;
    case 2:
      line += "G64 P" + number(0.1) + " Q" + number(0.1);
      std::erase(line, '-');
      line = random.coin() ? line + '\n' : random.coin() ? "G61 " : random.coin() ? "G61.1 " : "G64\n";
      break;
    case 3:
      line += random.coin() ? "G90.1 " : "G91.1 ";
      break;
    case 4:
      line += "G1" + std::to_string(random.integer(7, 9)) + '\n';
      break;
    default:
      break;
  }
  switch (random.integer(0, 7)) {
    case 0:
      return line + "G4 P" + std::to_string(random.uniform(0, 2));
    case 1:
      return line + "M" + std::to_string(random.integer(3, 5)) + " S" +
             std::to_string(random.integer(0, 9000));
    case 2:
      return line + "G93 G1 X" + number(50) + feed() + "\nG94 F500.1";
    case 3:
      line += "G0 X" + number(100) + " Y" + number(100);
      break;
    case 4:
    case 5:
      line += "G1 X" + number(100) + " Z" + number(100) + (random.coin() ? feed() : "");
      break;
    case 6:
      line += "G2 X" + number(100) + " Y" + number(100) + " Z" + number(9) + " R" + number(1000) + feed();
      break;
    default:
      line += "G17 G3 X" + number(100) + " Z" + number(9) + " I" + number(100) + " J" + number(50) + " P" +
              std::to_string(random.integer(1, 4)) + feed();
  }
  if (rotary) line += " A" + number(400) + " C" + number(400);
  return line;
}

}  // namespace

TEST_CASE("what is written is short") {
  CHECK(
      written(
          test::read(
              "%\nO12\nG0 X1\nG1 X2 F100\nX3\nG2 X5 Y2 R2\nG3 X0 Y0 I-2.5 J-1\nT1 M6\nS500 M3\nG4 P1.5\nM30")
              .items) ==
      "O12\nG17 G21 G40 G49 G64 G90 G90.1 G94 G54\nG0 X1\nF100 G1 X2\nX3\nG2 X5 Y2 R2\n"
      "G3 X0 Y0 I2.5 J1\nT1\nM6\nS500 M3\nG4 P1.5\nM30\n");
  CHECK(written({}).empty());
}

TEST_CASE("real programs read back bit for bit") {
  const auto folder = test::shared();
  if (!folder) {
    WARN("SKIPPED: CNCPLAN_SHARED is not set");
    return;
  }
  for (const char* name :
       {"3dtest", "51MeanderAve", "Cereal", "arcspiral", "cds", "lathe_pawn", "test_12mmflat", "tort"}) {
    INFO(name);
    std::ifstream stream(*folder + "/data/ngc/" + name + ".ngc");
    std::stringstream text;
    text << stream.rdbuf();
    const auto reading = test::read(text.str());
    REQUIRE(reading.error.empty());
    REQUIRE(reading.items.size() > 40);
    check_round_trip(reading.items);
  }
}

TEST_CASE("random programs read back bit for bit") {
  test::Random random;
  Dialect turning;
  turning.axes.push_back({'A', AxisKind::rotary});
  turning.axes.push_back({'C', AxisKind::rotary});
  for (int program = 0; program < 40; ++program) {
    const bool rotary = program % 2 != 0;
    const Dialect& dialect = rotary ? turning : Dialect{};
    std::string text;
    for (int i = 0; i < 200; ++i) text += random_line(random, rotary) + '\n';
    const auto reading = test::read(text, dialect);
    INFO(reading.error);
    REQUIRE(reading.error.empty());
    check_round_trip(reading.items, dialect);
  }
}

TEST_CASE("offsets read back, whatever they were made of") {
  Dialect dialect;
  dialect.work_offsets[0] = {1.1, 2.2, 3.3};
  dialect.work_offsets[1] = {0.1, 0.7, 0.3};
  dialect.tools = {{1, 12.34}};
  const auto reading = test::read(
      "G0 X1 Y1 Z1\nG55 X2\nG43 H1\nG1 X3 Y.1 F10\nG92 X.1\nX.7\nG2 X3 I1 J2\nG49 G1 X5\nG53 G0 X7\n",
      dialect);
  REQUIRE(reading.error.empty());
  const auto again = test::read(written(reading.items, dialect), dialect);
  REQUIRE(again.error.empty());
  const auto expected = reading.motions();
  const auto found = again.motions();
  REQUIRE(found.size() == expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    CHECK(found[i].offset == expected[i].offset);
    CHECK(found[i].end == expected[i].end);
    CHECK(found[i].center == expected[i].center);
    for (std::size_t axis = 0; axis < 3; ++axis)
      CHECK(std::abs(found[i].start[axis] - expected[i].start[axis]) < 1e-14);
  }
}

TEST_CASE("words that belong together stay on one line") {
  Dialect dialect;
  dialect.pass_through = {{'G', 5.0}};
  check_round_trip(test::read("G5 P10000 Q3\nG0 X1\nG5 P1\nG5\n", dialect).items, dialect);
  CHECK(written(test::read("G5 P10000 Q3\n", dialect).items, dialect).ends_with("\nG5 P10000 Q3\n"));
}

TEST_CASE("a tap's turns of the spindle are written on lines of their own") {
  const auto tap = test::read("G0 X1 Y1 Z5\nS900 M3\nG84 X2 Z-1 R2 P0.5 F9\n");
  check_round_trip(tap.items);
  const auto at_the_bottom = test::read("S9 M3\nF9 G84 X1 Z0 R0 P1\n");
  check_round_trip(at_the_bottom.items);
}

TEST_CASE("a centre's letter behind a passed-through code is no arc where one holds") {
  const auto reading = test::read("G2 X20 I5\nG1\nM482 I5 Q2\nG2 X30 I5\n");
  REQUIRE(reading.all<gcode::Word>().size() == 1);
  REQUIRE(reading.motions().size() == 2);
  check_round_trip(reading.items);
}

TEST_CASE("codes are written with their words, and read back with them") {
  Dialect dialect;
  dialect.pass_through = {{'M', 201.0, gcode::bits("XYZEF")}, {'M', 88.0}, {'G', 251.0}};
  const auto reading = test::read(
      "G1 X1 F600\nM201 X500 Y500\nM67 E1 Q-2.5\nG1 X2 M88 T3 P4\nM101 P1 Q2\nX3 M102 P1\nG2 X5 I1\nG251 L3\n"
      "G80 M88 I5\nG2 X9 I2 M201 M67 E0 Q0 T1\nM19 R90 $1\nS5 M62 P1\nG96 D900 S20\nM201 F9\nG1 X5 F9 "
      "M102\nM88 G1 X6 G96 D900 S20 T1\n",
      dialect);
  REQUIRE(reading.error == "");
  REQUIRE(reading.all<gcode::Word>().size() == 22);
  check_round_trip(reading.items, dialect);
}

TEST_CASE("what cannot be written is refused") {
  gcode::Writer writer;
  std::string text;
  const auto error = [&](const Item& item) { return writer.write(item, std::back_inserter(text)).error(); };
  Motion motion;
  motion.end[1] = NAN;
  CHECK(error(motion).code == ErrorCode::not_finite);
  CHECK(error(motion).field == "Y");
  motion.end[1] = 1e16;
  CHECK(error(motion).code == ErrorCode::above_limit);
  motion = {};
  motion.start[2] = 1.0;
  CHECK(error(motion).code == ErrorCode::discontinuous);
  CHECK(error(motion).field == "Z");
  motion = {};
  motion.feed = INFINITY;
  CHECK(error(motion).field == "F");
  motion.feed = 2e13;  // more than 1e15 mm/min
  CHECK(error(motion).code == ErrorCode::above_limit);
  CHECK(error(gcode::Dwell{NAN, 1}).code == ErrorCode::not_finite);
  CHECK(error(gcode::Dwell{INFINITY, 1}).field == "P");
  CHECK(error(gcode::Dwell{-1.0, 1}) == Error{ErrorCode::negative, "P", -1.0, 0.0});
  CHECK(error(gcode::Word{'S', INFINITY, 1, 1}) == Error{ErrorCode::not_finite, "S", INFINITY, 1e15});
  CHECK(error(gcode::Word{'O', 1e16, 1, 1}).code == ErrorCode::above_limit);
  CHECK(error(gcode::Word{'M', 67, 1, 1, {{'Q', INFINITY}}}) ==
        Error{ErrorCode::not_finite, "Q", INFINITY, 1e15});
  CHECK(text.empty());
}

TEST_CASE("no text ends a feed, which a thread has without F") {
  const auto thread = test::read("S60 M3\nG33 Z-1 K1\nG1 X2\n");
  REQUIRE(thread.error == "");
  std::string text;
  gcode::Writer writer;
  int refused = 0;
  for (const Item& item : thread.items)
    if (const auto ok = writer.write(item, std::back_inserter(text)); !ok) {
      CHECK(ok.error() == Error{ErrorCode::missing_word, "F"});
      ++refused;
    }
  CHECK(refused == 1);
}

TEST_CASE("writing does not touch the heap") {
  gcode::Writer writer;
  std::array<char, 4096> buffer;
  Motion motion;
  motion.kind = gcode::MotionKind::line;
  motion.end = {0.1, 1e-300, 12345.678901234567};
  motion.feed = 254.0 / 60.0;
  motion.offset = {0.1, 0.2, 0.3};
  motion.start = {-0.1, -0.2, -0.3};
  CHECK(test::heap_allocations_of([&] { CHECK(writer.write(motion, buffer.data())); }) == 0);
}

TEST_CASE("a decimal is found again") {
  test::Random random;
  int lost = 0;
  for (int i = 0; i < 10000; ++i) {
    const double decimal = random.integer(1, 99999) / 1000.0;
    const auto degrees = [](double number) { return number * gcode::radians_per_degree; };
    const auto found =
        gcode::find_decimal(degrees(decimal), degrees(decimal) / gcode::radians_per_degree, degrees);
    lost += found.exact && found.number == decimal ? 0 : 1;
  }
  CHECK(lost == 0);
}

TEST_CASE("the $ of a spindle goes with its S and with its M3, a tool change between them or not") {
  const auto told = [](const std::string& text) {
    const auto reading = test::read(text);
    REQUIRE(reading.error.empty());
    std::ostringstream result;
    for (const auto& item : reading.items) {
      if (const auto* word = std::get_if<gcode::Word>(&item)) {
        result << word->letter << word->number << ' ';
        if (const auto spindle = word->arguments.find('$')) result << '$' << *spindle << ' ';
      }
      if (const auto* stop = std::get_if<gcode::Stop>(&item)) result << "stop " << stop->code << ' ';
    }
    return result.str();
  };
  for (const auto& [line, items] : {std::pair("$1 M3", "M3 $1 "),
                                    {"$1 S9 M3", "S9 $1 M3 $1 "},
                                    {"$1 M6 M3", "stop 6 M3 $1 "},
                                    {"$1 S9 T2 M6 M3", "S9 $1 T2 stop 6 M3 $1 "}}) {
    INFO(line);
    CHECK(told(line) == items);
    const std::string text = written(test::read(line).items);
    INFO(text);
    CHECK(told(text) == items);
  }
}

TEST_CASE("a motion of the tool point needs the code that begins it") {
  gcode::Writer writer;
  std::string text;
  const auto written =
      writer.write(Item(Motion{.end = {1}, .feed = 1.0, .tool_point = 0.0}), std::back_inserter(text));
  REQUIRE_FALSE(written);
  CHECK(to_text(written.error()) == "motion of the tool point without M428: 0 is not supported");
  CHECK(text.empty());
}
