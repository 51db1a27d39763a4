// Machine files that name their kinematics: tips by formulas of the test's own, and what is refused.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "simulate/run.hpp"
#include "simulate/table.hpp"
#include "simulate/vcd.hpp"
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

TEST_CASE("edges on a machine behind a map are where the joints of its tip are") {
  const Folder folder;
  folder.write("m.toml", mill("table-table-ac", "A", "center = [0, 0, -60]\n"));
  const auto run =
      folder.run_text("F3000\nG43.4\nG1 X40\nY30 A-30 C45\nX0 Y40 A-45 C120\nG0 Z20\nG49\nM30\n",
                      "--machine m.toml --tolerance 0.02 --samples s --steps v --blocks b --json");
  INFO(run.err);
  REQUIRE(run.exit == 0);
  const Table rows(folder / "s");
  const cncplan::test::Vcd signals(folder / "v");
  const auto json = run.json();
  const auto &t = rows["t"], &x = rows["x"], &y = rows["y"], &z = rows["z"];
  for (const std::string name : {"X", "Y", "Z", "A", "C"}) {
    const auto& axis = signals.axis(name);
    CHECK(json["steps"][name] == axis.edges.size());
    CHECK(json["net_steps"][name] == axis.net());
    CHECK(axis.edges.size() > 1000);
    double count = 0, off = 0;
    auto edge = axis.edges.begin();
    for (std::size_t i = 0; i < rows.rows(); ++i) {
      for (; edge != axis.edges.end() && static_cast<double>(edge->time) * 1e-9 < t[i]; ++edge)
        count += edge->direction;
      const double a = rows["A"][i] * degree, c = rows["C"][i] * degree;
      const double u = std::cos(c) * x[i] - std::sin(c) * y[i], v = std::sin(c) * x[i] + std::cos(c) * y[i];
      const double w = z[i] + 60;
      const double place = name == "X"   ? u
                           : name == "Y" ? std::cos(a) * v - std::sin(a) * w
                           : name == "Z" ? std::sin(a) * v + std::cos(a) * w - 60
                                         : rows[name][i];
      off = std::max(off, std::abs(100 * place - count));
    }
    INFO(name);
    CHECK(off < 0.5 + 1e-3);
  }
  const Table blocks(folder / "b");
  CHECK(blocks["line"] == std::vector<double>{3, 4, 5, 6});
  double seconds = 0;
  for (const double duration : blocks["duration"]) seconds += duration;
  CHECK(seconds == Approx(json["time_s"].get<double>()));
  CHECK(json["deviation_mm"].get<double>() > 0.001);
  CHECK(json["deviation_mm"].get<double>() <= 0.02 * (1 + 1e-6));
}

TEST_CASE("where a program drives the axes, they are as far off the path as the summary says") {
  const Folder folder;
  folder.write("m.toml", mill("table-table-ac", "A", "center = [0, 0, -60]\n"));
  const auto run = folder.run_text("F1800\nG1 A-30 C20\nG64 P0.1\nG1 X20\nY20\nX40 Y22\nY0\n",
                                   "--machine m.toml --period 0.0005 --samples s --json");
  INFO(run.err);
  REQUIRE(run.exit == 0);
  const Table rows(folder / "s");
  const auto &x = rows["X"], &y = rows["Y"];
  constexpr std::array<std::array<double, 2>, 5> corners{{{0, 0}, {20, 0}, {20, 20}, {40, 22}, {40, 0}}};
  double off = 0;
  for (std::size_t i = 0; i < rows.rows(); ++i) {
    double least = 1e9;
    for (std::size_t k = 1; k < corners.size(); ++k) {
      const double u = corners[k][0] - corners[k - 1][0], v = corners[k][1] - corners[k - 1][1];
      const double p = x[i] - corners[k - 1][0], q = y[i] - corners[k - 1][1];
      const double t = std::clamp((p * u + q * v) / (u * u + v * v), 0.0, 1.0);
      least = std::min(least, std::hypot(p - t * u, q - t * v));
    }
    off = std::max(off, least);
  }
  CHECK(off > 0.05);
  CHECK(run.json()["deviation_mm"].get<double>() == Approx(off).epsilon(1e-3));
}

TEST_CASE("the step rate of a drive caps the speed of a joint behind a map") {
  // 100 steps a unit: 1000 steps/s are 10 mm/s or degrees/s, at the level best and on the exact path,
  // directly and with the map
  const std::vector<std::string> letters{"X", "Y", "Z", "A", "C"};
  for (const std::string& slow : letters)
    for (const std::string rule : {"max_step_rate = 1000\n", "pulse_width = 4e-4\npulse_gap = 6e-4\n"})
      for (const std::string tolerance : {"0", "0.02"}) {
        const Folder folder;
        std::string text = "kinematics = \"table-table-ac\"\n";
        for (const std::string& letter : letters)
          text += axis(letter, letter < "X" ? "rotary" : "linear", letter == slow ? rule : "");
        folder.write("m.toml", text + "[lengths]\ncenter = [0, 0, -60]\n");
        const auto run = folder.run_text(
            "G1 X10 Y5 Z2 A-5 C9 F3000\nG43.4\nG1 X20 A-20 C45\nY20 Z10\nG0 X0 A-30\nG49\nG0 X10 Y0 Z0 A0 "
            "C0\n",
            "--machine m.toml --steps v --json --tolerance " + tolerance);
        INFO(slow << ", " << rule << "tolerance " << tolerance << ": " << run.err);
        REQUIRE(run.exit == 0);
        const double peak = run.json()["axis_peak"]["velocity"][slow].get<double>();
        CHECK(100 * peak <= 1000 * (1 + 1e-9));
        CHECK(100 * peak >= 950);
        const cncplan::test::Vcd signals(folder / "v");
        const auto& edges = signals.axis(slow).edges;
        CHECK(edges.size() > 500);
        std::int64_t closest = std::numeric_limits<std::int64_t>::max();
        for (std::size_t i = 1; i < edges.size(); ++i)
          closest = std::min(closest, static_cast<std::int64_t>(edges[i].time - edges[i - 1].time));
        CHECK(closest >= 1000000 - 1);
      }
}

TEST_CASE("a program from standard input runs on a machine behind a map") {
  const Folder folder;
  folder.write("m.toml", arm("upper = 200\nfore = 150\n"));
  folder.write("p", "G0 X200 Y100\nG1 X150 F3000\n");
  const auto run = folder.run("- --machine m.toml --json < p");
  INFO(run.err);
  REQUIRE(run.exit == 0);
  CHECK(run.json()["motions"] == 2);
}

TEST_CASE("a machine behind a map is held, slowed and goes on, within the limits of its joints") {
  const std::string program = "F3000\nG43.4\nG1 X40\nY30 A-30 C45\nX0 Y40 A-45 C120\nG0 Z20\nG49\nM30\n";
  for (const std::string options : {"--tolerance 0.02", "--tolerance 0.02 --smooth best", "--tolerance 0"}) {
    INFO(options);
    const Folder folder;
    folder.write("m.toml", mill("table-table-ac", "A", "center = [0, 0, -60]\n"));
    folder.write("e.csv", "0.4,hold\n1.5,resume\n1.8,feed,0.5\n3,feed,1\n");
    const std::string all = "--machine m.toml --json --count-steps --period 0.001 " + options;
    const auto alone = folder.run_text(program, all).json();
    const auto run = folder.run_text(program, all + " --events e.csv --samples s.csv");
    INFO(run.err);
    REQUIRE(run.exit == 0);
    const auto held = run.json();
    CHECK(held["completed"] == true);
    CHECK(held["net_steps"] == alone["net_steps"]);
    CHECK(held["time_s"].get<double>() > alone["time_s"].get<double>() + 1);
    const Table rows(folder / "s.csv");
    const auto& t = rows["t"];
    for (const std::string name : {"X", "Y", "Z", "A", "C"}) {
      const auto& q = rows[name];
      double velocity = 0, acceleration = 0, jerk = 0, in_hold = 0;
      for (std::size_t i = 3; i + 1 < rows.rows(); ++i) {
        const double v = (q[i] - q[i - 1]) * 1e3, a = (q[i] - 2 * q[i - 1] + q[i - 2]) * 1e6;
        velocity = std::max(velocity, std::abs(v));
        acceleration = std::max(acceleration, std::abs(a));
        jerk = std::max(jerk, std::abs(q[i] - 3 * q[i - 1] + 3 * q[i - 2] - q[i - 3]) * 1e9);
        if (t[i] > 1.2 && t[i] < 1.5) in_hold = std::max(in_hold, std::abs(v));
      }
      INFO(name);
      CHECK(velocity <= 100 * (1 + 1e-6));
      if (options == "--tolerance 0") continue;  // accelerations jump at the corners of the exact path
      CHECK(acceleration <= 1000 * (1 + 1e-4));
      CHECK(jerk <= 20000 * (1 + 1e-3));
      CHECK(in_hold < 1e-6);
    }
  }
}

TEST_CASE("a program begins at a line on a machine behind a map, and tells its motions") {
  const Folder folder;
  folder.write("m.toml", arm("upper = 200\nfore = 150\n"));
  const std::string program = "G0 X200 Y100\nG1 X150 F3000\nG2 X150 Y50 I0 J-25\nG1 Z-5\n";
  const std::string options = "--machine m.toml --json --motions m.csv --samples s.csv --period 0.01";
  REQUIRE(folder.run_text(program, options).exit == 0);
  const Table motions(folder / "m.csv");
  CHECK(motions["line"] == std::vector<double>{1, 2, 3, 4});
  CHECK(motions["x1"] == std::vector<double>{200, 150, 150, 150});
  CHECK(motions["feed"][2] == 50);
  CHECK(motions["plane"] == std::vector<double>{17, 17, 17, 17});
  const auto run = folder.run_text(program, options + " --from-line 3");
  INFO(run.err);
  REQUIRE(run.exit == 0);
  CHECK(run.json()["motions"] == 2);
  CHECK(run.json()["length_mm"].get<double>() == Approx(25 * std::numbers::pi + 5));
  const Table samples(folder / "s.csv");
  CHECK(samples["x"].front() == Approx(150));
  CHECK(samples["y"].front() == Approx(100));
  CHECK(samples["z"].back() == Approx(-5));
}

TEST_CASE("a machine behind a map is planned block by block, by either law, and without ramps") {
  const Folder folder;
  folder.write("m.toml", arm("upper = 200\nfore = 150\n"));
  const std::string program = "G0 X200 Y100\nG1 X150 F3000\nX100 Y90\nX60\n";
  const auto time = [&](const std::string& options) {
    const auto run = folder.run_text(program, "--machine m.toml --json --tolerance 0 " + options);
    INFO(options << ": " << run.err);
    REQUIRE(run.exit == 0);
    return run.json()["time_s"].get<double>();
  };
  const double span = time("");
  CHECK(time("--plan block") >= span * (1 - 1e-9));
  CHECK(time("--profile five") >= span * (1 - 1e-9));
  CHECK(time("--interpolator constant") > 0);
}

TEST_CASE("a file may have the tool go along great circles, or the command line") {
  const auto off = [](const std::string& orientation, const std::string& option = "") {
    const Folder folder;
    folder.write("m.toml", orientation + mill("table-table-ac", "A", "center = [0, 0, -60]\n"));
    const auto run =
        folder.run_text("F3000\nG43.4\nG1 X40 A-30 C45\nY30 A-50 C120\nG49\n",
                        "--machine m.toml --tolerance 0 --period 0.005 --samples s --json" + option);
    INFO(run.err);
    REQUIRE(run.exit == 0);
    const Table rows(folder / "s");
    using Direction = std::array<double, 3>;
    const auto direction = [](double a, double c) -> Direction {
      return {std::sin(a * degree) * std::sin(c * degree), std::sin(a * degree) * std::cos(c * degree),
              std::cos(a * degree)};
    };
    const Direction p = direction(-30, 45), q = direction(-50, 120);
    const Direction across{p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
    const double length = std::hypot(across[0], across[1], across[2]);
    double most = 0;
    for (std::size_t i = 0; i < rows.rows(); ++i) {
      if (!(rows["y"][i] > 1e-6)) continue;
      const Direction d = direction(rows["A"][i], rows["C"][i]);
      most = std::max(most, std::abs(d[0] * across[0] + d[1] * across[1] + d[2] * across[2]) / length);
    }
    return most;
  };
  CHECK(off("orientation = \"great-circle\"\n") < 2e-6);
  CHECK(off("orientation = \"joints\"\n") > 0.05);
  CHECK(off("") > 0.05);
  CHECK(off("", " --orientation great-circle") < 2e-6);
  CHECK(off("orientation = \"great-circle\"\n", " --orientation joints") > 0.05);
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

TEST_CASE("each machine that a file can name runs, within its tolerance and its limits") {
  struct Case {
    std::string name, axes, lengths, start, program;  // axes: of each its letter, and R for a rotary one
    std::vector<double> end;                          // X Y Z of the tip
  };
  const std::string five = "G43.4\nG1 X9 B20 C5 F900\nY12 C25\nX2 Z3 B5\n";
  const std::string tilted = "G43.4\nG1 X9 A20 C5 F900\nY12 C25\nX2 Z3 A5\n";
  const std::string flat = "G0 X60 Y170 Z-5\nG1 X90 F1500\nY210\nX40 Z3\n";
  const std::vector<Case> cases{
      {"table-table-ac", "X Y Z AR CR", "center = [0, 0, -60]\napart = [0, 3, 0]", "", tilted, {2, 12, 3}},
      {"table-table-bc", "X Y Z BR CR", "center = [0, 5, -60]\napart = [3, 0, 0]", "", five, {2, 12, 3}},
      {"head-table", "X Y Z BR CR", "pivot_length = 150", "", five, {2, 12, 3}},
      {"head-head-ac", "X Y Z AR CR", "pivot_length = 150", "", tilted, {2, 12, 3}},
      {"head-head-bc", "X Y Z BR CR", "pivot_length = 150", "", five, {2, 12, 3}},
      {"nutating-head", "X Y Z BR CR", "lean = 45\npivot_length = 150", "", five, {2, 12, 3}},
      {"polar", "R Z CR", "", "[100, 0, 20]", flat, {40, 210, 3}},
      {"scara", "JR KR Z", "upper = 200\nfore = 150", "[0, 90, 0]", flat, {40, 210, 3}},
      {"scara-wrist",
       "JR KR Z CR",
       "upper = 200\nfore = 150\nleft = true",
       "[0, -90, 0, 90]",
       "G0 X60 Y170 Z-5 C0\nG1 X90 C40 F1500\nY210\nX40 Z3 C0\n",
       {40, 210, 3}},
      {"linear-delta",
       "A B C",
       "radius = 140\nrod = 270",
       "",
       "G0 X20 Y30 Z-200\nG1 X-40 F1500\nY-10\nX5 Z-190\n",
       {5, -10, -190}},
      {"rotary-delta",
       "AR BR CR",
       "base = 120\nplatform = 40\narm = 150\nrod = 320",
       "[10, 10, 10]",
       "G0 X20 Y30 Z-300\nG1 X-40 F1500\nY-10\nX5 Z-290\n",
       {5, -10, -290}},
      {"five-bar",
       "JR KR Z",
       "apart = 120\nupper = 150\nfore = 200",
       "[150, 30, 0]",
       "G0 X20 Y230 Z-5\nG1 X-40 F1500\nY200\nX10 Z3\n",
       {10, 200, 3}},
      {"core-xy", "A B Z", "", "", "G1 X9 Y3 F900\nX20\nY30 Z3\n", {20, 30, 3}},
      {"wrist-arm",
       "AR BR CR UR VR WR",
       "height = 400\noutward = 25\nupper = 560\nrise = 35\nfore = 515\nflange = 80",
       "[0, 0, 0, 0, 60, 0]",
       "G0 X600 Y100 Z400 A0 B90 C0\nG1 Y-100 B80 F3000\nZ450 C20\nX650 B90 C0\n",
       {650, -100, 450}}};
  for (const Case& c : cases) {
    const Folder folder;
    std::string file = "kinematics = \"" + c.name + "\"\n";
    if (!c.start.empty()) file += "start = " + c.start + "\n";
    std::string letters;
    std::istringstream words(c.axes);
    for (std::string word; words >> word;) {
      letters += word[0];
      file += axis(word.substr(0, 1), word.size() > 1 ? "rotary" : "linear");
    }
    if (!c.lengths.empty()) file += "[lengths]\n" + c.lengths + "\n";
    folder.write("m.toml", file);
    for (const std::string how : {"--tolerance 0", "--tolerance 0.05 --smooth good", "--tolerance 0.05"}) {
      const auto run =
          folder.run_text(c.program, "--machine m.toml --period 0.002 --samples s --json " + how);
      INFO(c.name << " " << how << " " << run.err);
      REQUIRE(run.exit == 0);
      const auto json = run.json();
      CHECK(json["kinematics"] == c.name);
      for (const auto& part : json["fallbacks"]) {  // the way to the start, straight in the joints
        CHECK(part["lines"][0] == 1);
        CHECK(part["lines"][1] == 1);
      }
      const Table rows(folder / "s");
      CHECK(rows["x"].back() == Approx(c.end[0]));
      CHECK(rows["y"].back() == Approx(c.end[1]));
      CHECK(rows["z"].back() == Approx(c.end[2]));
      for (const char letter : letters) {  // differences of what was sampled
        const auto& q = rows[std::string(1, letter)];
        double fastest = 0;
        for (std::size_t i = 2; i < q.size(); ++i)
          fastest = std::max(fastest, std::abs(q[i - 1] - q[i - 2]) / 0.002);
        CHECK(fastest < 100 * (1 + 1e-6));
        CHECK(json["axis_peak"]["velocity"][std::string(1, letter)].get<double>() >= fastest * (1 - 1e-6));
      }
    }
  }
}

TEST_CASE("a program on a rotary table is smoothed within a tolerance") {
  const Folder folder;
  const std::string options =
      "--machine '" CNCPLAN_EXAMPLES "/machines/kk22.toml' --period 0.002 --samples s --json --tolerance ";
  const std::string text = "F1200\nG1 X20\nY20\nX0\nG2 X30 Y-10 R60\n";
  const auto exact = folder.run_text(text, options + "0"), smooth = folder.run_text(text, options + "0.05");
  INFO(exact.err << smooth.err);
  REQUIRE(exact.exit == 0);
  REQUIRE(smooth.exit == 0);
  const Table rows(folder / "s");
  double off = 0;
  for (std::size_t i = 0; i < rows.rows(); ++i) {  // the table's axis is at X-150
    const double c = rows["C"][i] * degree, r = rows["Y"][i];
    off = std::max(off, std::hypot(r * std::cos(c) - rows["x"][i] - 150, r * std::sin(c) - rows["y"][i]));
  }
  CHECK(off < 1e-9);
  CHECK(smooth.json()["kinematics"] == "polar");
  CHECK(smooth.json()["axis_peak"]["jerk"]["Y"].get<double>() <= 10000 * (1 + 1e-9));
  CHECK(rows["x"].back() == Approx(30));
  const auto near = folder.run_text("G1 X-149 F600\n", options + "0.05");
  CHECK(near.exit == 2);
  CHECK(near.err == "program.ngc:1:4: error: 1 mm from the table's axis: no nearer than 5 is driven\n");
  CHECK(folder.run_text(text, options + "0.05 --steps v").exit == 0);
  CHECK(folder.has("v"));
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
      {arm("upper = 200\nfore = 0\n"), "G0 X1\n", "", "m.toml:25:8: error: fore must be greater than zero"},
      {"start = [0, 0, 0]\n", "G0 X1\n", "",
       "m.toml:1:9: error: start is where the joints of the machine are"},
      {"start = [0, 0]\n" + arm("upper = 200\nfore = 100\n"), "G0 X1\n", "",
       "m.toml:1:9: error: start must be a list of 3 numbers"},
      {"start = [0, -30, 0]\n" + arm("upper = 200\nfore = 100\n"), "G0 X1\n", "",
       "m.toml:1:9: error: scara cannot stand at this start"},
      {"kinematics = \"five-bar\"\n" + axis("J", "rotary") + axis("K", "rotary") + axis("Z", "linear") +
           "[lengths]\napart = 120\nupper = 150\nfore = 200\n",
       "G0 X1\n", "", "m.toml:1:14: error: five-bar cannot stand where all joints are 0: start must say"},
      {mill("nutating-head", "B", "lean = 91\n"), "G0 X1\n", "", "m.toml:"},
      {"orientation = \"linear\"\n" + table, "G0 X1\n", "",
       "m.toml:1:15: error: orientation must be joints or great-circle"},
      {"orientation = \"joints\"\n" + arm("upper = 200\nfore = 100\n"), "G0 X1\n", "",
       "m.toml:1:15: error: orientation is for five-axis machines, scara is none"},
      {"orientation = \"joints\"\n", "G0 X1\n", "",
       "m.toml:1:15: error: orientation is that of the five-axis machine"},
      {"kinematics = \"linear-delta\"\n" + axis("A", "linear") + axis("B", "linear") + axis("C", "linear") +
           "[lengths]\nradius = 140\nrod = 140\n",
       "G0 X1\n", "", "m.toml:25:7: error: rod must be more than 140"},
      {"[lengths]\nupper = 3\n", "G0 X1\n", "", "m.toml:1:1: error: lengths are those of the machine"},
      {mill("table-table-ac", "B", ""), "G0 X1\n", "",
       "m.toml:1:14: error: the axes of table-table-ac must be XYZAC"},
      {table, "G43.4\nG1 A130 F100\n", "",
       "program.ngc:2:4: error: axis A would move to 130, beyond its travel"},
      {table, "G1 X1 Y2 A-130 F100\n", "",
       "program.ngc:1:10: error: axis A would move to -130, beyond its travel"},
      {arm("upper = 200\nfore = 100\n"), "G0 X1\n", "--orientation joints",
       "error: --orientation is for the five-axis machines that kinematics names"},
      {axis("X", "linear") + axis("Y", "linear"), "G0 X1\n", "--orientation great-circle",
       "error: --orientation is for the five-axis machines that kinematics names"},
      {table, "G0 X1\n", "--orientation up", "error: --orientation: up not in {"},
      {table, "G0 X1\n", "--interpolator taylor",
       "error: --interpolator taylor is for machines of X, Y and Z"},
      {table, "G0 X1\n", "--from-line 2", "error: --from-line 2: program.ngc has no motion there or behind"},
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
