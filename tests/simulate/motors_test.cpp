// What a machine file says of an axis' motors, and of the plane of G18.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "simulate/table.hpp"
#include "simulate/vcd.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

constexpr const char* program = "G1 X3 Y2 F600\nY-1\nX0\n";

// A mill whose X or Y has something more.
std::string mill(const std::string& x, const std::string& y) {
  return "[[axis]]\nletter = \"X\"\n" + x + "\n[[axis]]\nletter = \"Y\"\n" + y +
         "\n[[axis]]\nletter = \"Z\"\n";
}

// Whether two axes have the same steps, maybe the other way round.
bool same_steps(const std::vector<test::VcdEdge>& a, const std::vector<test::VcdEdge>& b, int turned = 1) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [turned](const auto& x, const auto& y) {
    return x.time == y.time && x.direction == turned * y.direction;
  });
}

test::Vcd steps_of(const test::Folder& folder, const std::string& machine, const std::string& name) {
  folder.write("m.toml", machine);
  const auto run = folder.run_text(program, "--quiet --tolerance 0 --machine m.toml --steps " + name);
  INFO(run.err);
  REQUIRE(run.exit == 0);
  return test::Vcd(folder / name);
}

}  // namespace

TEST_CASE("an inverted axis steps the other way") {
  const test::Folder folder;
  const auto inverted = steps_of(folder, mill("inverted = true", "inverted = false"), "a.vcd");
  const auto negative = steps_of(folder, mill("steps_per_unit = -400", ""), "b.vcd");
  const auto plain = steps_of(folder, mill("", ""), "c.vcd");
  CHECK(plain.axis("Y").net() == -400);
  CHECK(inverted.axis("Y").net() == -400);
  CHECK(inverted.axis("X").edges.size() == 2400);
  CHECK(same_steps(inverted.axis("X").edges, negative.axis("X").edges));
  CHECK(same_steps(inverted.axis("X").edges, plain.axis("X").edges, -1));
}

TEST_CASE("a second motor makes the steps of the first") {
  const test::Folder folder;
  const auto alike = steps_of(folder, mill("", "second_motor = {}"), "a.vcd");
  const auto faced = steps_of(folder, mill("", "second_motor = { inverted = true }"), "b.vcd");
  const auto both = steps_of(folder, mill("", "inverted = true\nsecond_motor = {}"), "c.vcd");
  REQUIRE(alike.axis("Y").edges.size() == 2000);
  CHECK(same_steps(alike.axis("Y2").edges, alike.axis("Y").edges));
  CHECK(faced.axis("Y").net() == -400);
  CHECK(faced.axis("Y2").net() == 400);
  CHECK(both.axis("Y2").net() == 400);
}

TEST_CASE("an offset squares the second motor up before the program") {
  const test::Folder folder;
  const std::string limits = "velocity = 20\nacceleration = 500\njerk = 10000\n";
  const auto plain = steps_of(folder, mill("", limits), "a.vcd");
  const auto squared = steps_of(folder, mill("", limits + "second_motor = { offset = -0.25 }"), "b.vcd");
  const auto &first = squared.axis("Y").edges, &second = squared.axis("Y2").edges;
  REQUIRE(second.size() == first.size() + 100);  // 0.25 mm at 400 steps/mm
  CHECK(squared.axis("Y2").net() == -500);
  // from rest to rest over d: 4 ramps of (d / (2 J))^(1/3); the first step half a step in, at (6 s / J)^(1/3)
  const double time = 4.0 * std::cbrt(0.25 / 2e4), start = std::cbrt(6.0 / 800.0 / 1e4);
  CHECK(static_cast<double>(second[0].time) == Approx(start * 1e9).margin(1.0));
  CHECK(static_cast<double>(second[99].time) == Approx((time - start) * 1e9).margin(1.0));
  for (std::size_t i = 0; i < first.size(); ++i) {
    CHECK(second[i + 100].time == first[i].time);
    CHECK(static_cast<double>(first[i].time - plain.axis("Y").edges[i].time) ==
          Approx(time * 1e9).margin(2.0));
  }
}

TEST_CASE("the printed G18 turns arcs the other way") {
  const test::Folder folder;
  for (const auto& [key, plane] : {std::pair{"", 1.0}, {"g18 = \"zx\"\n", 1.0}, {"g18 = \"xz\"\n", -1.0}}) {
    folder.write("m.toml", std::string(key) + mill("", ""));
    const auto run = folder.run_text("G18 G3 X10 Z10 I10 K0 F600\n",
                                     "--json --machine m.toml --motions m.csv --count-steps");
    INFO(run.err << key);
    REQUIRE(run.exit == 0);
    // seen from +Y, G3 goes from Z to X: from (x, z) = (0, 0) round (10, 0) to (10, 10) that is a quarter one
    // way and three quarters the other
    const test::Table motions(folder / "m.csv");
    const double quarters = motions["length"][0] / (10 * std::acos(-1.0) / 2);
    CHECK(quarters == Approx(plane > 0 ? 1.0 : 3.0));
  }
}

TEST_CASE("wrong motors and planes are refused where they stand") {
  const test::Folder folder;
  const std::string limits = "velocity = 20\nacceleration = 500\njerk = 10000\n";
  struct Case {
    std::string machine, error;
  };
  for (const auto& [machine, error] :
       {Case{mill("inverted = 1", ""), "m.toml:3:12: error: inverted must be true or false"},
        {mill("steps_per_unit = -400\ninverted = true", ""),
         "m.toml:4:12: error: inverted and a negative steps_per_unit say the same"},
        {mill("second_motor = 2", ""), "m.toml:3:16: error: second_motor must be a table"},
        {mill("second_motor = { offest = 1 }", ""),
         "m.toml:3:18: error: unknown key 'offest' in second_motor"},
        {mill("second_motor = { inverted = 0 }", ""), "m.toml:3:29: error: inverted must be true or false"},
        {mill("second_motor = { offset = \"1\" }", ""), "m.toml:3:27: error: offset must be a number"},
        {mill("second_motor = { offset = 1 }", ""),
         "m.toml:3:27: error: an axis with an offset needs velocity, acceleration and jerk"},
        {mill(limits + "second_motor = { offset = 9e9 }", ""),
         "m.toml:6:27: error: offset must not be more than 1000000 steps"},
        {"g18 = \"yz\"\n" + mill("", ""), "m.toml:1:7: error: g18 must be \"zx\" or \"xz\""}}) {
    folder.write("m.toml", machine);
    const auto run = folder.run_text(program, "--quiet --machine m.toml");
    CHECK(run.exit == 2);
    CHECK(run.err == error + "\n");
  }
}
