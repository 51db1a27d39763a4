#include "cncplan/plan_program.hpp"

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <string_view>

#include "support/catch.hpp"
#include "support/curves.hpp"
#include "support/program_run.hpp"
#include "support/shared.hpp"

using namespace cncplan;

namespace {

constexpr double degree = std::numbers::pi / 180;

const Machine<3> mill{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};

template <class M>
std::string error_of(std::string_view text, const M& machine, const PlanOptions& options = {.tolerance = 0}) {
  const auto planned = plan_text(text, machine, options);
  return planned ? "no error" : to_text(planned.error());
}

// The highest speed along a block, mm/s or rad/s.
template <class M>
double peak(std::string_view text, const M& machine, std::size_t block = 0) {
  const auto planned = plan_text(text, machine, {.tolerance = 0});
  INFO((planned ? std::string() : to_text(planned.error())));
  REQUIRE(planned);
  return planned->blocks()[block].peak;
}

// An axis with limits as they suit it.
Axis axis(char letter, AxisKind kind = AxisKind::linear) {
  const double unit = kind == AxisKind::rotary ? 10 * degree : 1.0;
  Axis result{.letter = letter, .kind = kind};
  result.velocity = 1000 * unit;
  result.acceleration = 2000 * unit;
  result.jerk = 1e5 * unit;
  return result;
}

const Machine<5> trunnion{
    .axes = {{axis('X'), axis('Y'), axis('Z'), axis('A', AxisKind::rotary), axis('C', AxisKind::rotary)}},
    .limits = {.velocity = 80, .acceleration = 1000, .jerk = 20000}};

}  // namespace

TEST_CASE("errors of a text have their line and column", "[program]") {
  CHECK(error_of("G21\nG1 X10 F600\nG1 X10 Y\n", mill) == "3:8: error: Y has no number");
  CHECK(error_of("G1 X10 F600\nG1 E10\n", mill).substr(0, 12) == "2:4: error: ");
  CHECK(error_of("G1 X10 F600\nG2 X20 R1\n", mill).substr(0, 12) == "2:8: error: ");
  const std::string control = error_of("G1 X10 F600\n\nG1 X1 @\n", mill);
  CHECK(control.substr(0, 12) == "3:7: error: ");
}

TEST_CASE("travel is left inside an arc, with its ends within", "[program]") {
  Machine<3> small = mill;
  small.axes[1].high = 8;
  // Half a circle of radius 10 from (0, 0) to (20, 0): its top is at Y10.
  CHECK(error_of("G21\nG1 X0 F600\nG2 X20 R10\n", small).substr(0, 18) == "3:8: error: axis Y");
  CHECK(error_of("G21\nG2 X20 R10 F600\n", small).find("10 is above the limit 8") != std::string::npos);
  CHECK(error_of("G3 X20 R10 F600\n", small) == "no error");
  small.axes[1].low = -9.9;
  CHECK(error_of("G3 X20 R10 F600\n", small).find("below the limit -9.9") != std::string::npos);
}

TEST_CASE("a start outside travel is an error, and one inside is where motion starts", "[program]") {
  Machine<3> small = mill;
  small.axes[0].low = -5;
  small.axes[0].high = 50;
  CHECK(error_of("G1 X20 F600\n", small, {.start = {60, 0, 0}}).find("axis X: 60 is above the limit 50") !=
        std::string::npos);
  CHECK(error_of("G1 Z20 F600\n", small, {.start = {-6, 0, 0}}).find("axis X: -6 is below the limit -5") !=
        std::string::npos);
  // Also where nothing moves.
  CHECK(error_of("G4 P1\n", small, {.start = {60, 0, 0}}) != "no error");
  CHECK(error_of("", small, {.start = {60, 0, 0}}) != "no error");
  const auto planned = plan_text("G1 X20 F600\n", small, {.tolerance = 0, .start = {10, 4, -3}});
  REQUIRE(planned);
  CHECK(planned->at(0).position == Vector3(10, 4, -3));
  CHECK(planned->at(planned->duration()).position == Vector3(20, 4, -3));
  CHECK(planned->length() == 10);
  const auto nothing = plan_text("M30\n", small, {.tolerance = 0, .start = {10, 4, -3}});
  REQUIRE(nothing);
  CHECK(nothing->at(0).position == Vector3(10, 4, -3));
  CHECK(nothing->duration() == 0);
}

TEST_CASE("a start in degrees of program coordinates is rad here", "[program]") {
  const auto planned =
      plan_text("G1 C20 F600\n", trunnion, {.tolerance = 0, .start = {1, 2, 3, 0.1, 10 * degree}});
  REQUIRE(planned);
  CHECK(planned->at(0).position[4] == Approx(10 * degree));
  CHECK(planned->at(1e9).position[4] == Approx(20 * degree));
}

TEST_CASE("motion that no limit bounds is an error", "[program]") {
  const Machine<3> none{};
  CHECK(error_of("G0 X10\n", none).find("1:4: error: velocity limit") == 0);
  const Machine<3> no_change{.limits = {.velocity = 10}};
  CHECK(error_of("G1 X10 F600\n", no_change).find("acceleration") != std::string::npos);
  const Machine<3> jerk_only{.limits = {.velocity = 10, .jerk = 100}};
  CHECK(error_of("G1 X10 F600\n", jerk_only) == "no error");
  const Machine<3> acceleration_only{.limits = {.velocity = 10, .acceleration = 100}};
  CHECK(error_of("G1 X10 F600\nG1 Y5\n", acceleration_only) == "no error");
  // The limits of the axis that moves are enough.
  Machine<3> axis_only{};
  axis_only.axes[0] = axis('X');
  CHECK(error_of("G0 X10\n", axis_only) == "no error");
  CHECK(error_of("G0 X10 Y1\n", axis_only) == "no error");
  CHECK(error_of("G0 Y1\n", axis_only) != "no error");
}

TEST_CASE("an axis that moves alone without limits is named", "[program]") {
  Machine<5> tilted{.limits = {.velocity = 10, .acceleration = 100, .jerk = 1000}};
  CHECK(error_of("G1 X1 A9 F60\nG1 B5\n", tilted) ==
        "2:4: error: axis B: moves alone, without limits of its own");
  tilted.axes[4].velocity = 1;
  CHECK(error_of("G0 X1\nG0 X2\nB5\n", tilted) ==
        "3:1: error: axis B: moves alone, without limits of its own");
  tilted.axes[4].acceleration = 1;
  CHECK(error_of("G0 B5\n", tilted) == "no error");
  CHECK(error_of("G0 A5 B5\n", tilted) == "no error");
  CHECK(error_of("G0 A5 B5\n\nA2\n", tilted) == "3:1: error: axis A: moves alone, without limits of its own");
}

TEST_CASE("a file that is missing or a folder is an error with its name", "[program]") {
  const auto folder = std::filesystem::temp_directory_path();
  const auto missing = plan_file(folder / "cncplan_no_such_file.nc", mill, {.tolerance = 0});
  REQUIRE(!missing);
  CHECK(to_text(missing.error()).find("cncplan_no_such_file.nc: error: file") != std::string::npos);
  CHECK(!plan_file(folder, mill, {.tolerance = 0}));
  CHECK(!plan_file("/proc/self/mem", mill, {.tolerance = 0}));  // it can be opened, and reading it fails
  const auto path = folder / "cncplan_plan_program_test.nc";
  std::ofstream(path) << "G1 X10 F600\nG1 Q\n";
  const auto faulty = plan_file(path, mill, {.tolerance = 0});
  REQUIRE(!faulty);
  CHECK(to_text(faulty.error()).find("cncplan_plan_program_test.nc:2:4: error: ") != std::string::npos);
  std::filesystem::remove(path);
}

TEST_CASE("feeds: by the minute, by inverse time, of rotary axes, up to the limits", "[program]") {
  CHECK(peak("G1 X100 F600\n", mill) == Approx(10));
  CHECK(peak("G20\nG1 X4 F30\n", mill) == Approx(12.7));
  CHECK(peak("G1 X100 F6000\n", mill) == Approx(30));   // the machine's
  CHECK(peak("G1 X100\n", mill) == Approx(30));         // no F yet
  CHECK(peak("G93 G1 X100 F6\n", mill) == Approx(10));  // 6 a minute: in 10 s
  CHECK(peak("G93 G1 X30 Y40 A90 F6\n", trunnion) == Approx(5));
  CHECK(peak("G1 X30 Y40 A90 F600\n", trunnion) == Approx(10));   // X Y Z count
  CHECK(peak("G1 A90 F600\n", trunnion) == Approx(10 * degree));  // degrees a minute
  CHECK(peak("G1 A30 C40 F600\n", trunnion) == Approx(10 * degree));
  CHECK(peak("G93 G1 A90 F6\n", trunnion) == Approx(9 * degree));
}

TEST_CASE("rapids and feed moves have their own highest speeds", "[program]") {
  Machine<3> machine = mill;
  CHECK(peak("G0 X100\n", machine) == Approx(30));
  machine.rapid_rate = 55;
  CHECK(peak("G0 X100\n", machine) == Approx(55));
  CHECK(peak("G1 X100 F6000\n", machine) == Approx(30));
  machine.feed_limit = 12;
  CHECK(peak("G1 X100 F6000\n", machine) == Approx(12));
  CHECK(peak("G0 X100\n", machine) == Approx(55));
  machine.axes[0].velocity = 7;  // axis limits hold always
  CHECK(peak("G0 X100\n", machine) == Approx(7));
  CHECK(peak("G0 Y100\n", machine) == Approx(55));
  machine.axes[1].velocity_down = 3;
  CHECK(peak("G0 Y-100\n", machine) == Approx(3));
  Machine<5> turns = trunnion;
  turns.axes[3].velocity = 2;
  CHECK(peak("G0 A180\n", turns) == Approx(2));  // no limit of the tool on it
}

TEST_CASE("machines of one and two axes", "[program]") {
  const Machine<2> plotter{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  const auto good = plan_text("G1 X10 Y5 F600\nG2 X20 Y-5 J-10\nG1 X0\nM30\n", plotter, {.tolerance = 0});
  REQUIRE(good);
  CHECK(good->at(1e9).position == VectorN<double, 2>(0, -5));
  CHECK(good->length() == Approx(std::hypot(10, 5) + 5 * std::numbers::pi + 20));
  CHECK(error_of("G1 Z1 F600\n", plotter).substr(0, 11) == "1:4: error:");
  CHECK(error_of("G18 G2 X0 I5 F600\n", plotter).find("lacks") != std::string::npos);
  const Machine<1> slide{.limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  CHECK(error_of("G1 X5 F600\nG4 P0.1\nG0 X1\n", slide) == "no error");
  CHECK(error_of("G2 X0 I5 F600\n", slide).find("lacks") != std::string::npos);
}

TEST_CASE("axes in another order move straight, and arcs are refused there", "[program]") {
  const Machine<3> lathe{.axes = {{axis('X'), axis('Z'), axis('Y')}},
                         .limits = {.velocity = 30, .acceleration = 1000, .jerk = 10000}};
  const auto planned = plan_text("G1 X1 Y2 Z3 F600\n", lathe, {.tolerance = 0});
  REQUIRE(planned);
  CHECK(planned->at(1e9).position == Vector3(1, 3, 2));
  CHECK(planned->at(1e9).tool == Vector3(1, 2, 3));
  CHECK(planned->length() == Approx(std::sqrt(14)));
  const std::string arc = error_of("G2 X20 R10 F600\n", lathe);
  CHECK(arc.substr(0, 2) == "1:");
  CHECK(arc.find("not supported") != std::string::npos);
}

TEST_CASE("an axis with a letter that means something else is refused", "[program]") {
  Machine<3> odd = mill;
  odd.axes[2].letter = 'J';  // the centre of an arc
  CHECK(error_of("G1 X5 F600\n", odd) != "no error");
}

// Closed form: L/v + v/a + a/j for each move that reaches its feed and a full ramp.
TEST_CASE("words have the time at which the motion reaches them", "[program]") {
  const Machine<3> machine{.limits = {.velocity = 30, .acceleration = 100, .jerk = 1000}};
  const auto planned =
      plan_text("M3 S1000\nG1 X50 F1200\nG4 P0.5\nM8\nG4 P0.25\nM9\nM6 T1\nG61 G1 X100\nM5\nM30\n", machine,
                {.tolerance = 0});
  REQUIRE(planned);
  const double move = 50.0 / 20 + 20.0 / 100 + 0.1;
  CHECK(planned->duration() == Approx(2 * move + 0.75));
  std::string letters;
  std::vector<double> times;
  for (const auto& [word, time] : planned->words()) {
    letters += word.letter;
    times.push_back(time);
  }
  const auto time_of = [&](char letter, double number) {
    for (const auto& [word, time] : planned->words())
      if (word.letter == letter && word.number == number) return time;
    return -1.0;
  };
  CHECK(time_of('M', 3) == 0);
  CHECK(time_of('S', 1000) == 0);
  CHECK(time_of('M', 8) == Approx(move + 0.5));
  CHECK(time_of('M', 9) == Approx(move + 0.75));
  CHECK(time_of('T', 1) == Approx(move + 0.75));
  CHECK(time_of('M', 5) == Approx(2 * move + 0.75));
  CHECK(time_of('M', 6) == Approx(move + 0.75));  // stops are words, too
  CHECK(time_of('M', 30) == Approx(2 * move + 0.75));
  for (std::size_t i = 1; i < times.size(); ++i) CHECK(times[i] >= times[i - 1]);
}

TEST_CASE("M3 M5 and S do not stop, T M0 and M1 do", "[program]") {
  const auto entry = [](std::string_view word) {
    const auto planned =
        plan_text("G1 X50 F600\n" + std::string(word) + "\nG1 X100\n", mill, {.tolerance = 0});
    REQUIRE(planned);
    return planned->blocks().back().entry;
  };
  for (const char* word : {"M3", "M4", "M5", "M7", "M8", "M9", "S500"}) CHECK(entry(word) == Approx(10));
  for (const char* word : {"T2", "M0", "M1", "M6", "G4 P0.1", "G4 P0"})
    CHECK(entry(word) == Approx(0).margin(1e-6));
}

TEST_CASE("what has no effect is told as a warning with its place", "[program]") {
  const auto planned = plan_text("G21\nG64 P0.01\nG1 X10 F600\n", mill, {.tolerance = 0});
  REQUIRE(planned);
  REQUIRE(planned->warnings().size() == 1);
  CHECK(planned->warnings()[0].substr(0, 2) == "2:");
  CHECK(planned->warnings()[0].find("warning") != std::string::npos);
}

TEST_CASE("work offsets shift the axes, arcs and the place of a dwell", "[program]") {
  gcode::Dialect dialect;
  dialect.work_offsets[1] = {100, 10, 1};
  const auto planned = plan_text("G55 G1 X0 Y0 Z0 F1200\nG4 P1\nG3 X20 Y0 R10\nG4 P1\n", mill,
                                 {.tolerance = 0, .dialect = dialect});
  REQUIRE(planned);
  const auto motions = planned->blocks();
  CHECK(planned->at(motions[0].duration + 0.5).position == Vector3(100, 10, 1));
  CHECK(planned->at(1e9).position == Vector3(120, 10, 1));
  CHECK(motions[1].length == Approx(10 * std::numbers::pi));
  for (const auto& p : planned->samples(0.01)) REQUIRE(p.tool == p.position);
}

TEST_CASE("places that a mapped machine cannot reach are errors", "[program]") {
  const MappedMachine<test::Scara> arm{
      .map = {},
      .axes = {{axis('J', AxisKind::rotary), axis('K', AxisKind::rotary), axis('Z')}},
      .limits = {.velocity = 150, .acceleration = 2000, .jerk = 40000}};
  CHECK(error_of("G1 X260 F600\n", arm, {.start = {250, -180, 0}}) == "no error");
  const std::string start = error_of("G1 X260 Y0 F600\n", arm);  // the origin is within the arm's hole
  CHECK(start.find("cannot be reached") != std::string::npos);
  const std::string end = error_of("G1 X260 F600\nG1 X400\n", arm, {.start = {250, -180, 0}});
  CHECK(end.substr(0, 2) == "2:");
  CHECK(error_of("G0 X400\n", arm, {.start = {250, -180, 0}}) ==
        "1:4: error: axis J: cannot be reached by the machine");
  // Through the hole, both ends reachable.
  CHECK(error_of("G1 X-250 Y10 F600\n", arm, {.start = {250, 10, 0}}) != "no error");
}

TEST_CASE("under a map a tolerance acts on feed moves, and rapids are told to be exact", "[program]") {
  const MappedMachine<test::Scara> arm{
      .map = {},
      .axes = {{axis('J', AxisKind::rotary), axis('K', AxisKind::rotary), axis('Z')}},
      .limits = {.velocity = 150, .acceleration = 2000, .jerk = 40000}};
  const char* text = "G1 X260 F600\nY-170\nX255\nG0 Y-180\n";
  const auto within =
      plan_text(text, arm, {.tolerance = 0.01, .level = SmoothLevel::fast, .start = {250, -180, 0}});
  REQUIRE(within);
  REQUIRE(within->fallbacks().size() == 1);
  const Fallback told = within->fallbacks()[0];
  CHECK(told == Fallback{3, 3, SmoothLevel::exact, FallbackReason::map});
  CHECK(within->warnings().empty());
  const auto exact = plan_text(text, arm, {.tolerance = 0, .start = {250, -180, 0}});
  REQUIRE(exact);
  CHECK(exact->fallbacks().empty());
  CHECK(exact->warnings().empty());
  CHECK(within->duration() < 1.02 * exact->duration());  // which jumps
}

// From outside: what this project's simulator gave before trajectories were, with limits 30, 1000, 10000.
TEST_CASE("the real programs take the time that they took before", "[program][slow]") {
  const auto shared = test::shared();
  if (!shared) {
    WARN("SKIPPED: CNCPLAN_SHARED is not set");
    return;
  }
  struct Program {
    const char* name;
    double seconds;
  };
  const std::array programs{Program{"ball.nc", 1018.4449},
                            Program{"ngc/3dtest.ngc", 61.4298},
                            Program{"ngc/51MeanderAve.ngc", 242.5853},
                            Program{"ngc/Cereal.ngc", 271.0205},
                            Program{"ngc/arcspiral.ngc", 256.8255},
                            Program{"ngc/cds.ngc", 718.4710},
                            Program{"ngc/lathe_pawn.ngc", 335.8171},
                            Program{"ngc/test_12mmflat.ngc", 61.7594},
                            Program{"ngc/tort.ngc", 566.1161}};
  for (const auto& [name, seconds] : programs) {
    const auto planned =
        plan_file(*shared + "/data/" + name, mill, {.tolerance = 0, .junction_deviation = 0.01});
    INFO(name << ": " << (planned ? std::string() : to_text(planned.error())));
    REQUIRE(planned);
    CHECK(planned->duration() < seconds + 1e-3);
    CHECK(planned->duration() > 0.995 * seconds);  // arcs may have become a little faster
    if (name == std::string_view("ball.nc")) CHECK(planned->duration() == Approx(1018.445).margin(1e-3));
  }
}

TEST_CASE("a feed of rotary axes alone counts degrees a minute, in inches too") {
  Machine<4> machine{.limits = {.velocity = 100, .acceleration = 1000, .jerk = 100000}};
  machine.axes[3].velocity = 100;
  machine.axes[3].acceleration = 1000;
  machine.axes[3].jerk = 1e6;
  for (const char* program : {"G21 G1 A90 F600\n", "G20 G1 A90 F600\n", "G20 F600\nG21 G1 A90\n"}) {
    const auto trajectory = plan_text(program, machine, {.tolerance = 0});
    REQUIRE(trajectory);
    INFO(program);
    CHECK(trajectory->blocks().front().peak == Approx(10.0 * gcode::radians_per_degree).epsilon(1e-12));
  }
}

TEST_CASE("a program with parameters plans as the flat one", "[program]") {
  const auto with = plan_text(
      "#<r>=5\nG1 F600 X[#<r>*2]\no1 repeat [2]\nG3 X[#5420-2*#<r>] I-#<r>\nG1 X[#5420+2*#<r>]\no1 "
      "endrepeat\n",
      mill, {.tolerance = 0});
  const auto flat =
      plan_text("\nG1 F600 X10\n\nG3 X0 I-5\nG1 X10\nG3 X0 I-5\nG1 X10\n", mill, {.tolerance = 0});
  REQUIRE(with);
  REQUIRE(flat);
  REQUIRE(with->blocks().size() == flat->blocks().size());
  CHECK(with->duration() == flat->duration());
  CHECK(error_of("G1 F600\no1 if [1]\nX[1/0]\no1 endif\n", mill) == "3:4: error: / divides by zero");
}

TEST_CASE("a file calls the files of its folder, and errors name the file", "[program]") {
  const test::TemporaryFolder folder;
  folder.write("part.ngc", "G1 F600 X1\no<side> call [4]\nX20\no<far> call\n");
  folder.write("side.ngc", "o<side> sub\nX#1\no<side> endsub\n");
  folder.write("far.ngc", "o<far> sub\n\nX1000\no<far> endsub\n");
  const auto planned = plan_file(folder / "part.ngc", mill, {.tolerance = 0});
  REQUIRE(planned);
  REQUIRE(planned->blocks().size() == 4);
  Machine<3> small = mill;
  small.axes[0].high = 100;
  const auto refused = plan_file(folder / "part.ngc", small, {.tolerance = 0});
  REQUIRE_FALSE(refused);
  CHECK(refused.error().file == (folder / "far.ngc").string());
  CHECK(refused.error().about.line == 3);
  folder.write("far.ngc", "o<far> sub\nX1 X2\no<far> endsub\n");
  const auto wrong = plan_file(folder / "part.ngc", mill, {.tolerance = 0});
  REQUIRE_FALSE(wrong);
  CHECK(to_text(wrong.error()) == (folder / "far.ngc").string() + ":2:4: error: X: word given twice");
}
