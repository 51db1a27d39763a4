// Every option has an effect.
#include <cmath>

#include "simulate/table.hpp"
#include "support/catch.hpp"

using namespace cncplan;

namespace {

nlohmann::json summary(const std::string& options, const std::string& program = "pocket") {
  const test::Folder folder;
  const auto run = folder.run(test::example(program) + " --json " + options);
  INFO(options << ": " << run.err);
  REQUIRE(run.exit == 0);
  return run.json();
}

double time_of(const std::string& options) { return summary(options)["time_s"]; }

}  // namespace

TEST_CASE("limits: the lower, the slower") {
  const double standard = time_of("");
  CHECK(time_of("--vmax 30 --amax 1000 --jmax 10000 --period 0.001") == standard);
  for (const char* lower : {"--vmax 15", "--amax 100", "--jmax 1000"}) {
    INFO(lower);
    CHECK(time_of(lower) > standard * 1.01);
  }
  CHECK(time_of("--jmax 100000") < standard);
}

TEST_CASE("option --period sets the number of samples and nothing of the plan") {
  const auto fine = summary("--count-steps --period 0.0005"),
             coarse = summary("--count-steps --period 0.002");
  CHECK(fine["time_s"] == coarse["time_s"]);
  CHECK(fine["steps"] == coarse["steps"]);
  CHECK(fine["samples"] == std::ceil(fine["time_s"].get<double>() / 0.0005) + 1);
  CHECK(coarse["samples"] == std::ceil(fine["time_s"].get<double>() / 0.002) + 1);
  const auto longer = summary("--period 1000");
  CHECK(longer["samples"] == 2);
  CHECK(longer["end_error_mm"] < 1e-9);
}

TEST_CASE("every policy plans its own way, and several their minimum") {
  std::set<double> times;
  const auto policies = {"table", "stop", "tangent=1", "deviation=0.01", "acceleration-step=200"};
  for (const std::string policy : policies) {
    const double arcs = summary("--junction " + policy, "kk22_figure7")["time_s"];
    times.insert(arcs + time_of("--junction " + policy));
  }
  CHECK(times.size() == policies.size());
  CHECK(time_of("--junction deviation=0.01") == time_of("--tolerance 0"));
  const double both = time_of("--junction tangent=1+deviation=0.01");
  CHECK(both >= time_of("--junction tangent=1"));
  CHECK(both >= time_of("--junction deviation=0.01"));
  CHECK(time_of("--junction stop+table+deviation=5") == time_of("--junction stop"));
  const double low = time_of("--junction deviation=0.001");
  CHECK(time_of("--junction deviation=1+deviation=0.001") == low);
  CHECK(time_of("--junction deviation=0.001+deviation=1") == low);
}

TEST_CASE("the seven-phase law is faster where the acceleration binds, the same where not") {
  for (const std::string plan : {"block", "span"}) {
    INFO(plan);
    CHECK(time_of("--amax 200 --profile seven --plan " + plan) <
          time_of("--amax 200 --profile five --plan " + plan));
  }
  CHECK(time_of("--profile seven --plan block") ==
        Approx(time_of("--profile five --plan block")).epsilon(1e-12));
  CHECK(time_of("--profile seven") == time_of(""));
}

TEST_CASE("ramps across blocks are faster than published planning") {
  const test::Folder folder;
  std::string program = "F1800\n";
  for (int i = 1; i <= 200; ++i) program += "G1 X" + std::to_string(i * 0.2) + "\n";
  const auto time = [&](const std::string& options) {
    return folder.run_text(program, "--json " + options).json()["time_s"].get<double>();
  };
  CHECK(time("--plan span") < 0.8 * time("--plan block"));
  CHECK(time("--plan span") == time(""));
  // 40 mm from rest to rest: two ramps of 0.10954 s, which take 3.2863 mm together, and a cruise
  CHECK(time("--plan span") == Approx(2 * 0.109544512 + (40.0 - 3.286335345) / 30.0).epsilon(1e-6));
}

TEST_CASE("interpolators differ in their error and keep the end") {
  const auto exact = summary("--tolerance 0 --period 0.001 --interpolator exact"),
             taylor = summary("--period 0.001 --interpolator taylor");
  CHECK(exact["time_s"] == time_of("--tolerance 0"));
  CHECK(exact["contour_error_mm"] < 1e-12);
  CHECK(taylor["time_s"] == exact["time_s"]);
  CHECK(taylor["contour_error_mm"] < 1e-6);
  CHECK(taylor["end_error_mm"] < 1e-9);
  const test::Folder folder;
  const auto positions = [&](const std::string& name) {
    REQUIRE(folder.run(test::example("pocket") + " --quiet --samples s.csv --interpolator " + name).exit ==
            0);
    return test::Table(folder / "s.csv")["x"];
  };
  CHECK(positions("exact") != positions("taylor"));
}

TEST_CASE("constant increments: length over feed, for every block") {
  const test::Folder folder;
  const auto run = folder.run_text("G1 X9 F900\nG0 Y12\nG1 X0 F600\n",
                                   "--json --period 0.001 --interpolator constant --blocks b.csv");
  REQUIRE(run.exit == 0);
  CHECK(run.json()["time_s"].get<double>() == Approx(9.0 / 15.0 + 12.0 / 30.0 + 9.0 / 10.0));
  CHECK(test::Table(folder / "b.csv")["v_in"] == std::vector<double>{15.0, 30.0, 10.0});
  CHECK(run.json()["end_error_mm"] < 1e-9);
}

TEST_CASE("option --plot draws, or says why not") {
  const test::Folder folder;
  const auto run = folder.run(test::example("kk22_figure7") + " --quiet --plot \"it's/deep\"");
  REQUIRE(run.exit == 0);
  if (run.err.empty()) {
    for (const char* picture : {"it's/deep/path.svg", "it's/deep/profile.svg"})
      CHECK(test::text_of(folder / picture).find("<svg") != std::string::npos);
  } else {
    CHECK(run.err == "no pictures: gnuplot is not installed\n");
  }
}

TEST_CASE("a picture that cannot be written: exit code 1, the reason, and no other output") {
  const test::Folder folder;
  if (!std::filesystem::is_character_file("/dev/full") || std::system("command -v gnuplot >/dev/null") != 0) {
    WARN("SKIPPED: there is no /dev/full or no gnuplot");
    return;
  }
  std::filesystem::create_directory(folder / "pictures");
  std::filesystem::create_symlink("/dev/full", folder / "pictures/path.svg");
  const auto run = folder.run(test::example("pocket") + " --quiet --plot pictures --samples s.csv");
  CHECK(run.exit == 1);
  CHECK(run.err ==
        test::pocket_warning + "error: pictures/path.svg: cannot be written: No space left on device\n");
  CHECK_FALSE(std::filesystem::exists(folder / "s.csv"));
  CHECK_FALSE(std::filesystem::exists(folder / "pictures/profile.svg"));
}

TEST_CASE("gnuplot's warnings are not heard when quiet") {
  const test::Folder folder;
  const auto run = folder.run_text("G4 P1\n", "--quiet --plot pictures");  // a range of nothing
  CHECK(run.exit == 0);
  CHECK((run.err.empty() || run.err == "no pictures: gnuplot is not installed\n"));
}

TEST_CASE("option --help and --version say what they promise and succeed") {
  const test::Folder folder;
  const auto help = folder.run("--help");
  CHECK(help.exit == 0);
  for (const char* option : {"--vmax", "--amax", "--jmax", "--period", "--junction", "--profile", "--plan",
                             "--interpolator", "--machine", "--count-steps", "--motions", "--blocks",
                             "--samples", "--steps", "--plot", "--json", "--quiet"}) {
    INFO(option);
    CHECK(help.out.find(option) != std::string::npos);
  }
  const auto version = folder.run("--version");
  CHECK(version.exit == 0);
  CHECK(version.out.starts_with("cncplan "));
}

TEST_CASE("a number whose powers are none is refused") {
  const test::Folder folder;
  for (const char* option : {"--jmax 1e200", "--vmax 1e101", "--tolerance 1e300"}) {
    INFO(option);
    const auto run = folder.run_text("G1 X10 F600\nY10\n", option);
    CHECK(run.exit == 2);
    CHECK(run.err.find("must be 1e+100 at most") != std::string::npos);
  }
}

TEST_CASE("a check begins at any line, and tells what is wrong before it too") {
  const test::Folder folder;
  const auto run = folder.run_text("G21 G90 F600\nG1 X10\nG1 Y10\n", "--check --from-line 3");
  INFO(run.err);
  CHECK(run.exit == 0);
  CHECK(run.out == "no problems\n");
  CHECK(folder.run_text("G21 G90 F600\nG1 Q10\nG1 Y10\n", "--check --from-line 3").exit == 2);
}

TEST_CASE("a machine file of more axes than a program can have is refused") {
  const test::Folder folder;
  std::string file;
  for (const char letter : {'X', 'Y', 'Z', 'A', 'B', 'C', 'U'})
    file += std::string("[[axis]]\nletter = \"") + letter + "\"\n";
  folder.write("m.toml", file);
  const auto run = folder.run_text("G1 X1 F600\n", "--machine m.toml");
  CHECK(run.exit == 2);
  CHECK(run.err == "m.toml: error: axes of the machine's file: 7 is above the limit 6\n");
}
