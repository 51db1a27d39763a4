// Form of the outputs: headers, digits, keys of the summary, and what belongs on which stream.
#include <cmath>
#include <numbers>

#include "simulate/table.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

std::string first_line(const std::filesystem::path& file) {
  const std::string text = test::text_of(file);
  return text.substr(0, text.find('\n'));
}

}  // namespace

TEST_CASE("headers are the contract's") {
  const test::Folder folder;
  REQUIRE(
      folder.run(test::example("pocket") + " --quiet --motions m --blocks b --samples s --steps x").exit ==
      0);
  CHECK(first_line(folder / "m") == "line,kind,plane,x0,y0,z0,x1,y1,z1,cx,cy,cz,radius,sweep,length,feed");
  CHECK(first_line(folder / "b") == "line,length,v_in,v_peak,v_out,duration");
  CHECK(first_line(folder / "s") == "t,x,y,z,s,v,a,j");
  CHECK(first_line(folder / "x") == "$timescale 1 ns $end");
  CHECK(folder.files() == std::set<std::string>{"b", "m", "s", "x"});
}

TEST_CASE("an output may go to standard output, and the table goes aside") {
  const test::Folder folder;
  for (const std::string option : {"--motions", "--blocks", "--samples", "--steps", "--report"}) {
    CAPTURE(option);
    const auto run = folder.run(test::example("pocket") + ' ' + option + " -");
    CHECK(run.exit == 0);
    const auto filed = folder.run(test::example("pocket") + " --quiet " + option + " out");
    REQUIRE(filed.exit == 0);
    if (option != "--report")
      CHECK(run.out == test::text_of(folder / "out"));  // a report has times of the wall
    CHECK(run.out.size() > 100);
    CHECK(run.err.find("time") != std::string::npos);
    CHECK(folder.files() == std::set<std::string>{"out"});
    std::filesystem::remove(folder / "out");
  }
  const auto piped = folder.run("- --quiet --motions - < " + test::example("pocket"));
  CHECK(piped.exit == 0);
  CHECK(piped.out.starts_with("line,kind,"));
  const auto refused = [&](const std::string& options) {
    const auto run = folder.run(test::example("pocket") + ' ' + options);
    CHECK(run.exit == 2);
    CHECK(run.out.empty());
    return run.err;
  };
  CHECK(refused("--samples - --motions -") == "error: --motions and --samples both go to standard output\n");
  CHECK(refused("--samples - --json") == "error: --json and --samples both go to standard output\n");
  CHECK(refused("--plot -") == "error: --plot: pictures go into a folder, not to standard output\n");
}

TEST_CASE("the summary has all keys, each of its kind") {
  const test::Folder folder;
  const auto run = folder.run(test::example("pocket") +
                              " --json --count-steps --period 0.002 --vmax 25 --amax 900 --jmax 9000");
  REQUIRE(run.exit == 0);
  CHECK(run.err == test::pocket_warning);
  const auto json = run.json();
  for (const char* key : {"lines", "motions", "arcs", "samples", "junctions_limited", "warnings"}) {
    INFO(key);
    REQUIRE(json.contains(key));
    CHECK(json[key].is_number_unsigned());
  }
  for (const char* key : {"length_mm", "time_s", "corner_velocity_step", "end_error_mm", "contour_error_mm",
                          "plan_s", "measure_s", "interpolate_s", "steps_s"}) {
    INFO(key);
    REQUIRE(json.contains(key));
    CHECK(json[key].is_number_float());
  }
  for (const char* key : {"velocity", "acceleration", "jerk"}) {
    INFO(key);
    CHECK(json["peak"][key].is_number_float());
    CHECK(json["limits"][key].is_number_float());
  }
  for (const char* axis : {"X", "Y", "Z"}) {
    INFO(axis);
    CHECK(json["axis_peak"]["velocity"][axis].is_number_float());
    CHECK(json["axis_peak"]["acceleration"][axis].is_number_float());
    CHECK(json["axis_peak"]["jerk"][axis].is_number_float());
    CHECK(json["steps"][axis].is_number_integer());
    CHECK(json["net_steps"][axis].is_number_integer());
    CHECK(json["step_error_max"][axis].is_number_float());
    CHECK(json["rmse"][axis].is_number_float());
    const double rmse = json["rmse"][axis];
    CHECK(json["mse"][axis].get<double>() == Approx(rmse * rmse));
  }
  CHECK(json["limits"]["velocity"] == 25.0);
  CHECK(json["limits"]["acceleration"] == 900.0);
  CHECK(json["limits"]["jerk"] == 9000.0);
  CHECK(json["lines"] == 26);
  CHECK(json["warnings"] == 1);
  CHECK(json["motions"] == 19);
  CHECK(json["arcs"] == 7);
}

TEST_CASE("what only rotary axes do is no length and no feed of the tool in the summary") {
  const test::Folder folder;
  folder.write("m.toml",
               "[[axis]]\nletter = \"X\"\n[[axis]]\nletter = \"Y\"\n[[axis]]\nletter = \"Z\"\n"
               "[[axis]]\nletter = \"A\"\nkind = \"rotary\"\nsteps_per_unit = 10\n"
               "velocity = 6000\nacceleration = 100000\njerk = 1000000\n");
  const auto json =
      folder.run_text("G1 X10 F600\nA9000 F6000\nG0 A0\nX0\n", "--json --machine m.toml").json();
  CHECK(json["length_mm"].get<double>() == Approx(20));
  CHECK(json["cutting"]["length_mm"].get<double>() == Approx(10));
  CHECK(json["cutting"]["motions"] == 2);
  CHECK(json["rapid"]["length_mm"].get<double>() == Approx(10));
  CHECK(json["feeds"] == std::vector<double>{10});
  CHECK(json["capped"]["motions"] == 0);
}

TEST_CASE("the summary says where the tool goes, how far, how fast, with which tools") {
  const test::Folder folder;
  const auto run =
      folder.run_text("T2 M6\nG0 X10\nG1 Y10 F600\nG2 X20 Y10 I5\nG1 X0 F6000\nT1 M6\nT2 M6\nG0 Z5\n",
                      "--json --tolerance 0");
  REQUIRE(run.exit == 0);
  const auto json = run.json();
  const auto near = [](const nlohmann::json& place, double x, double y, double z) {
    CHECK(place[0].get<double>() == Approx(x).margin(1e-12));
    CHECK(place[1].get<double>() == Approx(y).margin(1e-12));
    CHECK(place[2].get<double>() == Approx(z).margin(1e-12));
  };
  near(json["box_mm"]["low"], 0, 0, 0);
  near(json["box_mm"]["high"], 20, 15, 5);  // the arc's top
  CHECK(json["cutting"]["motions"] == 3);
  CHECK(json["cutting"]["length_mm"].get<double>() == Approx(30 + 5 * std::numbers::pi));
  CHECK(json["rapid"]["motions"] == 2);
  CHECK(json["rapid"]["length_mm"] == 15.0);
  CHECK(json["cutting"]["time_s"].get<double>() + json["rapid"]["time_s"].get<double>() ==
        Approx(json["time_s"].get<double>()));
  CHECK(json["feeds"] == std::vector<double>{10, 100});
  CHECK(json["capped"]["motions"] == 1);
  CHECK(json["capped"]["highest_feed"] == 100.0);
  CHECK(json["tools"] == std::vector<int>{2, 1});
  const auto table = folder.run_text("G1 X3600 F3600\nG4 P3601\n", "--vmax 30");
  CHECK(table.out.find("(1:02:01)") != std::string::npos);  // 120 s and ramps, and the dwell
  CHECK(table.out.find("1 feed moves, of up to 3600 mm/min") != std::string::npos);
  CHECK(table.out.find("X 0 to 3600, Y 0 to 0, Z 0 to 0 mm") != std::string::npos);
}

TEST_CASE("steps are in the summary where they are asked for") {
  const test::Folder folder;
  folder.write("m.toml", "");
  const auto has_steps = [&](const std::string& options) {
    const auto json = folder.run(test::example("pocket") + " --json " + options).json();
    const auto table = folder.run(test::example("pocket") + " " + options).out;
    const bool has = json.contains("steps");
    for (const char* key : {"net_steps", "step_error_max", "mse", "rmse", "steps_s"})
      CHECK(json.contains(key) == has);
    CHECK((table.find("edges") != std::string::npos) == has);
    return has;
  };
  CHECK_FALSE(has_steps(""));
  CHECK(has_steps("--count-steps"));
  CHECK(has_steps("--steps x.vcd"));
  CHECK(has_steps("--machine m.toml"));
}

TEST_CASE("no number of the samples is -0") {
  const test::Folder folder;
  for (const char* program : {"G4 P0.01\n", "G1 X-0.0 Y5\n"}) {
    REQUIRE(folder.run_text(program, "--quiet --samples s.csv").exit == 0);
    const std::string text = test::text_of(folder / "s.csv");
    CHECK(text.find(",-0,") == std::string::npos);
    CHECK(text.find(",-0\n") == std::string::npos);
  }
}

TEST_CASE("the contour error is measured: what rounding leaves, and no more") {
  const test::Folder folder;
  const auto run = folder.run_text("G2 X20 Y3 R12\nG3 X22 Y5 Z1 R9\nG2 X22 Y5 I3 J-0.7 Z3\n",
                                   "--json --tolerance 0 --samples s.csv --motions m.csv");
  const test::Table samples(folder / "s.csv"), motions(folder / "m.csv");
  double worst = 0.0;  // of the distance from the circles' cylinders
  std::size_t motion = 0;
  double end = motions["length"][0];
  for (std::size_t i = 0; i < samples.rows(); ++i) {
    while (samples["s"][i] > end && motion + 1 < motions.rows()) end += motions["length"][++motion];
    const long double x = samples["x"][i], y = samples["y"][i];
    const long double gap =
        std::hypot(x - motions["cx"][motion], y - motions["cy"][motion]) - motions["radius"][motion];
    worst = std::max(worst, static_cast<double>(std::abs(gap)));
  }
  const double error = run.json()["contour_error_mm"];
  INFO(worst << ' ' << error);
  CHECK(error > 0.0);
  CHECK(error < 1e-12);
  CHECK(error >= 0.1 * worst);
}

TEST_CASE("axis peaks are no less than the samples of single arcs show") {
  const test::Folder folder;
  for (const std::string arc : {"G3 X1 Y0.2 R2", "G2 X20 Y3 R12", "G2 X8 Y0 R6", "G2 X2 Y0 R1"}) {
    const auto json = folder.run_text(arc + "\n", "--json --period 1e-5 --samples s.csv").json();
    const test::Table samples(folder / "s.csv");
    for (const auto& [name, column] : {std::pair{"X", "x"}, {"Y", "y"}}) {
      INFO(arc << ' ' << name);
      const auto& x = samples[column];
      double speed = 0.0, jerk = 0.0;
      for (std::size_t i = 1; i + 2 < x.size(); ++i)
        speed = std::max(speed, std::abs(x[i + 1] - x[i - 1]) / 2e-5);
      for (std::size_t i = 200; i + 300 < x.size(); i += 100)  // third differences over a millisecond each
        jerk = std::max(jerk, std::abs(x[i + 200] - 3 * x[i + 100] + 3 * x[i] - x[i - 100]) / 1e-9);
      // A peak is one that is attained, and 1e-6 of it may be missed (peaks.hpp).
      const double peak = json["axis_peak"]["velocity"][name];
      CHECK(peak <= speed * (1.0 + 1e-7));
      CHECK(peak >= speed * (1.0 - 1e-6));
      CHECK(json["axis_peak"]["jerk"][name].get<double>() >= jerk * (1.0 - 1e-3));
      CHECK(json["axis_peak"]["jerk"][name].get<double>() <= 10000.0 * (1.0 + 1e-9));
    }
  }
}

TEST_CASE("numbers keep all bits of a double") {
  const test::Folder folder;
  const auto run =
      folder.run_text("G1 X0.1 Y0.7 Z0.30000000000000004\n", "--json --motions m.csv --samples s.csv");
  REQUIRE(run.exit == 0);
  const test::Table motions(folder / "m.csv");
  CHECK(motions["x1"][0] == 0.1);
  CHECK(motions["y1"][0] == 0.7);
  CHECK(motions["z1"][0] == 0.30000000000000004);
  const test::Table samples(folder / "s.csv");
  CHECK(samples["t"].back() == run.json()["time_s"].get<double>());
  CHECK(samples["t"][3] == 3 * 0.001);
}

TEST_CASE("a table for people, JSON for programs, nothing when quiet") {
  const test::Folder folder;
  const auto table = folder.run(test::example("pocket"));
  CHECK(table.exit == 0);
  CHECK(table.out.find("path length") != std::string::npos);
  CHECK(table.out.find("peak /s^2") != std::string::npos);
  CHECK(table.err == test::pocket_warning);  // no bar where there is no terminal
  const auto quiet = folder.run(test::example("pocket") + " --quiet");
  CHECK(quiet.exit == 0);
  CHECK(quiet.out.empty());
  CHECK(quiet.err == test::pocket_warning);
  const auto both = folder.run(test::example("pocket") + " --quiet --json");
  CHECK(both.json()["motions"] == 19);
  CHECK(folder.files().empty());
}

TEST_CASE("option --motions has the programmed feed, whatever the limits") {
  const test::Folder folder;
  REQUIRE(
      folder.run_text("G1 X1\nX2 F6000\nX3 F60\nG93 X5 F6\nG0 X6\n", "--quiet --motions m.csv --blocks b.csv")
          .exit == 0);
  const auto feed = test::Table(folder / "m.csv")["feed"];
  CHECK(feed[0] == 30.0);  // none so far: the speed limit
  CHECK(feed[1] == 100.0);
  CHECK(feed[2] == 1.0);
  CHECK(feed[3] == Approx(0.2));  // 2 mm in a sixth of a minute
  CHECK(feed[4] == 30.0);
  CHECK(test::Table(folder / "b.csv")["v_peak"][1] <= 30.0 * (1.0 + 1e-9));
}

TEST_CASE("axis peaks are those of samples so dense that they miss little") {
  const test::Folder folder;
  // an arc whose X speed is highest half way, a spiral, and a turn so fast that its curvature binds
  const auto run =
      folder.run_text("G2 X8 Y0 R6\nG3 X7 Y3.3 Z-1 I-1 J1.5 P2\nG2 X7.5 Y3.3 R0.25\nG1 X0 Y-3 Z1\n",
                      "--json --plan block --junction stop --period 1e-5 --samples s.csv");
  REQUIRE(run.exit == 0);
  const auto json = run.json();
  const test::Table samples(folder / "s.csv");
  for (const auto& [name, column] : {std::pair{"X", "x"}, {"Y", "y"}, {"Z", "z"}}) {
    INFO(name);
    const auto& x = samples[column];
    double speed = 0.0, acceleration = 0.0;
    for (std::size_t i = 1; i + 2 < x.size(); ++i) {
      speed = std::max(speed, std::abs(x[i + 1] - x[i - 1]) / 2e-5);
      acceleration = std::max(acceleration, std::abs(x[i + 1] - 2.0 * x[i] + x[i - 1]) / 1e-10);
    }
    CHECK(json["axis_peak"]["velocity"][name].get<double>() == Approx(speed).epsilon(1e-5));
    CHECK(json["axis_peak"]["acceleration"][name].get<double>() == Approx(acceleration).epsilon(1e-3));
  }
}

TEST_CASE("corner steps and limited junctions are counted") {
  const test::Folder folder;
  const std::string corner = "G1 X10\nY10\nY20\n";
  const auto json = folder.run_text(corner, "--json --plan block --junction tangent=3").json();
  CHECK(json["corner_velocity_step"].get<double>() == Approx(3.0));
  CHECK(json["junctions_limited"] == 1);
  CHECK(folder.run_text(corner, "--json --junction stop").json()["junctions_limited"] == 2);
  CHECK(folder.run_text(corner, "--json --junction stop").json()["corner_velocity_step"] == 0.0);
}

TEST_CASE("the deviation is that from the nearest place of the path, also where arcs are as small as it") {
  const test::Folder folder;
  const std::string program = "G1 X0.4322 Y0.4505 Z-0.2538\nG2 X0.3217 Y0.2357 Z-0.2264 I0.0568 J-0.1574\n";
  for (const std::string tolerance : {"0.1", "0.2", "0.3"})
    for (const std::string level : {"fast", "good", "best"}) {
      CAPTURE(tolerance, level);
      const auto json =
          folder.run_text(program, "--json --quiet --tolerance " + tolerance + " --smooth " + level).json();
      CHECK(json["deviation_mm"].get<double>() <= std::stod(tolerance) * (1 + 1e-6));
    }
}
