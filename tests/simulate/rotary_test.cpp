// Machines with a rotary table: rows of the four axes, and Cartesian programs round the table.
#include <array>
#include <cmath>
#include <numbers>
#include <sstream>

#include "generate/programs.hpp"
#include "simulate/run.hpp"
#include "simulate/table.hpp"
#include "support/catch.hpp"

using namespace cncplan;
using cncplan::test::Folder;
using cncplan::test::Table;

namespace {

constexpr double pi = std::numbers::pi;
constexpr double degree = pi / 180;

std::string axis(const std::string& letter, const std::string& kind, const std::string& more) {
  return "[[axis]]\nletter = \"" + letter + "\"\nkind = \"" + kind + "\"\nsteps_per_unit = 100\n" + more;
}
const std::string linear_limits = "velocity = 100\nacceleration = 1000\njerk = 10000\n";
const std::string rotary_limits = "velocity = 60\nacceleration = 1000\njerk = 10000\n";

// KK22's table with coarser steps, so that long programs are soon stepped.
std::string table_machine(const std::string& more = "") {
  return "rapid_rate = 30\nsmallest_radius = 5\n" + more + axis("Y", "linear", linear_limits) +
         axis("Z", "linear", linear_limits) + axis("C", "rotary", rotary_limits);
}
std::string four_axes() {
  return axis("R", "linear", linear_limits + "travel = [0, 900]\n") + axis("Z", "linear", linear_limits) +
         axis("A", "rotary", rotary_limits + "travel = [-90, 90]\n") + axis("C", "rotary", rotary_limits);
}

}  // namespace

TEST_CASE("KK22's three programs run on the rotary table, C without a jump") {
  const std::string name = GENERATE("roughing", "finishing", "pocket");
  CAPTURE(name);
  generate::Kind kind{};
  REQUIRE(generate::parse(name, kind));
  std::ostringstream program;
  generate::write(program, kind, 2022, 17);
  const Folder folder;
  folder.write("table.toml", table_machine("table_center = [-150, 0]\n"));
  const double period = 0.01;
  const auto run = folder.run_text(program.str(), "--machine table.toml --period 0.01 --samples s --json");
  INFO(run.err);
  REQUIRE(run.exit == 0);
  const auto json = run.json();
  const Table rows(folder / "s");
  CHECK(rows.names() == std::vector<std::string>{"t", "x", "y", "z", "Y", "Z", "C", "s", "v", "a", "j"});
  const auto &x = rows["x"], &y = rows["y"], &z = rows["z"];
  const std::array<const std::vector<double>*, 3> axes{&rows["Y"], &rows["Z"], &rows["C"]};
  const std::array<double, 3> velocity{100, 100, 60}, acceleration{1000, 1000, 1000};
  double off = 0, stride = 0;
  std::array<double, 3> fastest{}, hardest{};
  for (std::size_t i = 0; i < rows.rows(); ++i) {
    const double radius = (*axes[0])[i], turn = (*axes[2])[i] * degree;
    off = std::max(off, std::hypot(radius * std::cos(turn) - 150 - x[i], radius * std::sin(turn) - y[i],
                                   (*axes[1])[i] - z[i]));
    if (i < 2 || i + 1 == rows.rows()) continue;
    stride = std::max(stride, std::hypot(x[i] - x[i - 1], y[i] - y[i - 1], z[i] - z[i - 1]) -
                                  (rows["s"][i] - rows["s"][i - 1]));
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& q = *axes[k];
      fastest[k] = std::max(fastest[k], std::abs(q[i] - q[i - 1]) / period);
      hardest[k] = std::max(hardest[k], std::abs(q[i] - 2 * q[i - 1] + q[i - 2]) / (period * period));
    }
  }
  CHECK(off < 1e-9);
  CHECK(stride < 2e-4);  // rapids go straight in the axes: the length of the tip's way is a sum of chords
  for (std::size_t k = 0; k < 3; ++k) {
    INFO("axis " << k);
    CHECK(fastest[k] <= velocity[k]);  // an unwinding C would be 36000
    CHECK(hardest[k] <= acceleration[k]);
    const std::string letter(1, "YZC"[k]);
    CHECK(json["axis_peak"]["velocity"][letter].get<double>() <= velocity[k] * (1 + 1e-9));
    CHECK(json["axis_peak"]["acceleration"][letter].get<double>() <= acceleration[k] * (1 + 1e-9));
    CHECK(json["net_steps"][letter].get<double>() ==
          Approx(axes[k]->back() * 100 - std::round(axes[k]->front() * 100)).margin(0.5 + 1e-6));
    CHECK(json["step_error_max"][letter].get<double>() <= 0.5 + 1e-9);
  }
  CHECK(json["contour_error_mm"].get<double>() < 1e-9);
  CHECK(json["end_error_mm"].get<double>() < 1e-9);
}

TEST_CASE("C goes on past whole turns") {
  const Folder folder;
  folder.write("table.toml", table_machine("table_center = [-50, 0]\n"));
  const auto run = folder.run_text("G3 X0 Y0 I-50 J0 P3 F1200\nG2 X0 Y0 I-50 J0\n",
                                   "--machine table.toml --samples s --json --period 0.01");
  REQUIRE(run.exit == 0);
  const auto rows = Table(folder / "s")["C"];
  CHECK(*std::max_element(rows.begin(), rows.end()) == Approx(1080).epsilon(1e-3));
  CHECK(rows.back() == Approx(720));
  CHECK(run.json()["steps"]["C"].get<int>() == Approx(144000).margin(2));
}

TEST_CASE("a dwell on the rotary table: samples stand where the tool does") {
  const Folder folder;
  folder.write("machine.toml", table_machine("table_center = [-50, 0]\n"));
  const auto run = folder.run_text("G0 X20\nG4 P0.055\nG1 Y10 F600\nG4 P0.055\nX10\n",
                                   "--json --machine machine.toml --period 0.01 --samples s.csv");
  REQUIRE(run.exit == 0);
  const Table samples(folder / "s.csv");
  double stride = 0.0;
  for (std::size_t i = 1; i < samples.rows(); ++i)
    stride = std::max(
        stride, std::hypot(samples["x"][i] - samples["x"][i - 1], samples["y"][i] - samples["y"][i - 1]));
  CHECK(stride <= 0.3 * (1 + 1e-9));  // 30 mm/s
}

TEST_CASE("near the table's axis a path is slowed, inside the radius refused with its line") {
  const Folder folder;
  folder.write("table.toml", table_machine("table_center = [-50, -6]\n"));
  const auto run = folder.run_text("G1 X-100 F1800\n", "--machine table.toml --samples s --json");
  REQUIRE(run.exit == 0);
  CHECK(run.json()["axis_peak"]["velocity"]["C"].get<double>() <= 60 * (1 + 1e-9));
  const Table rows(folder / "s");
  double slowest = 100;
  for (std::size_t i = 0; i < rows.rows(); ++i)
    if (std::abs(rows["x"][i] + 50) < 0.5) slowest = std::min(slowest, rows["v"][i]);
  CHECK(slowest < 6 * 60 * degree);  // 6 mm from the axis at 60 degrees a second
  CHECK(slowest > 1);
  const auto refused = folder.run_text("G1 X-10 F1800\nX-100 Y-6\n", "--machine table.toml --samples s2");
  CHECK(refused.exit == 2);
  CHECK(refused.err.starts_with("program.ngc:2:1: error: "));
  CHECK(refused.err.find("mm from the table's axis: no nearer than 5 is driven") != std::string::npos);
  CHECK_FALSE(folder.has("s2"));
  // by default the table's axis is where the program starts
  folder.write("centre.toml", table_machine());
  CHECK(folder.run_text("G1 X10 F1800\n", "--machine centre.toml")
            .err.starts_with("program.ngc:1:4: error: 0 mm"));
  CHECK(folder.run_text("M30\n", "--machine centre.toml").exit == 2);
}

TEST_CASE("rows of the four axes: lengths, feeds, waits and turns about a standing tip") {
  const Folder folder;
  folder.write("four.toml", four_axes());
  const std::string options = "--machine four.toml --json --motions m --blocks b --samples s --vmax 50 ";
  SECTION("the tip's way is the length, its speed the feed") {
    const auto run = folder.run_text("G0 R100\nG1 C90 F600\n", options);
    REQUIRE(run.exit == 0);
    const Table motions(folder / "m"), blocks(folder / "b");
    REQUIRE(motions.rows() == 2);
    CHECK(motions["length"][0] == Approx(100));
    CHECK(motions["length"][1] == Approx(50 * pi).epsilon(1e-9));
    CHECK(motions["feed"][1] == Approx(10));
    CHECK(blocks["v_peak"][1] == Approx(10));
    CHECK(motions["y1"][1] == Approx(100));
    CHECK(motions["z1"][1] == Approx(0).margin(1e-12));
    CHECK(Table(folder / "s")["C"].back() == 90);
  }
  SECTION("the tool's length takes part") {
    const auto run = folder.run_text("G0 R100 Z50\nG1 A90 F600\n", options + "--tool-length 20");
    REQUIRE(run.exit == 0);
    const Table motions(folder / "m");
    CHECK(motions["z0"][0] == Approx(-20));
    CHECK(motions["length"][1] == Approx(10 * pi).epsilon(1e-9));
    CHECK(motions["x1"][1] == Approx(120));
    CHECK(motions["z1"][1] == Approx(50));
  }
  SECTION("a tool that turns about its tip has a way too") {
    const auto run = folder.run_text("G0 R100 Z50\nG1 A90 F600\n", options);
    REQUIRE(run.exit == 0);
    CHECK(run.json()["time_s"].get<double>() > 90.0 / 60.0);
    CHECK(Table(folder / "s")["A"].back() == 90);
    CHECK(run.json()["axis_peak"]["velocity"]["A"].get<double>() <= 60 * (1 + 1e-9));
  }
  SECTION("waits") {
    const double moves = folder.run_text("G0 R10\n", options).json()["time_s"];
    CHECK(folder.run_text("G4 P2\nG0 R10\nG4 P1\n", options).json()["time_s"].get<double>() ==
          Approx(moves + 3));
    CHECK(folder.run_text("G4 P2\n", options).json()["time_s"].get<double>() == Approx(2));
    CHECK(folder.run_text("", options).exit == 0);
  }
}

TEST_CASE("what machines with a rotary table refuse") {
  struct Case {
    std::string machine, program, options, error;
  };
  const std::string table = table_machine("table_center = [-50, 0]\n");
  const std::vector<Case> cases{
      {four_axes(), "G0 R950\n", "",
       "program.ngc:1:4: error: axis R would move to 950, beyond its travel of 0 to 900"},
      {four_axes(), "G0 R10\nA100\n", "",
       "program.ngc:2:1: error: axis A would move to 100, beyond its travel of -90 to 90"},
      {four_axes(), "G0 X10\n", "", "program.ngc:1:4: error: "},
      {four_axes(), "G2 R10 F100\n", "", "program.ngc:1:"},
      {table, "G0 C10\n", "", "program.ngc:1:4: error: "},
      {table, "G0 X5\n", "--interpolator taylor", "error: --interpolator taylor is for machines of"},
      {table, "G0 X5\n", "--tool-length 5", "error: --tool-length is for machines with a tilting axis"},
      {four_axes() + axis("B", "rotary", ""), "G0 R5\n", "", "m.toml:1:1: error: the axes must be X, Y, Z"},
      {"table_center = [0, 0]\n" + four_axes(), "G0 R5\n", "", "m.toml:1:16: error: table_center is for"},
      {"smallest_radius = 1\n", "G0 X5\n", "", "m.toml:1:1: error: smallest_radius is for"},
      {axis("R", "linear", "") + axis("R", "linear", "") + axis("C", "rotary", ""), "G0 X5\n", "",
       "m.toml:1:1: error: an axis is there twice"},
      {"table_center = [-50, 0]\n" + axis("R", "linear", "travel = [0, 60]\n") + axis("Z", "linear", "") +
           axis("C", "rotary", ""),
       "G0 X5\nY20\nX40\n", "", "program.ngc:3:1: error: axis R would move to "},
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
