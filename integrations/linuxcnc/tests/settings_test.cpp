// SPDX-License-Identifier: GPL-2.0-or-later
// What the ini and the module's parameters must say, and what is said where they do not.
#include <string>

#include "run.hpp"
#include "support/catch.hpp"

using namespace cncplan::linuxcnc;
using namespace cncplan::linuxcnc::test;

namespace {

void check_refused(const HostOptions& options, const std::string& text) {
  CHECK_FALSE(load_module(options));
  INFO(printed());
  CHECK(printed().find(text) != std::string::npos);
}

// s for 20 mm along X at 15 mm/s.
double time_of_line(const HostOptions& options) {
  Host host(options);
  CanonMove move;
  move.end[0] = 20.0;
  move.feed = 15.0;
  const Run run = drive(host, {move});
  REQUIRE(run.ended);
  return 1e-3 * static_cast<double>(run.samples.size());
}

}  // namespace

TEST_CASE("the module refuses what it cannot use, with the name of it") {
  HostOptions none;
  none.jerk = "";
  check_refused(none, "axis X has no jerk limit: set [AXIS_X]MAX_JERK");
  HostOptions word;
  word.jerk = "fast";
  check_refused(word, "jerk: 'fast' is no number above 0");
  HostOptions negative;
  negative.more_ini = "[AXIS_Y]\nMAX_JERK = -5\n";
  check_refused(negative, "[AXIS_Y]MAX_JERK: '-5'");
  HostOptions rotary;
  rotary.coordinates = "XYZA";
  check_refused(rotary, "axis A has no jerk limit");
  HostOptions unit;
  unit.linear_units = "parsec";
  check_refused(unit, "LINEAR_UNITS is no unit");
  HostOptions letter;
  letter.coordinates = "XYQ";
  check_refused(letter, "COORDINATES: 'XYQ'");
  HostOptions tolerance;
  tolerance.tolerance = "0";
  check_refused(tolerance, "tolerance: '0'");
  HostOptions level;
  level.level = "best";
  check_refused(level, "level: 'best' is neither fast nor good");
  level.level = "good";
  level.coordinates = "XYZU";
  check_refused(level, "level: good is for X Y Z A B C");
}

TEST_CASE("an axis' MAX_JERK goes before the parameter, the tool's MAX_LINEAR_JERK holds for all") {
  // 15 mm/s from rest and back: 2 sqrt(v / J) each where the acceleration limit is not reached
  const auto expected = [](double jerk) {
    if (tested_level() == "good") jerk *= 0.95;  // the rest is for holds
    const double ramp = 2.0 * std::sqrt(15.0 / jerk);
    return 20.0 / 15.0 + ramp;
  };
  CHECK(time_of_line({}) == Approx(expected(1e4)).margin(0.02));
  HostOptions slow;
  slow.more_ini = "[AXIS_X]\nMAX_JERK = 500\n[AXIS_Y]\nMAX_JERK = 20000\n";
  CHECK(time_of_line(slow) == Approx(expected(500.0)).margin(0.02));
  HostOptions tool;
  tool.more_ini = "MAX_LINEAR_JERK = 1000\n";
  CHECK(time_of_line(tool) == Approx(expected(1000.0)).margin(0.02));
}

TEST_CASE("the tool keeps [TRAJ]MAX_LINEAR_VELOCITY") {
  HostOptions options;
  options.more_ini = "MAX_LINEAR_VELOCITY = 8\n";
  Host host(options);
  CanonMove move;
  move.end.head<2>() << 20.0, 20.0;
  move.feed = 25.0;
  const Run run = drive(host, {move});
  REQUIRE(run.ended);
  CHECK(std::hypot(peaks(run, 0).velocity, peaks(run, 1).velocity) == Approx(8.0));
}
