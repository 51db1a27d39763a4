// What is refused: the code, one line that says why and where, and no file left behind.
#include <algorithm>
#include <csignal>
#include <fstream>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "simulate/run.hpp"
#include "support/catch.hpp"
#include "support/shared.hpp"

using namespace cncplan;

namespace {

// Runs with every output asked for; returns the line on standard error behind these warnings.
std::string refused(const test::Folder& folder, const std::string& arguments, int exit,
                    const std::string& warnings = "") {
  const auto before = folder.files();
  const auto run = folder.run(arguments);
  INFO(arguments << '\n' << run.err);
  CHECK(run.exit == exit);
  CHECK(run.out.empty());
  CHECK(folder.files() == before);
  CHECK(run.err.starts_with(warnings));
  const std::string rest = run.err.substr(std::min(warnings.size(), run.err.size()));
  CHECK(std::count(rest.begin(), rest.end(), '\n') == 1);
  return rest.substr(0, rest.find('\n'));
}

// The first line of what a program prints that is no warning.
std::string first_error(std::string_view text) {
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    if (line.find(": warning: ") == std::string_view::npos) return std::string(line);
    text.remove_prefix(std::min(line.size() + 1, text.size()));
  }
  return "";
}

constexpr const char* outputs = " --json --motions m.csv --blocks b.csv --samples s.csv --steps x.vcd";

// Fields of a row of CSV, some between double quotes.
std::vector<std::string> fields(const std::string& row) {
  std::vector<std::string> result(1);
  bool quoted = false;
  for (const char c : row) {
    if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      result.emplace_back();
    else
      result.back() += c;
  }
  return result;
}

}  // namespace

TEST_CASE("bad programs: file, line, column and what is wrong") {
  struct Case {
    const char* program;
    const char* error;
  };
  const test::Folder folder;
  for (const auto& [program, error] : {
           Case{"G1 X1\n!\n", "part.ngc:2:1: error: !: unknown character"},
           {"G1 X1\nG2 X5 R1\n", "part.ngc:2:7: error: "},
           {"G2 X10 R4.99\n", "part.ngc:1:8: error: "},
           {"G2 X0 Y0 R5\n", "part.ngc:1:10: error: "},
           {"G2 X10.03 I5\n", "part.ngc:1:11: error: "},
           {"F0\nG1 X1\n", "part.ngc:2:1: error: "},
           {"G34 X1\n", "part.ngc:1:1: error: G34 is not supported"},
       }) {
    INFO(program);
    folder.write("part.ngc", program);
    const std::string line = refused(folder, "part.ngc" + std::string(outputs), 2);
    INFO(line);
    CHECK(line.starts_with(error));
  }
}

TEST_CASE("every rejected program fails with the sentence on its first line") {
  const test::Folder folder;
  // Refused by the reader alone: a program may have the language's words.
  const std::set<std::string> language{"assignment",   "expression",     "named_variable", "o_word",
                                       "o_word_named", "subprogram_end", "variable"};
  int programs = 0;
  for (const auto& entry : std::filesystem::directory_iterator(CNCPLAN_REJECTED)) {
    if (entry.path().extension() != ".ngc" || language.contains(entry.path().stem().string())) continue;
    const std::string text = test::text_of(entry.path());
    const std::string expected = text.substr(2, text.find('\n') - 2);
    INFO(entry.path().filename());
    folder.write("part.ngc", text);
    const auto run = folder.run("part.ngc --json");
    CHECK(run.exit == 2);
    CHECK(run.out.empty());
    CHECK(first_error(run.err) == "part.ngc:" + expected);
    ++programs;
  }
  CHECK(programs > 50);
}

TEST_CASE("odd arcs are accepted and refused as by LinuxCNC") {
  const auto shared = test::shared();
  if (!shared) {
    WARN("SKIPPED: CNCPLAN_SHARED is not set");
    return;
  }
  const test::Folder folder;
  std::ifstream rows(*shared + "/data/arc_errors_linuxcnc.csv");
  std::string row;
  std::getline(rows, row);  // names of the columns
  int blocks = 0;
  while (std::getline(rows, row)) {
    const auto columns = fields(row);  // case, block, accepted, what LinuxCNC said
    INFO(row);
    REQUIRE(columns.size() == 4);
    std::string block = columns[1];
    for (auto at = block.find("\\n"); at != std::string::npos; at = block.find("\\n"))
      block.replace(at, 2, 1, '\n');
    folder.write("part.ngc", "G21 G90 G17 G91.1 G94 F100\n" + block + "\n");
    if (columns[2] == "1")
      CHECK(folder.run("part.ngc --quiet --period 1").exit == 0);
    else
      CHECK(refused(folder, "part.ngc" + std::string(outputs), 2).starts_with("part.ngc:"));
    ++blocks;
  }
  CHECK(blocks == 34);
}

TEST_CASE("bad arguments: exit code 2 and the option's name") {
  struct Case {
    const char* options;
    const char* named;
  };
  const test::Folder folder;
  folder.write("part.ngc", "G1 X1\n");
  for (const auto& [options, named] : {Case{"--vmax 0", "--vmax"},
                                       {"--vmax -1", "--vmax"},
                                       {"--vmax nan", "--vmax"},
                                       {"--amax inf", "--amax"},
                                       {"--jmax fast", "--jmax"},
                                       {"--jmax", "--jmax"},
                                       {"--period 0", "--period"},
                                       {"--period 1e-13", "period"},
                                       {"--vmax 1e-300 --period 0.001", "samples"},
                                       {"--vmax 10 --vmax 20", "--vmax"},
                                       {"--profile six", "--profile"},
                                       {"--profile 1", "--profile"},
                                       {"--plan sometimes", "--plan"},
                                       {"--interpolator spline", "--interpolator"},
                                       {"--junction ''", "--junction"},
                                       {"--junction table=1", "--junction"},
                                       {"--junction deviation", "--junction"},
                                       {"--junction deviation=-1", "--junction"},
                                       {"--junction deviation=nan", "--junction"},
                                       {"--junction stop+", "--junction"},
                                       {"--fast", "--fast"},
                                       {"other.ngc", "other.ngc"},
                                       {"--samples part.ngc", "--samples"},
                                       {"--samples a.csv --steps ./a.csv", "--steps"},
                                       {"--samples ''", "--samples: the file name is empty"},
                                       {"--machine ''", "--machine: the file name is empty"},
                                       {"--plot ''", "--plot: the file name is empty"},
                                       {"--machine none.toml", "none.toml"},
                                       {"--machine .", "error"}}) {
    const std::string line = refused(folder, "part.ngc " + std::string(options), 2);
    INFO(line);
    CHECK(line.starts_with("error: "));
    CHECK(line.find(named) != std::string::npos);
  }
  CHECK(test::text_of(folder / "part.ngc") == "G1 X1\n");
  CHECK(refused(folder, "", 2) == "error: PROGRAM is required");
  CHECK(refused(folder, "none.ngc", 2) == "error: none.ngc: cannot be read");
  CHECK(refused(folder, ".", 2) == "error: .: cannot be read");
}

TEST_CASE("outputs that cannot be written: exit code 1, and the others are not written either") {
  const test::Folder folder;
  folder.write("part.ngc", "G1 X1\n");
  for (const char* option : {"--motions", "--blocks", "--samples", "--steps"})
    for (const char* place : {"no/such/folder/file", ".", "part.ngc/file"}) {
      const std::string alone = refused(folder, "part.ngc --quiet " + std::string(option) + " " + place, 1);
      INFO(alone);
      CHECK(alone.starts_with("error: " + std::string(place)));
    }
  CHECK(refused(folder, "part.ngc --quiet --motions m.csv --samples .", 1) == "error: .: is a directory");
  CHECK(refused(folder, "part.ngc --quiet --motions m.csv --plot part.ngc", 1) ==
        "error: part.ngc: cannot be written");
}

TEST_CASE("a full disk is noticed, whichever output meets it") {
  if (!std::filesystem::is_character_file("/dev/full")) {
    WARN("SKIPPED: there is no /dev/full");
    return;
  }
  const test::Folder folder;
  for (const char* option : {"--motions", "--blocks", "--samples", "--steps"}) {
    const std::string arguments = test::example("pocket") + " --quiet " + option + " /dev/full";
    CHECK(refused(folder, arguments, 1, test::pocket_warning) ==
          "error: /dev/full: cannot be written: No space left on device");
  }
  CHECK(std::filesystem::is_character_file("/dev/full"));
}

TEST_CASE("limits that are too small to plan with are bad input") {
  const test::Folder folder;
  const std::string line =
      refused(folder, test::example("pocket") + " --quiet --amax 1e-300", 2, test::pocket_warning);
  CHECK(line.find(".ngc:") != std::string::npos);  // wherever the first limit is too small for a number
  CHECK(line.find(": error: acceleration limit: 0 must be greater than zero") != std::string::npos);
}

TEST_CASE("a signal leaves no unfinished file") {
  const test::Folder folder;
  folder.write("part.ngc", "G1 X10000 F60\n");
  for (const std::string signal : {"INT", "TERM", "HUP"}) {
    INFO(signal);
    const std::string command = "cd " + test::quoted((folder / ".").string()) + " && timeout -s " + signal +
                                " 0.5 " CNCPLAN_SIMULATE " part.ngc --quiet --samples s.csv --steps x.vcd";
    CHECK(WEXITSTATUS(std::system(command.c_str())) == 124);
    CHECK(folder.files() == std::set<std::string>{"part.ngc"});
  }
}

TEST_CASE("many signals at once leave no unfinished file") {
  const test::Folder folder;
  folder.write("part.ngc", "G1 X10000 F60\n");
  const std::string command =
      "cd " + test::quoted((folder / ".").string()) +
      " && { " CNCPLAN_SIMULATE
      " part.ngc --quiet --samples s --steps x --motions m --blocks b & pid=$!; sleep 0.5;"
      " for i in $(seq 200); do kill -TERM $pid; done; wait $pid; } 2> /dev/null";
  for (int i = 0; i < 5; ++i) {  // one time of two a handler that lets a second signal in is caught
    CHECK(WEXITSTATUS(std::system(command.c_str())) == 128 + SIGTERM);
    CHECK(folder.files() == std::set<std::string>{"part.ngc"});
  }
}

TEST_CASE("links and devices are written as they stand") {
  const test::Folder folder;
  folder.write("target.csv", "old");
  std::filesystem::create_symlink("target.csv", folder / "link.csv");
  REQUIRE(folder.run(test::example("pocket") + " --quiet --motions link.csv --samples /dev/null").exit == 0);
  CHECK(std::filesystem::is_symlink(folder / "link.csv"));
  CHECK(test::text_of(folder / "target.csv").starts_with("line,kind,"));
  CHECK(std::filesystem::is_character_file("/dev/null"));
  CHECK(folder.run(test::example("pocket") + " --quiet --blocks /dev/stdout | head -1").out ==
        "line,length,v_in,v_peak,v_out,duration\n");
}
