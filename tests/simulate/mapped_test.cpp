// Machine files that name their kinematics: tips by formulas of the test's own, and what is refused.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "simulate/run.hpp"
#include "simulate/table.hpp"
#include "support/catch.hpp"

using cncplan::test::Folder;
using cncplan::test::Table;

namespace {

constexpr double degree = std::numbers::pi / 180;

std::string axis(const std::string& letter, const std::string& kind, const std::string& more = "") {
  return "[[axis]]\nletter = \"" + letter + "\"\nkind = \"" + kind + "\"\nsteps_per_unit = 100\n" +
         "velocity = 100\nacceleration = 1000\njerk = 20000\n" + more;
}
std::string mill(const std::string& name, const std::string& tilt, const std::string& lengths) {
  return "kinematics = \"" + name + "\"\n" + axis("X", "linear") + axis("Y", "linear") + axis("Z", "linear") +
         axis(tilt, "rotary", "travel = [-100, 100]\n") + axis("C", "rotary") + "[lengths]\n" + lengths;
}
std::string arm(const std::string& lengths) {
  return "kinematics = \"scara\"\n" + axis("J", "rotary") + axis("K", "rotary") + axis("Z", "linear") +
         "[lengths]\n" + lengths;
}

}  // namespace

TEST_CASE("a table-table machine of a file holds the part under the tip") {
  const Folder folder;
  folder.write("m.toml", mill("table-table-ac", "A", "center = [0, 0, -60]\n"));
  const auto run = folder.run_text("F3000\nG43.4\nG1 X40\nY30 A-30 C45\nX0 Y40 A-45 C120\nG49\nM30\n",
                                   "--machine m.toml --tolerance 0.02 --period 0.005 --samples s --json");
  INFO(run.err);
  REQUIRE(run.exit == 0);
  const Table rows(folder / "s");
  CHECK(rows.names() ==
        std::vector<std::string>{"t", "x", "y", "z", "X", "Y", "Z", "A", "C", "s", "v", "a", "j"});
  const auto &x = rows["x"], &y = rows["y"], &z = rows["z"];
  double off = 0;
  for (std::size_t i = 0; i < rows.rows(); ++i) {
    const double a = rows["A"][i] * degree, c = rows["C"][i] * degree;
    const double u = std::cos(c) * x[i] - std::sin(c) * y[i], v = std::sin(c) * x[i] + std::cos(c) * y[i];
    const double w = z[i] + 60;
    off =
        std::max({off, std::abs(u - rows["X"][i]), std::abs(std::cos(a) * v - std::sin(a) * w - rows["Y"][i]),
                  std::abs(std::sin(a) * v + std::cos(a) * w - 60 - rows["Z"][i])});
  }
  CHECK(off < 1e-9);
  CHECK(rows["A"].back() == Approx(-45));
  const auto json = run.json();
  CHECK(json["kinematics"] == "table-table-ac");
  CHECK(json["time_s"].get<double>() == Approx(rows["t"].back()));
  CHECK(json["axis_peak"]["velocity"]["C"].get<double>() <= 100 * (1 + 1e-9));
  CHECK(json["axis_peak"]["velocity"]["C"].get<double>() > 20);
}

TEST_CASE("an arm of a file draws a line, from its joints at 0") {
  const Folder folder;
  folder.write("m.toml", arm("upper = 200\nfore = 150\n"));
  const auto run = folder.run_text("G0 X200 Y100\nG1 X150 Y-180 Z20 F3000\n",
                                   "--machine m.toml --tolerance 0 --samples s --quiet");
  INFO(run.err);
  REQUIRE(run.exit == 0);
  const Table rows(folder / "s");
  double off = 0;
  for (std::size_t i = 0; i < rows.rows(); ++i) {
    const double j = rows["J"][i] * degree, k = rows["K"][i] * degree;
    off = std::max({off, std::abs(200 * std::cos(j) + 150 * std::cos(j + k) - rows["x"][i]),
                    std::abs(200 * std::sin(j) + 150 * std::sin(j + k) - rows["y"][i])});
  }
  CHECK(off < 1e-8);
  CHECK(rows["x"].front() == Approx(350));
  CHECK(rows["y"].back() == Approx(-180));
}

TEST_CASE("each machine that a file can name runs") {
  const Folder folder;
  const auto runs = [&](const std::string& machine, const std::string& program) {
    folder.write("m.toml", machine);
    const auto run = folder.run_text(program, "--machine m.toml --quiet");
    INFO(run.err);
    CHECK(run.exit == 0);
  };
  runs(mill("table-table-bc", "B", "center = [0, 5, -60]\napart = [3, 0, 0]\n"),
       "G43.4\nG1 X9 B20 C5 F900\n");
  runs(mill("head-table", "B", "pivot_length = 150\n"), "G43.4\nG1 X9 B20 C5 F900\n");
  runs("kinematics = \"core-xy\"\n" + axis("A", "linear") + axis("B", "linear") + axis("Z", "linear"),
       "G1 X9 Y3 F900\n");
}

TEST_CASE("what machine files with kinematics refuse") {
  struct Case {
    std::string machine, program, options, error;
  };
  const std::string table = mill("table-table-ac", "A", "center = [0, 0, -60]\n");
  const std::vector<Case> cases{
      {"kinematics = \"hexapod\"\n", "G0 X1\n", "", "m.toml:1:14: error: kinematics must be "},
      {"kinematics = \"core-xy\"\n[lengths]\nupper = 3\n", "G0 X1\n", "",
       "m.toml:3:1: error: unknown key 'upper'"},
      {arm("upper = 200\n"), "G0 X1\n", "", "m.toml:"},
      {arm("upper = 200\nfore = 0\n"), "G0 X1\n", "", "m.toml:"},
      {"[lengths]\nupper = 3\n", "G0 X1\n", "", "m.toml:1:1: error: lengths are those of the machine"},
      {mill("table-table-ac", "B", ""), "G0 X1\n", "",
       "m.toml:1:14: error: the axes of table-table-ac must be XYZAC"},
      {table, "G43.4\nG1 A130 F100\n", "",
       "program.ngc:2:4: error: axis A would move to 130, beyond its travel"},
      {table, "G0 X1\n", "--plot p", "error: --plot does not go with machines behind a map"},
      {table, "G0 X1\n", "--profile five", "error: --profile does not go with machines behind a map"},
  };
  for (const Case& c : cases) {
    const Folder folder;
    folder.write("m.toml", c.machine);
    const auto run = folder.run_text(c.program, "--machine m.toml --quiet --samples s " + c.options);
    INFO(c.error << " but " << run.err);
    CHECK(run.exit == 2);
    CHECK(run.err.starts_with(c.error));
    CHECK_FALSE(folder.has("s"));
  }
}
