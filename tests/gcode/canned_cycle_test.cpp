// Canned cycles as LinuxCNC makes them: expected steps were written down from its documentation and from what
// its rs274 prints; linuxcnc_test.cpp runs it where it is installed.
#include "cncplan/gcode/detail/canned_cycle.hpp"

#include <string>

#include "gcode/support.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

/// What a program does, step by step: r and f with the place for rapids and feeds, d for dwells, w for words.
std::string steps(std::string_view text) {
  const auto reading = test::read(text);
  std::string all = reading.error;
  const auto number = [](double value) {
    std::string digits = std::to_string(value);
    digits.erase(digits.find_last_not_of('0') + 1);
    if (digits.back() == '.') digits.pop_back();
    return digits;
  };
  for (const gcode::Item& item : reading.items) {
    if (!all.empty()) all += ' ';
    if (const auto* motion = std::get_if<gcode::Motion>(&item))
      all.append(1, motion->kind == gcode::MotionKind::rapid ? 'r' : 'f')
          .append(number(motion->end[0]) + ',' + number(motion->end[1]) + ',' + number(motion->end[2]));
    if (const auto* dwell = std::get_if<gcode::Dwell>(&item))
      all.append(1, 'd').append(number(dwell->seconds));
    if (const auto* word = std::get_if<gcode::Word>(&item))
      all.append(1, word->letter).append(number(word->number));
  }
  return all;
}

}  // namespace

TEST_CASE("a cycle drills, and goes back to where it began or to R") {
  CHECK(steps("F1 G98 G0 Z9\nG81 X1 Y2 Z-3 R2\nX5\nG99 X7\nX8") ==
        "r0,0,9 r1,2,9 r1,2,2 f1,2,-3 r1,2,9 r5,2,9 r5,2,2 f5,2,-3 r5,2,9 r7,2,9 r7,2,2 f7,2,-3 r7,2,2 "
        "r8,2,2 f8,2,-3 r8,2,2");
  CHECK(steps("F1 G98 G81 X1 Z-3 R2") == "r0,0,2 r1,0,2 f1,0,-3 r1,0,2");  // up to R first
}

TEST_CASE("words that hold keep their length where the unit changes") {
  CHECK(steps("F1 G99 G20 G0 Z1\nG81 X1 Z-1 R.1\nG21 X50") ==
        "r0,0,25.4 r25.4,0,25.4 r25.4,0,2.54 f25.4,0,-25.4 r25.4,0,2.54 r50,0,2.54 f50,0,-25.4 r50,0,2.54");
}

TEST_CASE("cycles at the bottom of the hole") {
  const std::string head = "F1 G99 G0 Z2\n";
  CHECK(steps(head + "G82 Z-1 R2 P.5") == "r0,0,2 f0,0,-1 d0.5 r0,0,2");
  CHECK(steps(head + "G85 Z-1 R2") == "r0,0,2 f0,0,-1 f0,0,2");
  CHECK(steps(head + "M4 S5\nG86 Z-1 R2 P.5") == "r0,0,2 S5 M4 f0,0,-1 d0.5 M5 r0,0,2 M4");
  CHECK(steps(head + "G89 Z-1 R2 P.5") == "r0,0,2 f0,0,-1 d0.5 f0,0,2");
}

TEST_CASE("pecks") {
  const std::string head = "F1 G99 G0 Z2\n";
  CHECK(steps(head + "G83 Z-1 R2 Q2") == "r0,0,2 f0,0,0 r0,0,2 r0,0,0.254 f0,0,-1 r0,0,2");
  CHECK(steps(head + "G73 Z-1 R2 Q2") == "r0,0,2 f0,0,0 r0,0,0.254 f0,0,-1 r0,0,2");
  CHECK(steps(head + "G83 Z0 R2 Q2") == "r0,0,2 f0,0,0 r0,0,2");
}

TEST_CASE("rows of holes, in increments and in other planes") {
  CHECK(steps("F1 G99 G91 G81 X1 Y.5 Z-3 R2 L2") ==
        "r0,0,2 r1,0.5,2 f1,0.5,-1 r1,0.5,2 r2,1,2 f2,1,-1 r2,1,2");
  CHECK(steps("F1 G99 G18 G81 X1 Y-3 R2") == "r0,2,0 r1,2,0 f1,-3,0 r1,2,0");
  CHECK(steps("F1 G99 G19 G81 Y1 X-3 R2") == "r2,0,0 r2,1,0 f-3,1,0 r2,1,0");
}

TEST_CASE("words of a cycle hold until another code of motion") {
  CHECK(test::read("F1 G99 G0 Z2\nG82 X1 Z-1 R2 P1\nX2 Z-2\nG80\nX3").motions().back().kind ==
        gcode::MotionKind::rapid);
  CHECK(steps("F1 G99 G0 Z2\nG82 X1 Z-1 R2 P1\nG1 X2\nG80\nX3").starts_with("5:1: G0, G1, G2 or G3"));
  CHECK(steps("F1 G99 G0 Z2\nG82 X1 Z-1 R2 P1\nG0 X3\nG82 X2").starts_with("4:1: Z: a required word"));
  CHECK(steps("F1 G99 G0 Z2\nG82 X1 Z-1 R2 P1\nX2 Z-2\nG0 X0") ==
        "r0,0,2 r1,0,2 f1,0,-1 d1 r1,0,2 r2,0,2 f2,0,-2 d1 r2,0,2 r0,0,2");
}

TEST_CASE("a stop on the line of a cycle or a spline is behind all of its motions") {
  for (const std::string line : {"G81 X1 Y2 Z-3 R2 L2", "G5 X9 I1 J5 P-1 Q5", "G18 G76 P1 Z-8 I-1 J.3 K.4"})
    for (const int code : {0, 1, 2, 30, 60}) {
      CAPTURE(line, code);
      const auto reading = test::read("F9 S60 M3\n" + line + " M" + std::to_string(code) + "\nG1 X50\n");
      REQUIRE(reading.error == "");
      const bool ends = code == 2 || code == 30;
      std::size_t at = reading.items.size() - 1;  // of the stop
      while (at > 0 && !std::holds_alternative<gcode::Stop>(reading.items[at])) --at;
      REQUIRE(std::holds_alternative<gcode::Stop>(reading.items[at]));
      CHECK(std::get<gcode::Stop>(reading.items[at]).code == code);
      for (std::size_t i = 0; i < reading.items.size(); ++i)
        if (const auto* motion = std::get_if<gcode::Motion>(&reading.items[i]))
          CHECK((motion->line == 2) == (i < at));
      if (ends) CHECK(at + 1 == reading.items.size());
    }
}

TEST_CASE("a cycle is asked for step by step, and the next line waits for it") {
  gcode::Reader reader;
  std::array<gcode::Item, gcode::max_items_per_line> items;
  CHECK(test::read("F1 G83 X1 Z-1000 R0 Q.0099").error == "1:21: Q is below the limit 0.01");
  CHECK(test::read("F1 G83 X1 Z1000000000 R1000000001 Q.0000001").error.find("Q is below the limit") !=
        std::string::npos);
  REQUIRE(reader.read_line("F1 G99 G83 X1 Z-1e3 R0 Q1 L100", items.data()).error().column == 18);
  REQUIRE(reader.read_line("F1 G99 G83 X1 Z-1000 R0 Q1 L100", items.data()).value() == items.data());
  CHECK(reader.busy());
  CHECK(reader.read_line("G0 X5", items.data()).error().error.code == ErrorCode::unfinished);
  long motions = 0;
  for (int i = 0; i < 1000; ++i) motions += reader.go_on(items.data()) - items.data();
  CHECK(motions > 900);
  CHECK(reader.line() == 2);
}
