// All that is wrong with a program is told at once.
#include <algorithm>
#include <string>

#include "simulate/run.hpp"
#include "support/catch.hpp"

using namespace cncplan;

TEST_CASE("twenty problems of a program are told, each on its line") {
  const test::Folder folder;
  std::string program = "G21 G90 F600\n";
  for (int i = 0; i < 30; ++i) program += "G1 X" + std::to_string(i) + " D1\n";
  const auto run = folder.run_text(program, "--json --motions m.csv");
  CHECK(run.exit == 2);
  CHECK(run.out.empty());
  CHECK_FALSE(folder.has("m.csv"));
  CHECK(std::count(run.err.begin(), run.err.end(), '\n') == 20);
  CHECK(run.err.starts_with("program.ngc:2:7: error: D is not supported\nprogram.ngc:3:7: error: "));
}

TEST_CASE(
    "a check (--check) tells up to a hundred problems, by kind and with their lines, and plans nothing") {
  const test::Folder folder;
  std::string program = "G21 G90 F600\nG1 X1 D1\nG2 X5 R1\nX6\nG2 X9 Y0 I2 J0\nG1 X2 D2\nM30\nD9\n";
  auto run = folder.run_text(program, "--check");
  CHECK(run.exit == 2);
  CHECK(run.out ==
        "   2  D is not supported: line 2, 6\n"
        "   1  radius: the end point is farther away than the arc's diameter: line 3\n"
        "   1  R or I J K: a required word is missing: line 4\n"
        "   1  center: radii at start and end point differ: line 5\n");
  CHECK(std::count(run.err.begin(), run.err.end(), '\n') == 5);
  run = folder.run("program.ngc --check --json");
  CHECK(run.json()["problems"] == 5);
  CHECK(run.json()["lines"] == 7);
  CHECK(run.json()["kinds"][0]["lines"] == std::vector<int>{2, 6});
  for (int i = 0; i < 200; ++i) program.insert(0, "!\n");
  run = folder.run_text(program, "--check --json");
  CHECK(run.json()["problems"] == 100);
  CHECK(folder.files() == std::set<std::string>{"program.ngc"});
}

TEST_CASE("a check (--check) of a program without problems") {
  const test::Folder folder;
  const auto run = folder.run_text("G21 G90 F600\nG1 X1000000\n", "--check");
  CHECK(run.exit == 0);
  CHECK(run.out == "no problems\n");
  CHECK(run.err.empty());
  CHECK(folder.run("program.ngc --check --samples s.csv").exit == 2);
  CHECK(folder.files() == std::set<std::string>{"program.ngc"});
}

TEST_CASE("a check (--check) says the same on a machine behind a map") {
  const test::Folder folder;
  folder.write(
      "m.toml",
      "kinematics = \"core-xy\"\n[[axis]]\nletter = \"A\"\n[[axis]]\nletter = \"B\"\n[[axis]]\nletter = "
      "\"Z\"\ntravel = [-5, 5]\n");
  std::string program = "G21 G90 F600\nG1 X1 D1\nZ9\nZ1\nX2 D2\nM30\n";
  const auto run = folder.run_text(program, "--machine m.toml --check");
  INFO(run.err);
  CHECK(run.exit == 2);
  CHECK(run.out ==
        "   2  D is not supported: line 2, 5\n"
        "   1  axis Z would leave its travel: line 3\n");
  CHECK(folder.run("program.ngc --machine m.toml --check --json").json()["kinds"][0]["lines"] ==
        std::vector<int>{2, 5});
  for (int i = 0; i < 200; ++i) program.insert(0, "!\n");
  CHECK(folder.run_text(program, "--machine m.toml --check --json").json()["problems"] == 100);
  const auto told = folder.run("program.ngc --machine m.toml");
  CHECK(std::count(told.err.begin(), told.err.end(), '\n') == 20);
  CHECK(folder.run_text("G1 X1 F600\n", "--machine m.toml --check").out == "no problems\n");
}

TEST_CASE("an arc whose radii differ is told with how its centre was meant") {
  const test::Folder folder;
  const auto told = [&](const std::string& arc) { return folder.run_text("G21 G90 F600\n" + arc, "").err; };
  const std::string differ = "error: center: radii at start and end point differ";
  CHECK(told("G0 X10 Y0\nG2 X0 Y10 I2 J0\n") ==
        "program.ngc:3:11: " + differ + " by 13.6205, at most 0.0282843 is allowed\n");
  CHECK(told("G0 X10 Y10\nG2 X20 Y20 I10 J20\n").ends_with("; they agree in G90.1\n"));
  CHECK(told("G90.1 G0 X10 Y10\nG2 X20 Y20 I0 J10\n").ends_with("; they agree in G91.1\n"));
}

TEST_CASE("lines end as they do on any system") {
  const test::Folder folder;
  for (const std::string end : {"\n", "\r", "\r\n", "\r\r\n"}) {
    CAPTURE(end.size());
    const auto run =
        folder.run_text("G21 G90 F600" + end + "G1 X10" + end + "G1 Y10" + end, "--json --quiet");
    CHECK(run.exit == 0);
    CHECK(run.json()["lines"] == 3);
    CHECK(run.json()["length_mm"] == 20.0);
  }
}

TEST_CASE("an events file may begin with a byte order mark") {
  const test::Folder folder;
  folder.write("e.csv", "\xEF\xBB\xBFt,event,value\n0.1,feed,0.5\n");
  CHECK(folder.run_text("G21 G90 F600\nG1 X10\n", "--quiet --events e.csv").exit == 0);
  folder.write("e.csv",
               "\xEF\xBB\xBF"
               "0.1,feed,0.5\n");
  CHECK(folder.run_text("G21 G90 F600\nG1 X10\n", "--quiet --events e.csv").exit == 0);
}

TEST_CASE("a word to pass through that moves the machine is refused where it stands") {
  const test::Folder folder;
  for (const char* word : {"G81", "G1", "G", "X", "F"}) {
    folder.write("m.toml", std::string("pass_through = [\"M62\", \"") + word + "\"]\n");
    CHECK(folder.run_text("G1 X1\n", "--machine m.toml").err ==
          "m.toml:1:24: error: " + std::string(word) +
              " says where or how the axes move, so it cannot be passed through\n");
  }
}
