// Slips of a command line, an events file or a program, and what is said of them.
#include <string>

#include "simulate/run.hpp"
#include "support/catch.hpp"

using namespace cncplan;

TEST_CASE("an option that is not known is told with the one that is like it") {
  const test::Folder folder;
  const auto told = [&](const std::string& options) { return folder.run_text("G0 X1\n", options); };
  for (const auto& [slip, meant] :
       {std::pair{"--tolerence 3", "--tolerence is not known: --tolerance?"},
        std::pair{"--jmx=3", "--jmx is not known: --jmax?"},
        std::pair{"--sample s.csv", "--sample is not known: --samples?"},
        std::pair{"--rotary_tolerance 1", "--rotary_tolerance is not known: --rotary-tolerance?"},
        std::pair{"--wholly-other", "--wholly-other is not known"},
        std::pair{"other.nc", "not expected: other.nc"}}) {
    INFO(slip);
    const auto run = told(slip);
    CHECK(run.exit == 2);
    CHECK(run.err == std::string("error: ") + meant + "\n");
    CHECK(run.out.empty());
  }
}

TEST_CASE("a pause before a line without motion is told") {
  const test::Folder folder;
  folder.write("events.csv", "t,event,value\n0,pause,999\n0.1,pause, 2\n0.2,pause,0\n");
  const auto run = folder.run_text("F600\nG1 X10\nM3 S9\nG1 X20\n", "--events events.csv --json");
  CHECK(run.exit == 0);
  CHECK(run.err == "events.csv:2:9: warning: pause: program.ngc has no motion on line 999\n");
  CHECK(run.json()["warnings"] == 1);
  folder.write("events.csv", "0,pause,3\n");
  CHECK(folder.run_text("F600\nG1 X10\nM3 S9\nG1 X20\n", "--events events.csv --quiet").err ==
        "events.csv:1:9: warning: pause: program.ngc has no motion on line 3\n");
}

TEST_CASE("a thread that the machine cannot cut fast enough is refused") {
  const test::Folder folder;
  const auto told = [&](const std::string& text, const std::string& options) {
    const auto run = folder.run_text(text, options + " --quiet");
    return run.exit == 0 ? std::string() : run.err.substr(run.err.find("program.ngc:2:5: error"));
  };
  const std::string why = "program.ngc:2:5: error: speed of a thread: 66.66666666666667 is above the limit ";
  const std::string thread = "S2000 M3\nG33 Z-10 K2\n";
  CHECK(told(thread, "") == why + "30\n");
  CHECK(told(thread, "--vmax 66") == why + "66\n");
  CHECK(told(thread, "--vmax 67").empty());
  CHECK(told("S900 M3\nG33 Z-10 K2\nG1 F6000 X9\n", "").empty());
  folder.write("mill.toml",
               "[[axis]]\nletter = \"X\"\n[[axis]]\nletter = \"Y\"\n[[axis]]\nletter = \"Z\"\n"
               "velocity = 20\nacceleration = 1000\njerk = 10000\n");
  CHECK(told(thread, "--vmax 100 --machine mill.toml") == why + "20\n");
}

TEST_CASE("travel is told at the axis' word, in degrees for one that turns") {
  const test::Folder folder;
  folder.write("mill.toml",
               "[[axis]]\nletter = \"X\"\n[[axis]]\nletter = \"Y\"\n[[axis]]\nletter = \"Z\"\n[[axis]]\n"
               "letter = \"A\"\nkind = \"rotary\"\ntravel = [-110, 110]\nvelocity = 60\nacceleration = 1000\n"
               "jerk = 10000\n");
  const auto told = [&](const std::string& line) {
    return folder.run_text("F600\n" + line + "\n", "--machine mill.toml --quiet").err;
  };
  const std::string why = "error: axis A would move to 200, beyond its travel of -110 to 110\n";
  CHECK(told("G1 X1 A200") == "program.ngc:2:7: " + why);
  CHECK(told("G1 (A) X1 a200 ; A") == "program.ngc:2:11: " + why);
  CHECK(told("G1 X1 A[100 * 2]") == "program.ngc:2:7: " + why);
  CHECK(told("G1 X[10/2] A[100 * 2]") == "program.ngc:2:12: " + why);
}
