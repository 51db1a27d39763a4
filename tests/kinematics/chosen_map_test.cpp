// A map that is chosen while the program runs plans as the plain one, to the last bit.
#include <algorithm>
#include <string>
#include <vector>

#include "cncplan/plan_program.hpp"
#include "maps/maps.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

template <class Map>
MappedMachine<Map> machine_of(const kinematics::HeadHeadBC& map) {
  MappedMachine<Map> machine{.map = map, .limits = {.velocity = 80, .acceleration = 1000, .jerk = 20000}};
  for (auto& axis : machine.axes) axis.velocity = 100, axis.acceleration = 1000, axis.jerk = 20000;
  return machine;
}

}  // namespace

TEST_CASE("a program takes as long on a map chosen at run time as on the plain map, at every level",
          "[maps]") {
  const kinematics::HeadHeadBC head{.pivot_length = 150, .tool_length = 60};
  const auto plain = machine_of<kinematics::HeadHeadBC>(head);
  const auto chosen = machine_of<kinematics::FiveAxes>(head);
  const std::string text =
      "F3000\nG1 X5\nG43.4\nG1 X40 B20 C30\nY30\nG3 X20 Y50 I-20 J0\nG1 Y20 Z-5 B-50 C400\n"
      "G43.5 I0.3 J0.4 K0.8 X3\nX1 I0 K1\nG0 X0 Y0 Z30 B0 C0\n";
  for (const SmoothLevel level : {SmoothLevel::exact, SmoothLevel::good, SmoothLevel::best}) {
    CAPTURE(to_text(level));
    const PlanOptions options{.tolerance = level == SmoothLevel::exact ? 0.0 : 0.02, .level = level};
    const auto one = plan_text(text, plain, options);
    const auto other = plan_text(text, chosen, options);
    REQUIRE(one);
    REQUIRE(other);
    CHECK(one->duration() == other->duration());
    CHECK(one->fallbacks().size() == other->fallbacks().size());
    for (int k = 0; k <= 100; ++k) {
      const double time = one->duration() * k / 100;
      const auto a = one->at(time), b = other->at(time);
      CHECK((a.position == b.position && a.jerk == b.jerk && a.tool == b.tool));
    }
  }
}

TEST_CASE("letters of a map chosen at run time are those of the program", "[maps]") {
  const auto chosen = machine_of<kinematics::FiveAxes>({.pivot_length = 150});
  CHECK(plan_text("F3000\nG43.4\nG1 X40 B20\n", chosen));
  CHECK(!plan_text("F3000\nG43.4\nG1 X40 A20\n", chosen));
}
