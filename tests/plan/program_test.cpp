#include "cncplan/program.hpp"

#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cncplan/junction/exact_stop.hpp"
#include "cncplan/plan_program.hpp"
#include "support/catch.hpp"
#include "support/program_run.hpp"

using namespace cncplan;

namespace {

const Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};

std::vector<std::string> problems(const ProgramRecord& program) {
  std::vector<std::string> result;
  for (const Problem& problem : program.problems()) result.push_back(to_text(problem));
  return result;
}

std::string error_of(const auto& planned) { return planned ? "no error" : to_text(planned.error()); }

}  // namespace

TEST_CASE("a travel error is told once, where the motion goes beyond", "[program]") {
  Machine<3> machine{.limits = mill.limits};
  machine.axes[0].high = 100;
  machine.axes[1].low = -50;
  const auto told = [&](const std::string& text) { return problems(read_text(text, machine)); };
  using Told = std::vector<std::string>;
  const std::string first = "2:4: error: axis X: 120 is above the limit 100";
  for (const char* rest :
       {"M30", "M0", "G4 P1", "M3 S100\nM5", "M6", "X120", "Y3", "X110", "X5\nX0", "G2 Y2 R1\nM2"}) {
    CAPTURE(rest);
    CHECK(told("G1 F600\nG1 X120\n" + std::string(rest) + "\n") == Told{first});
  }
  // Farther out, the other axis, and once more out from inside.
  CHECK(told("G1 F600\nG1 X120\nX130\nX125\nM30\n") ==
        Told{first, "3:1: error: axis X: 130 is above the limit 100"});
  CHECK(told("G1 F600\nG1 X120\nY-60\nM30\n") ==
        Told{first, "3:1: error: axis Y: -60 is below the limit -50"});
  CHECK(told("G1 F600\nG1 X120\nX0\nX120\nM30\n") ==
        Told{first, "4:1: error: axis X: 120 is above the limit 100"});
  // An arc that is beyond on its way alone.
  CHECK(told("F600\nG1 X95\nG2 X95 Y-20 R10\nM30\n").size() == 1);
  // Where it starts, with nothing that tells of it before.
  PlanOptions options;
  options.start = {120, 0, 0};
  for (const char* text : {"M30\n", "", "G4 P1\nM30\n"}) {
    CAPTURE(text);
    CHECK(problems(read_text(text, machine, options)).size() == 1);
  }
  // Other errors on such a line are told.
  CHECK(told("G1 F600\nG1 X120\nX5 Y\n").size() == 2);
}

TEST_CASE("places of rotary axes are told in degrees", "[program]") {
  Machine<4> machine{.limits = mill.limits};
  constexpr double degree = std::numbers::pi / 180;
  machine.axes[3] = {
      .letter = 'A', .kind = AxisKind::rotary, .velocity = 1, .low = -5.5 * degree, .high = 110 * degree};
  const auto told = problems(read_text("G1 A200 F600\nA-7.3\nX9\n", machine));
  REQUIRE(told.size() == 2);
  CHECK(told[0] == "1:4: error: axis A: 200 degrees is above the limit 110");
  CHECK(told[1] == "2:1: error: axis A: -7.3 degrees is below the limit -5.5");
  // The numbers themselves are rad.
  const auto program = read_text("G1 A200 F600\n", machine);
  CHECK(program.problems()[0].error().value == Approx(200 * degree));
  CHECK(program.problems()[0].error().bound == Approx(110 * degree));
  // With a place and without.
  CHECK(to_text(Error{ErrorCode::above_limit, "axis C", 90 * degree, -90 * degree, ErrorUnit::radians}) ==
        "axis C: 90 degrees is above the limit -90");
  CHECK(
      to_text(gcode::Diagnostic{{ErrorCode::above_limit, "axis C", 1, 0.5, ErrorUnit::radians}, 1, 1, {}}) ==
      "axis C: 57.29577951 degrees is above the limit 28.64788976");
  machine.axes[3].kind = AxisKind::linear;
  CHECK(problems(read_text("G1 A200 F600\n", machine))[0] ==
        "1:4: error: axis A: 200 is above the limit " + number_text(110 * degree));
}

TEST_CASE("all problems of a program are told, each at its place", "[program]") {
  Machine<4> machine{.limits = mill.limits};
  machine.axes[0].high = 100;
  const auto program = read_text(
      "G21 F600\n"
      "G1 X5 Y\n"        // a word
      "Y0\n"             //
      "X120\n"           // travel
      "G2 X10 Y10 R1\n"  // an arc
      "G1 X5 A90\n"      //
      "A0\n"             // no limits
      "G69\n"            // without effect
      "o1 if [1/0]\n"    // the language
      "o1 endif\n"       //
      "X1 X2\n"          // a word
      "X[1+2] (behind)\n",
      machine);
  const auto told = problems(program);
  INFO(Catch::StringMaker<std::vector<std::string>>::convert(told));
  REQUIRE(told.size() == 7);
  CHECK(told[0] == "2:7: error: Y has no number");
  CHECK(told[1] == "4:1: error: axis X: 120 is above the limit 100");
  CHECK(told[2].starts_with("5:12: error: "));
  CHECK(told[3] == "7:1: error: axis A: moves alone, without limits of its own");
  CHECK(told[4] == "8:1: warning: G69 is ignored");
  CHECK(told[5].starts_with("9:9: error: "));
  CHECK(told[6] == "11:4: error: X: word given twice");
  for (const Problem& problem : program.problems())
    CHECK(problem.is_error() == (to_text(problem).find("warning") == std::string::npos));
  CHECK(program.failed());
  CHECK(program.first_error() == &program.problems()[0]);
  CHECK(program.lines() == 12);
  CHECK(program.blocks().back().line == 12);
  CHECK(error_of(plan_program(program, machine, {.tolerance = 0})) == told[0]);
}

TEST_CASE("a program without errors is not failed, whatever its warnings", "[program]") {
  const auto program = read_text("G69\nG1 X5 F600\n", mill);
  CHECK(problems(program) == std::vector<std::string>{"1:1: warning: G69 is ignored"});
  CHECK_FALSE(program.failed());
  CHECK(program.first_error() == nullptr);
  const auto empty = read_text("", mill, {.start = {1, 2, 3}});
  REQUIRE(empty.blocks().size() == 1);
  CHECK(empty.blocks()[0].path.start() == Vector3(1, 2, 3));
  CHECK_FALSE(empty.failed());
}

TEST_CASE("a machine that no program suits is a problem of the program", "[program]") {
  Machine<3> bad = mill;
  bad.limits.jerk = -1;
  const auto program = read_text("G1 X5 F600\nY\n", bad);
  REQUIRE(program.problems().size() == 2);
  CHECK(to_text(program.problems()[0]) == "error: jerk limit: -1 must be greater than zero");
  Machine<3> small = mill;
  small.axes[0].high = 50;
  for (const char* text : {"", "G4 P1\n", "G1 Y1 F600\n"}) {
    const auto outside = read_text(text, small, {.start = {60}});
    REQUIRE(outside.problems().size() == 1);
    CHECK(to_text(outside.problems()[0]).find("axis X: 60 is above the limit 50") != std::string::npos);
  }
}

TEST_CASE("words, tools, offsets and lines are the program's", "[program]") {
  gcode::Dialect dialect = dialect_of(mill);
  dialect.work_offsets[1] = {100, 10, 1};
  dialect.tools = {{.number = 2, .length = 7}, {.number = 5}};
  const auto program = read_text("M3 S1000\nT2 M6\nG0 X1\nG55 X2\nM8\nG43 Z0\nT5 M6\nT2 M6\nG1 X3 F60\nM30\n",
                                 mill, {.dialect = dialect});
  CHECK(problems(program).empty());
  std::string words;
  for (const ProgramWord& word : program.words()) {
    words += word.word.letter + std::to_string(static_cast<int>(word.word.number)) + '@' +
             std::to_string(word.block) + ' ';
    CHECK(program.files()[word.file].empty());
  }
  // The blocks: 0 T2, 1 M6, 2 X1, 3 X2, 4 Z0, 5 T5, 6 M6, 7 T2, 8 M6, 9 X3, 10 M30.
  CHECK(words == "S1000@0 M3@0 T2@0 M6@1 M8@4 T5@5 M6@6 T2@7 M6@8 M30@10 ");
  CHECK(program.blocks().size() == 11);
  CHECK(std::vector(program.tools().begin(), program.tools().end()) == std::vector{2, 5});
  CHECK(program.offset_of(2) == gcode::Position{});
  CHECK(program.offset_of(3) == gcode::Position{100, 10, 1});
  CHECK(program.offset_of(4) == gcode::Position{100, 10, 8});
  CHECK(program.offset_of(10) == gcode::Position{100, 10, 8});
  CHECK(program.lines() == 10);
}

TEST_CASE("what comes from another file names it", "[program]") {
  const test::TemporaryFolder folder;
  folder.write("part.ngc", "G1 F600 X1\no<side> call [4]\nX20\n");
  folder.write("side.ngc", "o<side> sub\nM8 X#1\nX1 X2\no<side> endsub\n");
  const auto program = read_file(folder / "part.ngc", mill);
  const std::string part = (folder / "part.ngc").string(), side = (folder / "side.ngc").string();
  REQUIRE(program.problems().size() == 1);
  CHECK(to_text(program.problems()[0]) == side + ":3:4: error: X: word given twice");
  REQUIRE(program.blocks().size() == 3);
  CHECK(program.file_of(0) == part);
  CHECK(program.file_of(1) == side);
  CHECK(program.file_of(2) == part);
  REQUIRE(program.words().size() == 1);
  CHECK(program.files()[program.words()[0].file] == side);
}

TEST_CASE("a file that cannot be read is a program with that problem", "[program]") {
  const auto folder = std::filesystem::temp_directory_path();
  for (const auto& path :
       {folder / "cncplan_no_such_file.nc", folder, std::filesystem::path("/proc/self/mem")}) {
    const auto program = read_file(path, mill);
    REQUIRE(program.problems().size() == 1);
    CHECK(program.failed());
    CHECK(program.problems()[0].about.error.code == ErrorCode::unreadable);
    CHECK(to_text(program.problems()[0]).starts_with(path.string() + ": error: file"));
    CHECK(program.blocks().empty());
    CHECK_FALSE(plan_program(program, mill, {.tolerance = 0}));
  }
}

TEST_CASE("a program tells the planes of its blocks", "[program]") {
  const auto program = read_text("G1 X1 F600\nG18 X2\nM3 S5\nG19\nG4 P1\nX3\nG17 G2 X5 I1\n", mill);
  REQUIRE(problems(program).empty());
  std::vector<Plane> planes;
  for (std::size_t i = 0; i < program.blocks().size(); ++i) planes.push_back(program.plane_of(i));
  CHECK(planes == std::vector<Plane>{Plane::xy, Plane::zx, Plane::zx, Plane::yz, Plane::xy});
}

TEST_CASE("what an axis cannot do is told at its word, once for all passes of a loop", "[program]") {
  Machine<4> machine{.limits = mill.limits};
  machine.axes[3] = {.letter = 'A', .kind = AxisKind::rotary, .velocity = 1, .acceleration = 1, .jerk = 1};
  machine.axes[2].low = -5;
  const auto told = [&](const std::string& text) { return problems(read_text(text, machine)); };
  using Told = std::vector<std::string>;
  CHECK(told("G1 F600\n(Z1) G1 X1 Z-9 ; Z\n") == Told{"2:12: error: axis Z: -9 is below the limit -5"});
  CHECK(told("G1 F600\n#1=3\nG1 X[#1*2] z[#1-9] A2\n") ==
        Told{"3:12: error: axis Z: -6 is below the limit -5"});
  CHECK(told("G1 F600 G18\nG2 X20 I10 K0\n") ==  // no word of Z, but an arc that goes there
        Told{"2:8: error: axis Z: -10 is below the limit -5"});
  CHECK(told("G1 F600 G91\no1 repeat [50]\nX1 D2\nZ-2\nZ2\nZ-4 X1 A3\no1 endrepeat\n") ==
        Told{"3:4: error: D is not supported", "4:1: error: axis Z: -6 is below the limit -5",
             "6:1: error: axis Z: -8 is below the limit -5"});
  // Held back under cutter compensation, its line is gone.
  const auto held = told("G1 F600\nG41.1 D1 X5\nX20\nY20 Z-9\nX0\nG40\n");
  REQUIRE_FALSE(held.empty());
  CHECK(held[0] == "4:1: error: axis Z: -9 is below the limit -5");
}

TEST_CASE("an arc whose radii differ tells the mode in which they agree", "[program]") {
  const auto told = [](const std::string& arc) { return problems(read_text("G1 F600\n" + arc, mill)); };
  const std::string differ = "error: center: radii at start and end point differ";
  CHECK(told("G0 X10 Y0\nG2 X0 Y10 I2 J0\n")[0] ==
        "3:11: " + differ + " by 13.6205, at most 0.0282843 is allowed");
  CHECK(told("G0 X10 Y10\nG2 X20 Y20 I10 J20\n")[0].ends_with("is allowed; they agree in G90.1"));
  CHECK(told("G90.1 G0 X10 Y10\nG2 X20 Y20 I0 J10\n")[0].ends_with("is allowed; they agree in G91.1"));
  CHECK(told("G18 G0 X10 Z10\nG2 X20 Z20 I20 K10\n")[0].ends_with("is allowed; they agree in G90.1"));
}

TEST_CASE("read flat, a program has no parameters and no O-words", "[program]") {
  const std::string text = "G21 F600\n#1=5\nG1 X#1\no1 repeat [2]\nG91 Y1\no1 endrepeat\nM98 P100\nX3\n";
  const auto flat = read_text(text, mill, {.flat = true});
  CHECK(problems(flat) == std::vector<std::string>{"2:1: error: variable # is not supported",
                                                   "3:5: error: variable # is not supported",
                                                   "4:1: error: O-word is not supported",
                                                   "6:1: error: O-word is not supported",
                                                   "7:1: error: M98 finds no subprogram here"});
  const auto run = read_text(text, mill);
  CHECK(problems(run) == std::vector<std::string>{"7:1: error: M98 finds no subprogram here"});
  CHECK(run.blocks().size() == 4);
  const std::string plain = "G21 F600\nG1 X5\nG2 X10 I2.5\nG4 P1\nM2\n";
  const auto one = read_text(plain, mill), other = read_text(plain, mill, {.flat = true});
  CHECK(std::ranges::equal(one.blocks(), other.blocks()));
}

TEST_CASE("a program is planned as often as one likes, from the start it was read with", "[program]") {
  const std::string text = "G21 F600\nG64 P0.1\nM3 G1 X50\nY50\nG4 P0.5\nX0\n";
  const auto program = read_text(text, mill, {.start = {1, 2, 3}});
  CHECK(problems(program).empty());  // whether P acts is for the plan to say
  CHECK(error_of(plan_program(program, mill, {.tolerance = 0})) ==
        "error: start: 0 is not as the program was read with");
  CHECK(error_of(plan_program(program, mill, {.tolerance = 0, .start = {1, 2, 3.5}})) ==
        "error: start: 3.5 is not as the program was read with");
  for (const double tolerance : {0.0, 0.02}) {
    const PlanOptions options{.tolerance = tolerance, .level = SmoothLevel::fast, .start = {1, 2, 3}};
    const auto planned = plan_program(program, mill, options);
    const auto at_once = plan_text(text, mill, options);
    REQUIRE(planned);
    REQUIRE(at_once);
    CHECK(planned->duration() == at_once->duration());
    CHECK(planned->at(0).position == Vector3(1, 2, 3));
    REQUIRE(planned->words().size() == 1);
    CHECK(planned->words()[0].time == at_once->words()[0].time);
    REQUIRE(planned->warnings().size() == (tolerance > 0 ? 0U : 1U));
    if (tolerance == 0) CHECK(planned->warnings()[0] == "2:5: warning: tolerance of G64 is ignored");
  }
  // Other limits are as good; what they do not allow is an error with its place.
  Machine<3> small = mill;
  small.axes[1].high = 20;
  CHECK(error_of(plan_program(program, small, {.tolerance = 0, .start = {1, 2, 3}})) ==
        "4:1: error: axis Y: 50 is above the limit 20");
}

// Rest to rest at each corner: L/v + v/a + a/j for each move that reaches its feed and full acceleration.
TEST_CASE("a program is planned with a policy and a law of one's own", "[program]") {
  const Machine<3> machine{.limits = {.velocity = 30, .acceleration = 100, .jerk = 1000}};
  const auto program = read_text("G1 X50 F1200\nX100\nY50\n", machine);
  const double move = 50.0 / 20 + 20.0 / 100 + 0.1;
  const auto seven = plan_program(program, machine, junction::ExactStop{});
  REQUIRE(seven);
  CHECK(seven->duration() == Approx(3 * move));
  const auto five = plan_program(program, machine, junction::ExactStop{}, profile::FivePhase{});
  REQUIRE(five);
  CHECK(five->duration() > 3 * move * 1.0001);  // no phase of constant acceleration
  const auto given_away = plan_program(read_text("G1 X50 F1200\n", machine), machine, {.tolerance = 0});
  REQUIRE(given_away);
  CHECK(given_away->duration() == Approx(move));
}
