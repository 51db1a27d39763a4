// Machine files: what they change, in which coordinates, and what is wrong with bad ones.
#include <algorithm>
#include <cmath>

#include "simulate/table.hpp"
#include "simulate/vcd.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

// Three axes with something added to each.
std::string axes(const std::string& x, const std::string& y = "", const std::string& z = "") {
  return "[[axis]]\nletter = \"X\"\n" + x + "\n[[axis]]\nletter = \"Y\"\n" + y +
         "\n[[axis]]\nletter = \"Z\"\n" + z + "\n";
}

}  // namespace

TEST_CASE("the mills that ship are read, and run a program") {
  int machines = 0;
  for (const auto& entry : std::filesystem::directory_iterator(CNCPLAN_EXAMPLES "/machines")) {
    if (!entry.path().filename().string().starts_with("mill")) continue;
    INFO(entry.path().filename());
    const test::Folder folder;
    const auto run = folder.run_text("G0 X10 Y10\nG2 X20 Y20 I5 J5 F600\n",
                                     "--json --machine " + test::quoted(entry.path().string()));
    INFO(run.err);
    CHECK(run.exit == 0);
    ++machines;
  }
  CHECK(machines >= 1);
}

TEST_CASE("a tool of the machine file may stand beside the spindle's axis") {
  const test::Folder folder;
  folder.write("m.toml", "unit = \"inch\"\n[tools]\n1 = { length = 1, X = 2, Y = -0.5 }\n");
  const auto run = folder.run_text("G43 H1\nG0 X1 Y2 Z3\n", "--quiet --machine m.toml --motions m.csv");
  INFO(run.err);
  REQUIRE(run.exit == 0);
  const test::Table motions(folder / "m.csv");
  REQUIRE(motions.rows() == 1);
  CHECK(motions["x0"][0] == Approx(-50.8));
  CHECK(motions["y0"][0] == Approx(12.7));
  CHECK(motions["z0"][0] == Approx(-25.4));
}

TEST_CASE("samples and motions are in work coordinates, steps in machine coordinates") {
  const test::Folder folder;
  folder.write("m.toml", "[tools]\n1 = 50\n[offsets]\nG54 = [10, 20, -60]\nG55 = [0, 0, 5]\n");
  const auto run = folder.run_text("T1 M6\nG43\nG0 X1 Y2 Z3\nG55\nG1 X4\nG49\nG1 Z0\n",
                                   "--json --tolerance 0 --machine m.toml --motions m.csv --samples s.csv "
                                   "--steps x.vcd");
  INFO(run.err);
  REQUIRE(run.exit == 0);
  // all axes start at 0 of the machine: with the tool in the spindle, (-10, -20, 10) of G54
  const test::Table motions(folder / "m.csv");
  REQUIRE(motions.rows() == 3);
  const auto row = [&](std::size_t i, const char* end) {
    const std::string n(end);
    return std::vector<double>{motions["x" + n][i], motions["y" + n][i], motions["z" + n][i]};
  };
  CHECK(row(0, "0") == std::vector<double>{-10, -20, 10});
  CHECK(row(0, "1") == std::vector<double>{1, 2, 3});      // machine 11, 22, -7
  CHECK(row(1, "0") == std::vector<double>{11, 22, -62});  // G55 with the tool: machine - (0, 0, 55)
  CHECK(row(1, "1") == std::vector<double>{4, 22, -62});
  CHECK(row(2, "0") == std::vector<double>{4, 22, -12});  // without the tool
  CHECK(row(2, "1") == std::vector<double>{4, 22, 0});    // machine 4, 22, 5
  const test::Table samples(folder / "s.csv");
  CHECK(samples["x"].front() == -10.0);
  CHECK(samples["z"].front() == 10.0);
  CHECK(samples["z"].back() == Approx(0.0).margin(1e-12));
  CHECK(run.json()["net_steps"] == nlohmann::json{{"X", 1600}, {"Y", 8800}, {"Z", 2000}});
  const test::Vcd vcd(folder / "x.vcd");
  CHECK(vcd.axis("Z").net() == 2000);
  CHECK(run.json()["steps"]["Z"] == (7 + 12) * 400);
}

TEST_CASE("steps per unit and pulse width are the axis' own") {
  const test::Folder folder;
  folder.write("m.toml", axes("steps_per_unit = 1000\npulse_width = 5e-6", "steps_per_unit = 33.3"));
  const auto run = folder.run_text("G1 X3 Y-10\n", "--json --machine m.toml --steps x.vcd");
  REQUIRE(run.exit == 0);
  CHECK(run.json()["net_steps"] == nlohmann::json{{"X", 3000}, {"Y", -333}, {"Z", 0}});
  const test::Vcd vcd(folder / "x.vcd");
  CHECK(vcd.axis("X").longest_high == 5000);
  CHECK(vcd.axis("X").shortest_high == 5000);
  CHECK(vcd.axis("Y").longest_high == 2000);
}

TEST_CASE("axis limits hold, on lines and on arcs") {
  const test::Folder folder;
  folder.write("m.toml", axes("velocity = 12\nacceleration = 150", "velocity = 20\njerk = 2000"));
  const std::string program = "G1 X10 Y1\nG2 X14 Y5 R4\nG3 X10 Y9 Z-1 R4\nX10.5 Y9 R0.25\nG1 Y30\n";
  for (const std::string plan : {"block", "span"}) {
    INFO(plan);
    const auto run = folder.run_text(program, "--json --machine m.toml --plan " + plan);
    REQUIRE(run.exit == 0);
    const auto peak = run.json()["axis_peak"];
    CHECK(peak["velocity"]["X"] <= 12.0 * (1.0 + 1e-9));
    CHECK(peak["velocity"]["Y"] <= 20.0 * (1.0 + 1e-9));
    CHECK(peak["acceleration"]["X"] <= 150.0 * (1.0 + 1e-9));
    CHECK(run.json()["time_s"] > folder.run_text(program, "--json --plan " + plan).json()["time_s"]);
  }
  // a straight move at 3:4 may run at 20 in X: 25 along the path
  folder.write("m.toml", axes("velocity = 15"));
  REQUIRE(folder.run_text("G1 X30 Y40\n", "--quiet --machine m.toml --blocks b.csv").exit == 0);
  CHECK(test::Table(folder / "b.csv")["v_peak"][0] == Approx(25.0));
}

TEST_CASE("rapids run at the machine's rate, feed moves within the limit") {
  const test::Folder folder;
  folder.write("m.toml", "rapid_rate = 10\n");
  REQUIRE(folder.run_text("G0 X50\n", "--quiet --machine m.toml --blocks b.csv --motions m.csv").exit == 0);
  CHECK(test::Table(folder / "b.csv")["v_peak"][0] == Approx(10.0));
  CHECK(test::Table(folder / "m.csv")["feed"][0] == 10.0);
  folder.write("m.toml", "rapid_rate = 100\n");
  REQUIRE(
      folder.run_text("G0 X50\nG1 X0\n", "--quiet --machine m.toml --blocks b.csv --motions m.csv").exit ==
      0);
  const test::Table blocks(folder / "b.csv");
  CHECK(blocks["v_peak"][0] > 80.0);  // what 50 mm allow
  CHECK(blocks["v_peak"][1] == Approx(30.0));
  CHECK(test::Table(folder / "m.csv")["feed"][0] == 100.0);
}

TEST_CASE("homes and words to pass through are the machine's") {
  const test::Folder folder;
  folder.write("m.toml", "pass_through = [\"M62\"]\n[home]\nG28 = [1, 2, 3]\nG30 = [4, 5, 6]\n");
  REQUIRE(folder.run_text("G28\nM62 P3\nG30\n", "--quiet --machine m.toml --motions m.csv").exit == 0);
  const test::Table motions(folder / "m.csv");
  CHECK(motions["x1"] == std::vector<double>{1, 4});
  CHECK(motions["z1"] == std::vector<double>{3, 6});
  folder.write("own.toml", "pass_through = [\"M201 XYZ\"]\n");
  REQUIRE(
      folder.run_text("G1 X1 F600\nM201 X500 Y500\n", "--quiet --machine own.toml --motions o.csv").exit ==
      0);
  CHECK(test::Table(folder / "o.csv").rows() == 1);
  const auto own = folder.run_text("M162 P3\n", "--quiet");  // of nobody: handed on, and told
  CHECK(own.exit == 0);
  CHECK(own.err.find("1:1: warning: M162 is not known here") != std::string::npos);
}

TEST_CASE("travel: end points, an arc's extremum, the offset included") {
  struct Case {
    const char* program;
    const char* error;  ///< "" where the program is within
  };
  const test::Folder folder;
  folder.write("m.toml", axes("travel = [-5, 10]", "travel = [-1, 5]", "travel = [-2, 100]") +
                             "[offsets]\nG55 = [5, 0, 0]\n");
  for (const auto& [program, error] : {
           Case{"G1 X10 Y5\nG1 X-5\n", ""},
           {"G1 X10.001\n", "1:4: error: axis X would move to 10.001, beyond its travel of -5 to 10"},
           {"G1 X1\nY3 Z-2.5\n", "2:4: error: axis Z would move to -2.5, beyond its travel of -2 to 100"},
           {"G2 X8 I4\n", ""},
           {"G3 X8 I4\n", "1:7: error: axis Y would move to -4, beyond its travel of -1 to 5"},
           {"G2 X10.2 I5.1\n", "1:4: error: axis X would move to 10.2, beyond its travel of -5 to 10"},
           {"G2 X9 R5.2\n", ""},
           {"G2 X10 R5.01\nG55\nG1 X4\nX6\n",
            "4:1: error: axis X would move to 11, beyond its travel of -5 to 10"},
       }) {
    INFO(program);
    const auto run = folder.run_text(program, "--quiet --machine m.toml --samples s.csv");
    const bool good = std::string_view(error).empty();
    CHECK(run.exit == (good ? 0 : 2));
    CHECK(run.err == (good ? "" : "program.ngc:" + std::string(error) + "\n"));
    CHECK(std::filesystem::exists(folder / "s.csv") == good);
    std::filesystem::remove(folder / "s.csv");
  }
}

TEST_CASE("an axis that starts outside its travel: the message says so") {
  const test::Folder folder;
  folder.write("m.toml", axes("travel = [1, 50]"));
  CHECK(folder.run_text("G1 X10\n", "--quiet --machine m.toml").err ==
        "program.ngc:1:4: error: axis X starts at 0, beyond its travel of 1 to 50\n");
}

TEST_CASE("the two-axis card: the published axis 1 is Y, axis 2 is X") {
  const test::Folder folder;
  const auto run = folder.run_text(
      "G1 X2000 Y1000 F2000\n", "--json --machine " + test::quoted(CNCPLAN_EXAMPLES "/machines/card2.toml"));
  INFO(run.err);
  REQUIRE(run.exit == 0);
  CHECK(run.json()["net_steps"] == nlohmann::json{{"X", 9878}, {"Y", 16974}});
}

TEST_CASE("bad machine files: file, line, column and what is wrong") {
  struct Case {
    std::string file;
    const char* error;
  };
  const test::Folder folder;
  folder.write("part.ngc", "G1 X1\n");
  for (const auto& [file, error] : {
           Case{"rapid_rate = \n", "1:"},
           {"rapid_rat = 1\n", "1:1: error: unknown key 'rapid_rat'"},
           {"\nrapid_rate = \"fast\"\n", "2:14: error: rapid_rate must be a number"},
           {"rapid_rate = 0\n", "1:14: error: rapid_rate must be greater than zero"},
           {"rapid_rate = nan\n", "1:14: error: rapid_rate must be a number"},
           {"name = 5\n", "1:8: error: name must be a text"},
           {"axis = 3\n", "1:8: error: axis must be a list of tables, [[axis]]"},
           {"axis = []\n", "1:8: error: axis must be a list of tables, [[axis]]"},
           {"[[axis]]\nsteps_per_unit = 1\n", "1:1: error: an axis needs a letter"},
           {"[[axis]]\nletter = \"XY\"\n", "2:10: error: letter must be one letter"},
           {axes("steps = 400"), "3:1: error: unknown key 'steps' in axis"},
           {axes("steps_per_unit = 0"), "3:18: error: steps_per_unit must not be zero"},
           {axes("kind = \"round\""), "3:8: error: kind must be \"linear\" or \"rotary\""},
           {axes("travel = [1]"), "3:10: error: travel must be a list of 2 numbers"},
           {axes("travel = [5, 1]"), "3:10: error: travel must go from the lower to the higher end"},
           {"[[axis]]\nletter = \"X\"\n", "1:1: error: the axes must be X, Y, Z"},
           {"[tools]\nbig = 1\n", "2:7: error: 'big' is not a tool number"},
           {"[tools]\n1 = 5\n01 = 6\n", "2:5: error: tool 1 is there twice"},
           {"[tools]\n1 = { length = 5, Z = 5 }\n", "2:19: error: unknown key 'Z' in 1"},
           {"[tools]\n1 = { X = \"wide\" }\n", "2:11: error: tool offset must be a number"},
           {"[offsets]\nG53 = [0, 0, 0]\n", "2:7: error: 'G53' is not a work coordinate system"},
           {"[offsets]\nG54 = [0, 0]\n", "2:7: error: G54 must be a list of 3 numbers"},
           {"[home]\nG29 = [0, 0, 0]\n", "2:1: error: unknown key 'G29' in home"},
           {"pass_through = \"M62\"\n", "1:16: error: pass_through must be a list of words"},
           {"pass_through = [\"M6x\"]\n", "1:17: error: 'M6x' is not a word"},
           {"pass_through = [\"M201 Xy\"]\n", "1:17: error: 'M201 Xy' is not a word"},
           {"pass_through = [\"G251 X\"]\n", "1:17: error: 'G251 X' is not a word"},
       }) {
    INFO(file);
    folder.write("m.toml", file);
    const auto run = folder.run("part.ngc --machine m.toml --samples s.csv");
    INFO(run.err);
    CHECK(run.exit == 2);
    CHECK(run.out.empty());
    CHECK(run.err.starts_with("m.toml:" + std::string(error)));
    CHECK(std::count(run.err.begin(), run.err.end(), '\n') == 1);
    CHECK_FALSE(std::filesystem::exists(folder / "s.csv"));
  }
}

TEST_CASE("a machine file names the control whose dialect its programs speak") {
  const test::Folder folder;
  folder.write("m.toml", "dialect = \"fanuc\"\n");
  const std::string program = "G21 G90 F600\nG1 X10\nG4 P500\n";
  const double in_ms = folder.run_text(program, "--json --machine m.toml").json()["time_s"];
  const double in_s = folder.run_text(program, "--json").json()["time_s"];
  CHECK(in_s - in_ms == Approx(499.5));
  folder.write("m.toml", "dialect = \"siemens\"\n");
  CHECK(folder.run_text(program, "--machine m.toml").err.starts_with("m.toml:1:11: error: dialect must be"));
}

TEST_CASE("subprograms and canned cycles are planned") {
  const test::Folder folder;
  const std::string program =
      "G21 G90 F600 G0 Z5\nG98 G81 X10 Y0 Z-2 R1\nX20\nG80\nG91\nM98 P7 L2\nM30\nO7\nG1 X1\nG0 Z1\nM99\n";
  REQUIRE(folder.run_text(program, "--quiet --motions m.csv").exit == 0);
  const test::Table motions(folder / "m.csv");
  CHECK(motions["line"] == std::vector<double>{1, 2, 2, 2, 2, 3, 3, 3, 3, 9, 10, 9, 10});
  CHECK(motions["z1"] == std::vector<double>{5, 5, 1, -2, 5, 5, 1, -2, 5, 5, 6, 6, 7});
}
