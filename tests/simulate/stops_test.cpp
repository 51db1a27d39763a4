// What brings the machine to rest: dwells, stops of the program, tools, G61.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "cncplan/core/vector.hpp"
#include "simulate/table.hpp"
#include "support/catch.hpp"
#include "support/random.hpp"

using namespace cncplan;

namespace {

// Speed at the junction of two straight moves in line, with `between` between them.
double speed_behind(const std::string& between, const std::string& plan = "block") {
  const test::Folder folder;
  const auto run =
      folder.run_text("G1 X10\n" + between + "\nG1 X20\n", "--quiet --blocks b.csv --plan " + plan);
  INFO(between << ": " << run.err);
  REQUIRE(run.exit == 0);
  const test::Table blocks(folder / "b.csv");
  REQUIRE(blocks.rows() == 2);
  CHECK(blocks["v_in"][1] == blocks["v_out"][0]);
  return blocks["v_out"][0];
}

double time_of(const std::string& program) {
  const test::Folder folder;
  const auto run = folder.run_text(program, "--json");
  REQUIRE(run.exit == 0);
  return run.json()["time_s"];
}

}  // namespace

TEST_CASE("straight on runs through, stops of the program do not") {
  for (const std::string plan : {"block", "span"}) {
    for (const char* passing : {"", "M3 S1000", "M5", "M8", "M9", "F1800", "G64", "(a comment)", "N20"}) {
      INFO(passing);
      CHECK(speed_behind(passing, plan) == Approx(30.0));
    }
    for (const char* stop : {"M0", "M1", "M6", "T3", "T1 M6", "G4 P0", "G4 P0.25"}) {
      INFO(stop);
      CHECK(speed_behind(stop, plan) == 0.0);
    }
  }
}

TEST_CASE("G61 stops where the path turns, G61.1 behind each move, G64 returns to the policy") {
  for (const std::string mode : {"G61", "G61.1"}) {
    const test::Folder folder;
    const auto run = folder.run_text(mode + "\nG1 X10\nX20 Y0.1\nG64\nX30 Y0.2\nX40 Y0.3\nX50 Y0.4\n",
                                     "--quiet --blocks b.csv --junction deviation=0.1");
    REQUIRE(run.exit == 0);
    const auto out = test::Table(folder / "b.csv")["v_out"];
    CHECK(out[0] == 0.0);
    if (mode == "G61")
      CHECK(out[1] == Approx(30.0));
    else
      CHECK(out[1] == 0.0);
    CHECK(out[2] == Approx(30.0));
    CHECK(out[3] == Approx(30.0));
    CHECK(out[4] == 0.0);
  }
}

TEST_CASE("on the exact path G64's tolerance is said once to be ignored") {
  const test::Folder folder;
  const auto run = folder.run_text("G64 P0.01 Q0.02\nG1 X1\nG64 P0.1\nX2\n", "--json --tolerance 0");
  REQUIRE(run.exit == 0);
  CHECK(run.err ==
        "program.ngc:1:5: warning: tolerance of G64 is ignored\n"
        "program.ngc:1:11: warning: Q of G64 is ignored\n");
  CHECK(run.json()["warnings"] == 2);
}

TEST_CASE("a program's own G64 P wins over --tolerance") {
  const test::Folder folder;
  const std::string program = "G64 P0.002\nG1 X50\nG64 P0.1\nX100 Y5\nG61 X150\nY20\nG64\nX200\nX250 Y25\n";
  const auto run =
      folder.run_text(program, "--json --period 1e-4 --samples s.csv --tolerance 0.03 --smooth fast");
  REQUIRE(run.exit == 0);
  CHECK(run.err.empty());
  const test::Table samples(folder / "s.csv");
  const auto nearest = [&](double x, double y) {
    double gap = 1e9;
    for (std::size_t i = 0; i < samples.rows(); ++i)
      gap = std::min(gap, std::hypot(samples["x"][i] - x, samples["y"][i] - y));
    return gap;
  };
  // from the corner to the middle of what rounds it, with samples every 0.003 mm
  CHECK(nearest(50, 0) > 0.001);
  CHECK(nearest(50, 0) <= 0.0026);
  CHECK(nearest(150, 5) < 2e-6);  // exact, at rest
  CHECK(nearest(200, 20) > 0.005);
  CHECK(nearest(200, 20) <= 0.0305);
}

TEST_CASE("G64 Q merges lines, of which each has its row, all within P") {
  constexpr std::size_t count = 120;
  constexpr double step = 0.05, P = 0.01;
  constexpr double period = 1e-4;
  const std::string level = GENERATE("fast", "good", "best");
  const test::Folder folder;
  test::Random random;
  std::string lines;
  std::vector<double> x{0}, y{0};
  for (std::size_t i = 1; i <= count; ++i) {
    x.push_back(step * static_cast<double>(i)), y.push_back(0.001 * random.integer(-2, 2));
    lines += "G1 X" + std::to_string(x[i]) + " Y" + std::to_string(y[i]) + "\n";
  }
  const auto run_with = [&](const std::string& mode) {
    const auto run = folder.run_text(mode + lines,
                                     "--json --period 1e-4 --blocks b.csv --samples s.csv --smooth " + level);
    REQUIRE(run.exit == 0);
    CHECK(run.err.empty());
    return run.json();
  };
  const auto without = run_with("G64 P0.01\n"), with = run_with("G64 P0.01 Q0.004\n");
  CHECK(with["time_s"].get<double>() <= without["time_s"].get<double>() * (level == "fast" ? 0.9 : 1.001));
  CHECK(with["length_mm"] == without["length_mm"]);
  CHECK(with["deviation_mm"].get<double>() <= P);
  CHECK(with["contour_error_mm"].get<double>() < 1e-9);
  CHECK(with["end_error_mm"].get<double>() < 1e-9);
  const test::Table blocks(folder / "b.csv"), samples(folder / "s.csv");
  REQUIRE(blocks.rows() == count);
  double time = 0;
  for (std::size_t i = 0; i < count; ++i) {
    CHECK(blocks["line"][i] == static_cast<double>(i + 2));
    CHECK(blocks["length"][i] == Approx(std::hypot(x[i + 1] - x[i], y[i + 1] - y[i])));
    time += blocks["duration"][i];
  }
  CHECK(time == Approx(with["time_s"].get<double>()));
  double most = 0;
  for (std::size_t i = 0; i < samples.rows(); ++i) {
    double nearest = 1;
    for (std::size_t k = 0; k < count; ++k) {
      const Vector3 a(x[k], y[k], 0), way = Vector3(x[k + 1], y[k + 1], 0) - a,
                                      p = Vector3(samples["x"][i], samples["y"][i], samples["z"][i]) - a;
      nearest = std::min(nearest, (p - std::clamp(p.dot(way) / way.squaredNorm(), 0.0, 1.0) * way).norm());
    }
    most = std::max(most, nearest);
  }
  CHECK(most <= P);
  // Between samples, at up to 30 mm/s, paths that are at slopes of 0.08 at most part by no more than this.
  constexpr double between = 30.0 * period / 2 * 2 * 0.08;
  CHECK(with["deviation_mm"].get<double>() >= most - 1e-9);
  CHECK(with["deviation_mm"].get<double>() <= most + between);
}

TEST_CASE("option --tolerance: within limits as samples show, within the tolerance, without a jump") {
  const test::Folder folder;
  const std::string program = "G1 X10\nX10.1 Y0.05\nX20 Y9\nG3 X30 Y19 R10\nG1 X30 Y30\nX29 Y30\nX10\nY0\n";
  const double tolerance = GENERATE(0.002, 0.01, 0.1);
  const std::string level = GENERATE("fast", "good", "best");
  CAPTURE(tolerance, level);
  const auto run = folder.run_text(program, "--json --period 1e-4 --samples s.csv --smooth " + level +
                                                " --tolerance " + std::to_string(tolerance));
  REQUIRE(run.exit == 0);
  const auto json = run.json();
  const test::Table samples(folder / "s.csv");
  const auto& x = samples["x"];
  const auto& y = samples["y"];
  double velocity = 0.0, acceleration = 0.0, jerk = 0.0;  // of the vector, by differences
  constexpr double h = 1e-4;
  for (std::size_t i = 3; i + 1 < x.size(); ++i) {
    const auto norm = [&](auto&& of) { return std::hypot(of(x), of(y)); };
    velocity = std::max(velocity, norm([i](const auto& q) { return q[i] - q[i - 1]; }) / h);
    acceleration =
        std::max(acceleration, norm([i](const auto& q) { return q[i] - 2 * q[i - 1] + q[i - 2]; }) / (h * h));
    jerk = std::max(jerk, norm([i](const auto& q) { return q[i] - 3 * q[i - 1] + 3 * q[i - 2] - q[i - 3]; }) /
                              (h * h * h));
  }
  CHECK(velocity <= 30 * (1 + 1e-9));
  CHECK(acceleration <= 1000 * (1 + 1e-6));
  CHECK(jerk <= 10000 * (1 + 1e-4));
  CHECK(json["tolerance_mm"] == tolerance);
  CHECK(json["deviation_mm"].get<double>() <= tolerance);
  CHECK(json["deviation_mm"].get<double>() > 0.1 * tolerance);  // fast rests at sharp corners
  CHECK(json["acceleration_jumps"] == 0);
  CHECK(json["corner_velocity_step"].get<double>() < 1e-9);
  CHECK(json["tool_peak"]["jerk"].get<double>() <= 10000 * (1 + 1e-9));
  CHECK(json["tool_peak"]["jerk"].get<double>() >= jerk * (1 - 1e-4));
}

TEST_CASE("option --smooth goes with a tolerance, and with events at every level") {
  const test::Folder folder;
  folder.write("part.ngc", "G1 X10\nX20 Y1\n");
  folder.write("events.csv", "0.1,hold\n0.2,resume\n");
  CHECK(folder.run("part.ngc --smooth fast --tolerance 0").exit == 2);
  CHECK(folder.run("part.ngc --smooth fine --tolerance 0.01").exit == 2);
  CHECK(folder.run("part.ngc --smooth best --tolerance 0.01 --quiet --events events.csv").exit == 0);
  CHECK(folder.run("part.ngc --smooth good --tolerance 0.01 --quiet --events events.csv").exit == 0);
  CHECK(folder.run("part.ngc --smooth good --tolerance 0.01 --quiet").exit == 0);
  CHECK(folder.run("part.ngc --smooth best --tolerance 0.01 --quiet").exit == 0);
  CHECK(folder.run("part.ngc --tolerance 0.01 --quiet --events events.csv").exit == 0);
}

TEST_CASE("parameters, loops and files of subprograms are carried out, and faults are told in their file") {
  const test::Folder folder;
  folder.write("cut.ngc", "o<cut> sub\nG1 X[#<_x> + #1]\no<cut> endsub\n");
  folder.write("part.ngc", "#2 = 3\no1 repeat [#2]\no<cut> call [10]\no1 endrepeat\nM30\n");
  const auto json = folder.run("part.ngc --json").json();
  CHECK(json["motions"] == 3);
  CHECK(json["length_mm"].get<double>() == Approx(30));
  folder.write("cut.ngc", "o<cut> sub\nG1 X1 X2\no<cut> endsub\n");
  const auto run = folder.run("part.ngc --json");
  CHECK(run.exit == 2);
  CHECK(run.err.find("cut.ngc:2:") != std::string::npos);
}

TEST_CASE("dwells count in the time, wherever they stand") {
  const double moving = time_of("G1 X10\nG4 P0\nX20\n");
  CHECK(time_of("G1 X10\nG4 P0.25\nX20\n") == Approx(moving + 0.25).epsilon(1e-12));
  CHECK(time_of("G4 P1.5\nG1 X10\nG4 P0\nX20\n") == Approx(moving + 1.5).epsilon(1e-12));
  CHECK(time_of("G1 X10\nG4 P0.5\nG4 P0.5\nX20\nG4 P2\nM30\n") == Approx(moving + 3.0).epsilon(1e-12));
  CHECK(time_of("G4 P2.5\n") == 2.5);
}

TEST_CASE("a program without motion has its one sample") {
  const test::Folder folder;
  for (const char* program : {"", "M30\n", "%\n%\n", "(nothing)\n", "G1 X0\n"})
    for (const std::string interpolator : {"exact", "taylor", "constant"}) {
      INFO(program << ' ' << interpolator);
      const auto run = folder.run_text(
          program, "--json --samples s.csv --motions m.csv --blocks b.csv --steps x.vcd --interpolator " +
                       interpolator);
      REQUIRE(run.exit == 0);
      const auto json = run.json();
      CHECK(json["time_s"] == 0.0);
      CHECK(json["motions"] == 0);
      CHECK(json["samples"] == 1);
      CHECK(test::Table(folder / "s.csv").rows() == 1);
      CHECK(test::Table(folder / "m.csv").rows() == 0);
      CHECK(test::Table(folder / "b.csv").rows() == 0);
    }
}

TEST_CASE("at the level fast a corner rests where it could leave the travel, and the summary tells it") {
  const test::Folder folder;
  folder.write("m.toml", "[[axis]]\nletter = \"X\"\n[[axis]]\nletter = \"Y\"\ntravel = [0.0, 300.0]\n");
  const std::string program = "F1800 G1 X10 Y0\nX11 Y0.005\nX12 Y0\nX20\nY10\n";
  for (const std::string events : {"", " --events e.csv"}) {
    folder.write("e.csv", "t,event,value\n0.2,hold,\n0.5,resume,\n");
    const auto run = folder.run_text(program, "--smooth fast --machine m.toml --json" + events);
    INFO(events << run.err);
    REQUIRE(run.exit == 0);
    const auto fallbacks = run.json()["fallbacks"];
    REQUIRE(fallbacks.size() == 1);
    CHECK(fallbacks[0]["lines"] == std::vector<int>{2, 3});
    CHECK(fallbacks[0]["level"] == "exact");
  }
}
