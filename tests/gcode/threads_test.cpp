// Motions that follow the spindle: G33, G33.1, G76, and taps. Expected steps were written down from
// LinuxCNC's documentation and from what its rs274 prints; linuxcnc_test.cpp runs it where it is installed.
#include <string>
#include <vector>

#include "gcode/support.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

double feed_of(std::string_view program) {
  const auto reading = test::read(program);
  INFO(reading.error);
  REQUIRE_FALSE(reading.motions().empty());
  return reading.motions().back().feed.value_or(-1.0);
}

/// M words and motions (rapid or feed, to Z), in order.
std::string steps(std::string_view program) {
  const auto reading = test::read(program);
  std::string all = reading.error;
  for (const gcode::Item& item : reading.items) {
    if (const auto* motion = std::get_if<gcode::Motion>(&item))
      all.append(motion->kind == gcode::MotionKind::rapid ? " r" : " f")
          .append(std::to_string(std::lround(motion->end[2] * 1000.0)));
    if (const auto* word = std::get_if<gcode::Word>(&item); word != nullptr && word->letter == 'M')
      all += " M" + std::to_string(std::lround(word->number));
    if (std::holds_alternative<gcode::Dwell>(item)) all += " d";
  }
  return all;
}

}  // namespace

TEST_CASE("a feed that follows the spindle is its pitch times the speed") {
  CHECK(feed_of("M3 S600\nG33 Z-5 K1.25") == Approx(12.5));     // 10 turns a second
  CHECK(feed_of("G20 M3 S600\nG33 Z-5 K.05") == Approx(12.7));  // inches
  CHECK(feed_of("M3 S600\nG33 Z-5 K1 S1200") == Approx(20.0));  // of its own line
  CHECK(feed_of("G96 S100 D900 M3\nG0 X50\nG33 X50 Z-5 K1") ==  // surface speed at X50
        Approx(100e3 / (2.0 * 3.14159265358979 * 50.0) / 60.0));
  CHECK(feed_of("G96 S0 M3\nG0 X50\nS100\nG33 X50 Z-5 K1") ==  // S goes on to be one until G97
        Approx(100e3 / (2.0 * 3.14159265358979 * 50.0) / 60.0));
  CHECK(feed_of("G96 S9 M3\nG97 S600\nG33 Z-5 K1") == Approx(10.0));
  CHECK(feed_of("M3 S600\nG1 F60 X1\nG33 Z-5 K1\nG1 X2") == Approx(1.0));  // F holds on
}

TEST_CASE("what follows the spindle says once that it does not") {
  const auto reading = test::read("M3 S600\nG33 Z-5 K1\nG33 Z-9 K1");
  REQUIRE(reading.all<gcode::Warning>().size() == 1);
  CHECK(gcode::to_text("", reading.all<gcode::Warning>()[0].about, "warning") ==
        "2:1: warning: G33 moves at the speed that S gives: the spindle itself is not followed");
}

TEST_CASE("a rigid tap goes in and comes back with the spindle turned round") {
  CHECK(steps("M3 S60\nG33.1 Z-5 K1") == " M3 f-5000 M4 f0 M3");
  CHECK(steps("M4 S60\nG33.1 Z-5 K1") == " M4 f-5000 M3 f0 M4");
  CHECK(feed_of("M3 S60\nG33.1 Z-5 K1 I3") == Approx(3.0));  // back at three times the speed
}

TEST_CASE("taps stop, turn round, wait, and come out by the feed") {
  const std::string head = "F1 S60 G99 G0 Z2 M3\n";
  CHECK(steps(head + "G84 Z-1 R2") == " M3 r2000 f-1000 M5 M4 f2000 M5 M3");
  CHECK(steps(head + "G84 Z-1 R2 P.5") == " M3 r2000 f-1000 M5 M4 d f2000 M5 M3");
  CHECK(steps("F1 S60 G99 G0 Z2 M4\nG74 Z-1 R2") == " M4 r2000 f-1000 M5 M3 f2000 M5 M4");
  CHECK(steps("F1 G98 G0 Z9\nG84 Z-1 R2") == " r9000 r2000 f-1000 f9000");  // a spindle that stands
}

TEST_CASE("the $ of a tap or a thread may name spindle 0, and does not come out") {
  for (const std::string motion : {"G74 Z-3 R1 $0", "F1 G84 X0 Z-3 R1 $0", "S9 M3\nG33 Z-5 K1 $0"}) {
    INFO(motion);
    const auto reading = test::read("F1\n" + motion);
    CHECK(reading.error.empty());
    for (const auto& word : reading.all<gcode::Word>()) CHECK(word.letter != '$');
  }
  CHECK(test::read("F1\nG74 Z-3 R1 $1").error == "2:12: $ is not supported");
  CHECK(test::read("S9 M3\nG33 Z-5 K1 $1").error == "2:12: $ is not supported");
  CHECK(test::read("S9 $1 M3").all<gcode::Word>() ==
        std::vector<gcode::Word>{{'S', 9, 1, 1, {{'$', 1}}}, {'M', 3, 1, 7, {{'$', 1}}}});
  CHECK(test::read("G95 F1 S9 $1 M3 G1 X1").error == "1:17: S: a required word is missing");
  CHECK(test::read("G95 F1 S9\nS5 $1 G1 X1").motions()[0].feed == 9.0 / 60.0);
}

TEST_CASE("a thread is cut pass by pass to its depth") {
  // Two passes: 0.3 deep, then the full 0.4; and one spring pass. The crest is 1 inside the start.
  const auto reading = test::read("G18 S60 M3\nG0 X10 Z0\nG76 P1 Z-8 I-1 J.3 K.4 H1");
  std::string places = reading.error;
  for (const auto& motion : reading.motions())
    places.append(motion.kind == gcode::MotionKind::rapid ? "r" : "f")
        .append(std::to_string(std::lround(motion.end[0] * 10.0)))
        .append(",")
        .append(std::to_string(std::lround(motion.end[2])))
        .append(" ");
  CHECK(places ==
        "r100,0 "
        "r101,0 r87,0 f87,-8 r101,-8 "
        "r100,0 r86,0 f86,-8 r100,-8 "
        "r100,0 r86,0 f86,-8 r100,-8 ");
}

TEST_CASE("with R2 the passes of a thread deepen by the square root of their number") {
  const auto reading = test::read("G18 S60 M3\nG0 X10 Z0\nG76 P1 Z-8 I-1 J.3 K.85 R2");
  std::vector<double> depths;  // of the cuts
  for (const auto& motion : reading.motions())
    if (motion.kind == gcode::MotionKind::line) depths.push_back(9.0 - motion.end[0]);
  REQUIRE(depths.size() == 9);
  for (std::size_t pass = 1; pass < 9; ++pass)
    CHECK(depths[pass - 1] == Approx(0.3 * std::sqrt(static_cast<double>(pass))));
  CHECK(depths[8] == Approx(0.85));
}

TEST_CASE("a pass that reaches the depth but for a rounding is the last one") {
  // 0.1 * 27^(1 / 1.5) = 0.9.
  const auto reading = test::read("G18 S60 M3\nG0 X10 Z0\nG76 P1 Z-8 I-1 J.1 K.9 R1.5");
  std::size_t cuts = 0;
  for (const auto& motion : reading.motions())
    if (motion.kind == gcode::MotionKind::line) ++cuts;
  CHECK(cuts == 27);
}

TEST_CASE("tapers of a thread keep the turns of the spindle along their own length") {
  const auto reading = test::read("G18 S60 M3\nG0 X10\nG76 P1 Z-8 I-1 J.3 K.4 E.3 L3");
  int tapered = 0;
  for (const auto& motion : reading.motions()) {
    if (motion.kind != gcode::MotionKind::line) continue;
    const double across = motion.end[0] - motion.start[0];
    if (across == 0.0 || motion.end[2] == motion.start[2]) continue;
    ++tapered;
    CHECK(std::abs(motion.end[2] - motion.start[2]) == Approx(0.3));
    CHECK(*motion.feed == Approx(std::hypot(0.3, 0.4) / 0.3));
  }
  CHECK(tapered == 4);  // in and out, of two passes
}
