// Where a program comes from, and what it is read with: standard input, tools, dialects.
#include <algorithm>
#include <filesystem>
#include <string>

#include "simulate/run.hpp"
#include "support/catch.hpp"

using namespace cncplan;

TEST_CASE("a program from standard input (-) is the one of the file") {
  const test::Folder folder;
  folder.write("part.ngc", "o1 sub\nG1 X[#1] F600\no1 endsub\no1 call [10]\no1 call [20]\nG0 X0\n");
  const auto file = folder.run("part.ngc --json --motions file.csv");
  const auto piped = folder.run("- --json --motions piped.csv <part.ngc");
  REQUIRE(file.exit == 0);
  REQUIRE(piped.exit == 0);
  CHECK(piped.json()["length_mm"] == file.json()["length_mm"]);
  CHECK(folder.read("piped.csv") == folder.read("file.csv"));
  CHECK(folder.run("- --check <part.ngc").out == "no problems\n");
  folder.write("bad.ngc", "G1 X1\n!\n");
  CHECK(folder.run("- --json <bad.ngc").err == "-:2:1: error: !: unknown character\n");
}

TEST_CASE("what cannot be read to its end is refused") {
  if (!std::filesystem::exists("/proc/self/mem")) {
    WARN("SKIPPED: there is no /proc/self/mem, whose first byte is a read error");
    return;
  }
  const test::Folder folder;
  folder.write("part.ngc", "G1 X10 F600\n");
  const auto refused = [&](const std::string& arguments, const std::string& name) {
    INFO(arguments);
    const auto run = folder.run(arguments);
    CHECK(run.exit == 2);
    CHECK(run.err == "error: " + name + ": cannot be read\n");
  };
  refused("/proc/self/mem --quiet", "/proc/self/mem");
  refused("/proc/self/mem --check", "/proc/self/mem");
  refused("- --quiet </proc/self/mem", "-");
  refused("- --quiet <&-", "-");
  refused("part.ngc --quiet --events /proc/self/mem", "/proc/self/mem");
  refused("part.ngc --quiet --machine /proc/self/mem", "/proc/self/mem");
}

TEST_CASE("a program from a pipe has subprograms and a report as that of a file") {
  const test::Folder folder;
  folder.write("part.ngc", "o1 sub\nG1 X[#1] F600 (a comment to be found)\no1 endsub\no1 call [10]\n");
  const auto file = folder.run("part.ngc --json --report file.html");
  if (file.err.find("--report: built without") != std::string::npos) {
    WARN("SKIPPED: built without the report's libraries");
    return;
  }
  REQUIRE(file.exit == 0);
  const auto shell = [&](const std::string& command) {
    return folder.run_program("sh", "-c " + test::quoted(command)).exit;
  };
  REQUIRE(shell("mkfifo pipe && (timeout 60 cat part.ngc >pipe &)") == 0);
  for (const char* const program : {"pipe", "- <part.ngc"}) {
    INFO(program);
    const auto run =
        folder.run_program("timeout", "60 " + test::quoted(CNCPLAN_SIMULATE) +
                                          " --json --report piped.html " + program);  // a pipe may hang
    INFO(run.err);
    REQUIRE(run.exit == 0);
    CHECK(run.json()["length_mm"] == file.json()["length_mm"]);
    CHECK(folder.read("piped.html").find("a comment to be found") != std::string::npos);
  }
}

TEST_CASE("the diameter of a tool is what G41 keeps off the path") {
  const test::Folder folder;
  folder.write("part.ngc", "F600 T2 M6\nG41 G1 X0 Y10\nX50\nG40 Y30\n");
  const auto rows = [&](const char* tools) {
    folder.write("m.toml", std::string("[tools]\n") + tools);
    const auto run = folder.run("part.ngc --json --tolerance 0 --machine m.toml --motions m.csv");
    INFO(run.err);
    REQUIRE(run.exit == 0);
    return folder.read("m.csv");
  };
  // line,kind,plane,x0,y0,z0,x1,y1,...: beside Y10, by the radius.
  CHECK(rows("2 = { length = 0.0, diameter = 6.0 }\n").find("\n3,line,17,0,13,0,50,13,0,") !=
        std::string::npos);
  CHECK(rows("2 = 0.0\n").find("\n3,line,17,0,10,0,50,10,0,") != std::string::npos);
}

TEST_CASE("a fault in a loop is told once") {
  const test::Folder folder;
  const auto run =
      folder.run_text("G1 F600\no1 repeat [50]\nG1 X1 D3\nG2 X5 R1\no1 endrepeat\n", "--check --json");
  CHECK(run.exit == 2);
  CHECK(run.json()["problems"] == 2);
}

TEST_CASE("other controls' programs are read by their dialect, with a warning each") {
  const test::Folder folder;
  folder.write("part.ngc", "$H\nZ5\nM104 S200\nG28 X\nG92 E0\nG1 X5 E.1 F600\nG1 X9 A90\nG4 S1\n");
  CHECK(folder.run("part.ngc --json").exit == 2);
  folder.write("m.toml", "dialect = \"marlin\"\n");
  const auto run = folder.run("part.ngc --json --machine m.toml");
  CHECK(run.exit == 0);
  CHECK(run.json()["motions"] == 3);
  // M104 is one of this control's codes, and S its own.
  CHECK(run.err ==
        "part.ngc:1:1: warning: $ is not known here: it is handed on\n"
        "part.ngc:2:1: warning: motion is a rapid: no motion code holds here\n"
        "part.ngc:5:5: warning: E names an axis that the machine lacks: it is left out\n"
        "part.ngc:7:7: warning: A names an axis that the machine lacks: it is left out\n");
}
