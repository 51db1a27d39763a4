// Drive rules of the machine file: what they cap, what they refuse, and what backlash adds.
#include <cmath>
#include <string>

#include "simulate/programs.hpp"
#include "simulate/table.hpp"
#include "simulate/vcd.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

std::string axis(char letter, const std::string& keys) {
  return std::string("[[axis]]\nletter = \"") + letter + "\"\n" + keys + "\n";
}

std::string machine(const std::string& keys) { return axis('X', keys) + axis('Y', keys) + axis('Z', keys); }

// A sensible drive for steps of 2.5 um at 30 mm/s.
const std::string sensible =
    "max_step_rate = 50000\npulse_width = 2e-6\npulse_gap = 2e-6\ndirection_setup = 5e-6\n"
    "direction_hold = 5e-6\n";

// Least time in ns between neighbouring steps of an axis, all of them or only those that turn it round.
std::int64_t closest(const test::VcdAxis& axis, bool only_reversals) {
  std::int64_t least = INT64_MAX;
  for (std::size_t i = 1; i < axis.edges.size(); ++i)
    if (!only_reversals || axis.edges[i].direction != axis.edges[i - 1].direction)
      least = std::min(least, axis.edges[i].time - axis.edges[i - 1].time);
  return least;
}

// Where a load behind `backlash` steps of play ends up, and how often it is turned round: an oracle of its
// own.
struct Load {
  std::int64_t moved = 0;
  int reversals = 0;
};
Load drag(const test::VcdAxis& axis, std::int64_t backlash) {
  Load load;
  if (axis.edges.empty()) return load;
  std::int64_t motor = 0;  // the load is dragged where the motor leaves [load, load + backlash]
  std::int64_t low = axis.edges.front().direction > 0 ? -backlash : 0;
  const std::int64_t start = low;
  for (std::size_t i = 0; i < axis.edges.size(); ++i) {
    motor += axis.edges[i].direction;
    low = std::max(std::min(low, motor), motor - backlash);
    load.reversals += i > 0 && axis.edges[i].direction != axis.edges[i - 1].direction;
  }
  load.moved = low - start;
  return load;
}

}  // namespace

TEST_CASE("step rate and pulse times cap the speed of an axis, not more") {
  const test::Folder folder;
  // 400 steps/mm: 4000 steps/s are 10 mm/s
  for (const std::string rule :
       {"max_step_rate = 4000", "pulse_width = 100e-6\npulse_gap = 150e-6", "pulse_width = 250e-6"}) {
    INFO(rule);
    folder.write("m.toml", axis('X', rule) + axis('Y', "") + axis('Z', ""));
    for (const std::string plan : {"block", "span"}) {
      const auto run = folder.run_text(
          "G1 X30 Y40\nY80\nG2 X36 Y80 I3\nG1 X0\n",
          "--json --tolerance 0 --machine m.toml --steps x.vcd --blocks b.csv --plan " + plan);
      INFO(run.err);
      REQUIRE(run.exit == 0);
      const auto peaks = test::Table(folder / "b.csv")["v_peak"];
      CHECK(peaks[0] == Approx(50.0 / 3.0));
      CHECK(peaks[1] == Approx(30.0));
      CHECK(peaks[3] == Approx(10.0));
      CHECK(closest(test::Vcd(folder / "x.vcd").axis("X"), false) >= 250000 - 1);
    }
  }
}

TEST_CASE("a plan that breaks a rule of time is refused: line, axis, time, figures") {
  const test::Folder folder;
  // X turns round at full speed: that is what the corner of this policy asks for
  const std::string program = "G1 X1.0001\nX0\nX5\n";
  const auto run = [&](const std::string& rule) {
    folder.write("m.toml", axis('X', rule) + axis('Y', "") + axis('Z', ""));
    return folder.run_text(program,
                           "--quiet --junction tangent=1e3 --machine m.toml --steps x.vcd --samples s.csv");
  };
  // The last edge stands at 0.99875 mm, so X is back there 2 * 1.35 um / 27.6 mm/s = 98 us later.
  CHECK(run("direction_setup = 40e-6\ndirection_hold = 40e-6").exit == 0);
  CHECK(folder.files() == std::set<std::string>{"m.toml", "program.ngc", "s.csv", "x.vcd"});
  std::filesystem::remove(folder / "x.vcd");
  std::filesystem::remove(folder / "s.csv");
  const auto late = run("direction_setup = 50e-6\ndirection_hold = 50e-6");
  CHECK(late.exit == 2);
  CHECK(late.err.starts_with("program.ngc:2:1: error: axis X at 0."));
  CHECK(late.err.find("direction hold and set-up time of 9.79201") != std::string::npos);
  CHECK(
      late.err.ends_with("e-05 s is below the limit of 0.0001 s; slower corners or a lower speed give the "
                         "drive more time\n"));
  CHECK(std::count(late.err.begin(), late.err.end(), '\n') == 1);
  CHECK(folder.files() == std::set<std::string>{"m.toml", "program.ngc"});
}

TEST_CASE("no drive is checked where no steps are asked for") {
  const test::Folder folder;
  // X turns round at full speed on the border of a step
  const std::string program = "G1 X1.0012500001\nX0\nX5\n", options = "--quiet --junction tangent=1e3 ";
  CHECK(folder.run_text(program, options).exit == 0);
  const auto counted = folder.run_text(program, options + "--count-steps");
  CHECK(counted.exit == 2);
  CHECK(counted.err.find("pulse high and low time") != std::string::npos);
  CHECK(folder.run_text(program, options + "--steps x.vcd").exit == 2);
}

TEST_CASE("an axis that stops on the border of a step and turns round keeps the drive's rules") {
  const test::Folder folder;
  const auto run =
      folder.run_text("G21 G90 F600\nG1 X5.02759\nG1 X4.09125\nG1 X5.09347\n", "--json --steps x.vcd");
  INFO(run.err);
  REQUIRE(run.exit == 0);
  CHECK(closest(test::Vcd(folder / "x.vcd").axis("X"), true) >= 100000);
  CHECK(run.json()["net_steps"]["X"] == 2037);
}

TEST_CASE("backlash takes the time that there is") {
  const test::Folder folder;
  folder.write("m.toml", axis('X', "backlash = 0.0125") + axis('Y', "") + axis('Z', ""));
  // X rests while Y moves for more than a second, and in a dwell
  for (const char* rest : {"Y40", "G4 P1.5"}) {
    INFO(rest);
    REQUIRE(
        folder.run_text(std::string("G1 X5\n") + rest + "\nX0\n", "--quiet --machine m.toml --steps x.vcd")
            .exit == 0);
    CHECK(closest(test::Vcd(folder / "x.vcd").axis("X"), true) >= 200000000);
  }
}

TEST_CASE("a plan gives backlash its time, at corners, between arcs and within them") {
  const test::Folder folder;
  folder.write("m.toml", axis('X', sensible + "backlash = 0.05") + axis('Y', sensible + "backlash = 0.05") +
                             axis('Z', ""));
  for (const std::string program :
       {"G1 X10 Y10\nX9 Y20\nX20 Y19\nX0 Y0\n", "G1 X10\nX0\nX10.0013\nX0\n", "G2 X10 Y0 R5\nG2 X0 Y0 R5\n",
        "G2 X5 Y5 R5\nG2 X10 Y0 R5\nG3 X10.2 Y0.1 R0.3\nG3 X10 Y-0.1 R0.2\n"})
    for (const std::string junction : {"deviation=0.05", "tangent=20", "stop"}) {
      INFO(program << junction);
      const auto run = folder.run_text(program, "--quiet --machine m.toml --junction " + junction);
      CHECK(run.err.empty());
      CHECK(run.exit == 0);
    }
  const auto pocket =
      folder.run(test::example("pocket") + " --quiet --machine m.toml --junction deviation=0.05");
  CHECK(pocket.err == test::pocket_warning);
  CHECK(pocket.exit == 0);
}

TEST_CASE("a negative number of steps per unit is a reversed axis") {
  const test::Folder folder;
  folder.write("m.toml",
               axis('X', "steps_per_unit = -200") + axis('Y', "steps_per_unit = 200") + axis('Z', ""));
  const auto run = folder.run_text("G1 X3.3 Y3.3\nX1\n", "--json --machine m.toml --steps x.vcd");
  INFO(run.err);
  REQUIRE(run.exit == 0);
  CHECK(run.json()["net_steps"] == nlohmann::json{{"X", -200}, {"Y", 660}, {"Z", 0}});
  CHECK(run.json()["step_error_max"]["X"] <= 0.5 + 1e-3);
  const test::Vcd vcd(folder / "x.vcd");
  CHECK(vcd.axis("X").net() == -200);
  CHECK(vcd.axis("X").edges.front().direction == -1);
}

TEST_CASE("backlash is made up for where an axis turns round") {
  const test::Folder folder;
  folder.write("m.toml", axis('X', "backlash = 0.0125") + axis('Y', "backlash = 0.03") + axis('Z', ""));
  const auto run = folder.run_text("G1 X5 Y2\nX3 Y4\nX8\nG2 X4 Y4 I-2\nG1 Z3\nZ-1\nX0 Y0\n",
                                   "--json --junction stop --machine m.toml --steps x.vcd");
  INFO(run.err);
  REQUIRE(run.exit == 0);
  const test::Vcd vcd(folder / "x.vcd");
  for (const auto& [name, backlash] : {std::pair{"X", 5}, {"Y", 12}, {"Z", 0}}) {
    INFO(name);
    const auto& axis = vcd.axis(name);
    const Load load = drag(axis, backlash);
    CHECK(load.reversals >= 1);
    CHECK(load.moved == (std::string_view(name) == "Z" ? -400 : 0));  // as programmed
    CHECK(run.json()["net_steps"][name] == axis.net());
    CHECK(run.json()["steps"][name] == static_cast<std::int64_t>(axis.edges.size()));
    CHECK(run.json()["step_error_max"][name] <= (backlash > 0 ? 0.6 : 0.5) + 1e-6);
    const auto plain =
        folder.run_text(test::text_of(folder / "program.ngc"), "--json --count-steps --junction stop").json();
    CHECK(static_cast<std::int64_t>(axis.edges.size()) - plain["steps"][name].get<std::int64_t>() ==
          load.reversals * backlash);
  }
}

TEST_CASE("a direction is set its time before the step") {
  const test::Folder folder;
  folder.write("m.toml", machine("direction_setup = 20e-6"));
  REQUIRE(folder.run_text("G1 X1\nX0\n", "--quiet --junction stop --machine m.toml --steps x.vcd").exit == 0);
  std::istringstream lines(test::text_of(folder / "x.vcd"));
  std::int64_t time = 0, turned = 0, stepped = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line[0] == '#') time = std::stoll(line.substr(1));
    if (line == "0\"" && time > 0) turned = time;  // X_dir
    if (line == "1!" && turned > 0 && stepped == 0) stepped = time;
  }
  CHECK(turned > 0);
  CHECK(stepped - turned == 20000);
}

TEST_CASE("a machine file in inches is the same machine in millimetres") {
  const test::Folder folder;
  folder.write("mm.toml",
               "rapid_rate = 25.4\nfeed_limit = 12.7\n" +
                   axis('X', "steps_per_unit = 400\ntravel = [-25.4, 254]\nvelocity = 20.32") +
                   axis('Y', "backlash = 0.0254\njerk = 2540") + axis('Z', "acceleration = 254") +
                   "[tools]\n1 = 50.8\n[offsets]\nG54 = [25.4, 0, 0]\n[home]\nG28 = [2.54, 0, 0]\n");
  folder.write("inch.toml", "unit = \"inch\"\nrapid_rate = 1\nfeed_limit = 0.5\n" +
                                axis('X', "steps_per_unit = 10160\ntravel = [-1, 10]\nvelocity = 0.8") +
                                axis('Y', "backlash = 0.001\njerk = 100") + axis('Z', "acceleration = 10") +
                                "[tools]\n1 = 2\n[offsets]\nG54 = [1, 0, 0]\n[home]\nG28 = [0.1, 0, 0]\n");
  const auto run = [&](const std::string& file) {
    auto outcome = folder.run_text("T1 M6\nG43\nG0 X1 Y2 Z3\nG1 X5 Y5 Z0 F6000\nG2 X9 Y1 R4\nG28 X0\n",
                                   "--json --junction stop --machine " + file);
    INFO(outcome.err);
    REQUIRE(outcome.exit == 0);
    return outcome.json();
  };
  const auto mm = run("mm.toml"), inch = run("inch.toml");
  CHECK(mm["time_s"].get<double>() == Approx(inch["time_s"].get<double>()).epsilon(1e-12));
  CHECK(mm["steps"] == inch["steps"]);
  CHECK(folder.run_text("G1 X230\n", "--quiet --machine inch.toml").err ==
        "program.ngc:1:4: error: axis X would move to 255.4, beyond its travel of -25.4 to 254\n");
}

TEST_CASE("feeds stay within the machine's, rapids do not mind") {
  const test::Folder folder;
  folder.write("m.toml", "feed_limit = 5\n");
  REQUIRE(folder.run_text("G1 X10 F3000\nG0 X0\n", "--quiet --machine m.toml --blocks b.csv").exit == 0);
  const auto peaks = test::Table(folder / "b.csv")["v_peak"];
  CHECK(peaks[0] == Approx(5.0));
  CHECK(peaks[1] == Approx(30.0));
}

TEST_CASE("a machine of two axes has no Z") {
  const test::Folder folder;
  folder.write("m.toml", axis('X', "") + axis('Y', ""));
  const auto run = folder.run_text("G1 X3 Y1\nG2 X5 Y3 R2\n", "--json --machine m.toml --steps x.vcd");
  REQUIRE(run.exit == 0);
  CHECK(run.json()["steps"].size() == 2);
  CHECK(folder.run_text("G1 X3 Z1\n", "--quiet --machine m.toml").err ==
        "program.ngc:1:7: error: axis Z would move to 1, beyond its travel of 0 to 0\n");
  const auto tilted = folder.run_text("G18\nG2 X4 I2\n", "--quiet --machine m.toml");
  CHECK(tilted.exit == 2);
  INFO(tilted.err);
  CHECK(tilted.err.find("axis Z would move to -2, beyond its travel of 0 to 0") != std::string::npos);
}

TEST_CASE("bad drive rules are refused: line, column and what is wrong") {
  struct Case {
    const char* keys;
    const char* error;
  };
  const test::Folder folder;
  for (const auto& [keys, error] :
       {Case{"max_step_rate = 0", "3:17: error: max_step_rate must be greater than zero"},
        {"pulse_width = 0", "3:15: error: pulse_width must be greater than zero"},
        {"pulse_gap = -1e-6", "3:13: error: pulse_gap must not be negative"},
        {"direction_setup = -1", "3:19: error: direction_setup must not be negative"},
        {"direction_hold = \"long\"", "3:18: error: direction_hold must be a number"},
        {"backlash = -0.1", "3:12: error: backlash must not be negative"},
        {"steps = 1", "3:1: error: unknown key 'steps' in axis"}}) {
    folder.write("m.toml", machine(keys));
    const auto run = folder.run_text("G1 X1\n", "--quiet --machine m.toml");
    CHECK(run.exit == 2);
    CHECK(run.err == "m.toml:" + std::string(error) + "\n");
  }
  folder.write("m.toml", "unit = \"foot\"\n");
  CHECK(folder.run_text("G1 X1\n", "--quiet --machine m.toml").err ==
        "m.toml:1:8: error: unit must be \"mm\" or \"inch\"\n");
}

TEST_CASE("real programs keep a sensible drive's rules and end on their rounded targets") {
  const test::Folder folder;
  folder.write("m.toml", machine(sensible));
  test::for_real_programs([&](const std::string& name, const std::string& path) {
    INFO(name);
    const auto run = folder.run(test::quoted(path + ".ngc") +
                                " --json --period 0.02 --machine m.toml --steps x.vcd --motions m.csv");
    INFO(run.err);
    REQUIRE(run.exit == 0);
    const test::Vcd vcd(folder / "x.vcd");
    const test::Table motions(folder / "m.csv");
    for (const auto& [letter, column] : {std::pair{"X", "x"}, {"Y", "y"}, {"Z", "z"}}) {
      INFO(letter);
      const auto& axis = vcd.axis(letter);
      CHECK(closest(axis, false) >= 20000 - 2);
      CHECK(closest(axis, true) >= 10000 - 2);
      const std::string c(column);
      const double travel = motions[c + "1"].back() - motions[c + "0"].front();
      CHECK(std::abs(static_cast<double>(axis.net()) - travel * 400.0) <= 0.5 + 1e-6);
    }
  });
}
