// Debian's linuxcnc-uspace has LinuxCNC's interpreter as a program, rs274: where it is installed it says what
// our motions should be.
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "cncplan/gcode/diagnostic_text.hpp"
#include "cncplan/gcode/language/program_lines.hpp"
#include "cncplan/gcode/read_program.hpp"
#include "support/catch.hpp"
#include "support/program_run.hpp"

using namespace cncplan;

namespace {

/// Motions (machine coordinates to a thousandth) and dwells, a line each.
class Steps {
 public:
  void place(const char* kind, Vector3 machine) {
    for (double& coordinate : machine) coordinate = std::round(coordinate * 1e4) / 1e4;  // rs274's digits
    std::array<char, 128> text;
    std::snprintf(text.data(), text.size(), "%s %.3f %.3f %.3f\n", kind, machine[0] + 0.0, machine[1] + 0.0,
                  machine[2] + 0.0);
    if ((machine - here_).norm() > 1e-3) steps_ += text.data();
    here_ = machine;
  }
  /// Pieces of a spline, whose places rs274 does not print; the next motion goes to a place of its own.
  void spline() {
    if (!steps_.ends_with("spline\n")) steps_ += "spline\n";
    here_.setConstant(1e9);
  }
  void dwell(double seconds) { steps_ += "dwell " + std::to_string(seconds) + '\n'; }
  [[nodiscard]] const std::string& text() const { return steps_; }

 private:
  std::string steps_;
  Vector3 here_ = Vector3::Zero();
};

std::string ours(const std::string& program) {
  Steps steps;
  gcode::Reader reader;
  gcode::TextLines text(program);
  gcode::ProgramLines lines(text, reader);
  const auto done = gcode::read_program(lines, reader, [&steps](const gcode::Item& item) {
    if (const auto* dwell = std::get_if<gcode::Dwell>(&item)) steps.dwell(dwell->seconds);
    const auto* motion = std::get_if<gcode::Motion>(&item);
    if (motion == nullptr) return;
    const auto at = [motion](std::size_t i) { return motion->end[i] + motion->offset[i]; };
    const char* const names[] = {"rapid", "feed", "arc", "arc", "spline"};
    if (motion->kind == gcode::MotionKind::spline) return steps.spline();
    steps.place(names[static_cast<int>(motion->kind)], {at(0), at(1), at(2)});
  });
  return steps.text() + (done ? std::string() : gcode::to_text("", done.error()));
}

std::string theirs(const std::string& printed) {
  Steps steps;
  std::istringstream lines(printed);
  double unit = 1.0, rotation = 0.0;
  Vector3 system = Vector3::Zero(), shift = Vector3::Zero(), tool = Vector3::Zero(), here = Vector3::Zero();
  const auto machine = [&](const Vector3& work) {
    const double x = work[0] + shift[0], y = work[1] + shift[1];
    const double c = std::cos(rotation), s = std::sin(rotation);
    return Vector3(c * x - s * y + system[0] + tool[0], s * x + c * y + system[1] + tool[1],
                   work[2] + shift[2] + system[2] + tool[2]);
  };
  for (std::string line; std::getline(lines, line);) {
    const auto is = [&](const char* name) { return line.find(name) != std::string::npos; };
    const std::size_t open = line.find('(');
    if (open == std::string::npos) continue;
    std::array<double, 6> v{};
    std::sscanf(line.c_str() + open, "(%lf, %lf, %lf, %lf, %lf, %lf", &v[0], &v[1], &v[2], &v[3], &v[4],
                &v[5]);
    if (is("USE_LENGTH_UNITS")) unit = is("INCHES") ? 25.4 : 1.0;
    if (is("SET_G5X_OFFSET")) system = Vector3(v[1], v[2], v[3]) * unit;
    if (is("SET_G92_OFFSET")) shift = Vector3(v[0], v[1], v[2]) * unit;
    if (is("SET_XY_ROTATION")) rotation = v[0] * 3.14159265358979323846 / 180.0;
    if (is("USE_TOOL_LENGTH_OFFSET")) {
      std::sscanf(line.c_str() + open, "(%lf %lf %lf", &v[0], &v[1], &v[2]);
      tool = Vector3(v[0], v[1], v[2]) * unit;
    }
    if (is("DWELL") && v[0] > 0.0) steps.dwell(v[0]);
    if (is("NURBS_FEED")) steps.spline();
    if (is("PROGRAM_END")) break;
    const Vector3 place = Vector3(v[0], v[1], is("ARC_FEED") ? v[5] : v[2]) * unit;  // of an arc in G17
    if (is("RIGID_TAP")) {
      steps.place("feed", machine(place));
      steps.place("feed", machine(here));
    } else if (is("ARC_FEED") || is("STRAIGHT_")) {
      here = place;
      steps.place(is("ARC_FEED") ? "arc" : is("TRAVERSE") ? "rapid" : "feed", machine(place));
    }
  }
  return steps.text();
}

/// Compares a program behind a common head, where rs274 is there.
void compare(const char* program) {
  INFO(program);
  const std::string text = std::string("G21 G17 G90 G94 M3 S1000 F100\nG0 X0 Y0 Z10\n") + program + "M2\n";
  const test::TemporaryFolder folder;
  folder.write("part.ngc", text);
  folder.write("tools.tbl", "T1 P1 Z0\n");
  folder.write("none.var", "");
  // One at a time: of two that run at once, one ends by a bus error now and then.
  const std::string alone = (std::filesystem::temp_directory_path() / "cncplan-rs274.lock").string();
  const auto run =
      folder.run_program("flock", alone + " rs274 -g -n 0 -t tools.tbl -v none.var part.ngc out.txt");
  REQUIRE(run.exit == 0);
  CHECK(ours(text) == theirs(folder.read("out.txt")));
}

bool interpreter_is_there() {
  if (std::system("command -v rs274 >/dev/null 2>&1") == 0) return true;
  WARN("SKIPPED: rs274 (linuxcnc-uspace) is not installed");
  return false;
}

}  // namespace

TEST_CASE("cycles, offsets and diameters as LinuxCNC's interpreter has them") {
  if (!interpreter_is_there()) return;
  for (const char* program : {
           "G98 G81 X1 Y2 Z-3 R2\nX5\nG99 X7 Y3\nG98 X9\nG80 G0 Z0\nG81 X1 Z-2 R1\n",
           "G82 Z-4 P.5 X10 R3\nY5\nG91 G83 X1 Y1 Z-5 R-2 Q2 L3\nX1\n",
           "G99 G85 X0 Y0 Z-2 R1\nG86 X1 Z-2 R1 P.2\nG98 G89 X2 Z-2 R1 P.2\n",
           "G18 G99 G73 X1 Z2 Y-7 R1 Q3\nG19 G81 Y1 Z3 X-7 R1\n",
           "G20 G83 X.1 Z-.5 R.1 Q.2\nX.2\nG91 X.1 L2\n",
           "G10 L2 P2 X5 Y6 Z7\nG55 G0 X1 Y1 Z1\nG10 L20 P0 X100 Y100\nG0 X101\nG54 X3 Y3 Z3\n"
           "G10 L20 P1 X0 Y0\nG0 X1\nG10 L2 P1 X1 Y1 Z1\nG1 X9\nG92 X0\nG1 X1\nG92.1\nG1 X1\n",
           "G7 X8 Z1\nG8 X8\nG7 G91 X2\n",
       })
    compare(program);
}

TEST_CASE("parameters, expressions and O-words as LinuxCNC's interpreter has them") {
  if (!interpreter_is_there()) return;
  for (const char* program : {
           "#1=[1+2*3**2] #2=[2**3**2]\nX#1 Y#2 Z[-2**2]\nX[-7 MOD 3] Y[7 mod -3] Z[1 OR 0 AND 0]\n",
           "X[sin[30]] Y[cos[60]] Z[tan[45]]\nX[asin[.5]] Y[acos[-.5]] Z[atan[1]/[-2]]\n",
           "X[round[-2.5]] Y[fix[-2.8]] Z[fup[-2.8]]\nX[exp[1]] Y[ln[3]] Z[sqrt[abs[-9]]]\n",
           "#1=15\n#1=6 X#1\nX#1 Y-#1 Z+#1\n#<a b>=3 #<_g>=4\nX#<ab> Y[-#<_g>] Z##1\n#6=2\nZ##1\n",
           "o1 sub\n#1=[#1+1] #31=#2\no2 if [#1 gt 3]\no1 return [#1]\no2 elseif [#1 eq 3]\nX#1\no2 "
           "else\nY#1\n"
           "o2 endif\no1 call [#1]\no1 endsub\n#1=7\no1 call [0] [5]\nX#<_value> Y#31 Z#1\n",
           "#1=0\no1 while [#1 lt 5]\n#1=[#1+1]\no2 if [#1 eq 2]\no1 continue\no2 endif\no3 if [#1 eq 4]\no1 "
           "break\n"
           "o3 endif\nX#1\no1 endwhile\n",
           "#1=3\no4 do\n#1=[#1-1]\nY#1\no4 while [#1 gt 0]\no5 repeat [3]\nG91 Z1\no5 "
           "endrepeat\n",
           "G20 X1\nG92 X3\nX[#5420+1] Y-2\nX[#<_x>*2] Z#<_metric>\nG21 X#5420\nG10 L2 P2 X4\nG55 "
           "Y#5220\n"
           "G91.1 G1 F33 X#<_feed> Y[#<_motion_mode>/10]\nZ[#<_plane>/10]\n",
           "#2=3\nG[#2-2] X1\nG0 X[1 EQ 1.0000001] Y[2 NE 2] Z[3 GE 3]\nX[1 XOR 1] Y[1 LT 2] Z[1 LE 0]\n",
           "M98 P100 L2\nX50\nM30\no100\n#1=[#1+1]\nX#1\nM99\n",
           "X#<_line>\n\no1 repeat [2]\nZ#<_line>\nG91 X1\nG90 Y#<_line>\no1 endrepeat\n",
       })
    compare(program);
}

TEST_CASE("threads and taps as LinuxCNC's interpreter has them") {
  if (!interpreter_is_there()) return;
  for (const char* program : {
           "G33 Z-3 K.5\nG33 X1 Z-5 K.5\nG0 Z10\nG33.1 Z5 K1.25\nG0 X3\n",
           "G98 G84 X1 Z-3 R2\nX2\nG99 X3\nX4 P.5\nG0 Z9\n",
           "M4\nG98 G74 X1 Y1 Z-3 R2\nX2\nG0 Z9\n",
           "G0 X20\nG18 G76 P1.5 Z-5 I-.5 J.1 K.9 R1.0 Q29.5 H1 E.5 L2\n",
           "G0 X20\nG18 G76 P1.5 Z-5 I-.5 J.1 K.9 R1.5 Q29.5 H1 E.5 L2\n",
           "G0 X20\nG18 G76 P1.5 Z-5 I.5 J.1 K.9 R2 Q29.5 E.5 L3\nG0 X9\n",
           "G0 X20 Z-8\nG18 G76 P1 Z5 I-.5 J.2 K.5 E.5 L1\n",
           "G7 G0 X30\nG18 G76 P1 Z3 I-1.5 J.2 K1 Q29 L2 E1\nG8 G0 X1\n",
       })
    compare(program);
}

TEST_CASE("rotated systems, shifts and polar coordinates as LinuxCNC's interpreter has them") {
  if (!interpreter_is_there()) return;
  for (const char* program : {
           "G10 L2 P1 R30\nG1 X10\nG2 X20 Y0 I5 J0\nG1 G91 X1 Y1\nG90\nG10 L2 P1 R0\nG1 X0\n",
           "G10 L2 P2 X3 Y4 R45\nG1 X10\nG55 X1 Y1 Z1\nG10 L20 P2 X0\nX1 Y2\nG53 G1 X5\nG54 Y0\n",
           "G10 L2 P1 X1 R-20\nG92 X5 Y6\nG1 X0 Y0\nG92.2\nX1\nG92.3\nX2\nG28 X1\n",
           "G0 X5 Y0\nG2 @5 ^-90 R5\nG3 ^0 R-6\nG91 G2 @1 R4\n",
           "G1 @5 ^30\n@7\n^60\nG91 @1\n^5\n@1 ^-10 Z1\nG90 X5\n",
           "G1 X5\nG91 G99 G81 R.1 Z-.5 ^60 L3\nG90 G0 X0\n",
           "G10 L10 P1 Z3\nG43 H1\nG0 X1 Z1\nG10 L11 P1 Z2\nG43 H1\nG0 X2 Z2\nG49 X3 Z3\n",
           "G10 L1 P1 X.5 Y-2 Z3\nG43 H1\nG0 X1 Y1 Z1\nG2 X3 I1 F9\nG43.2 H1\nG0 X1\nG49 X3 Y3\n",
           "G10 L1 P1 X5 Y-2\nT1 M6 G43\nG0 X4 Y1\nG10 L2 P1 R30\nG0 X1 Y5\nX2\nG49 X3\n",
           "G0 X7 Y8\nG10 L10 P1 X3 Y1\nG43 H1\nG0 X1 Y1\nG10 L11 P1 X2\nG43 H1\nG0 X2 Y2\n",
           "G7 G10 L1 P1 X3\nG43 H1\nG0 X1\nM70\nG49\nM72\nG0 X2\n",
           "G1 X3 Y4\nG28.1\nG1 X9\nG28 Z1\nG30.1\nG1 X0 Y0\nG30\n",
       })
    compare(program);
}

TEST_CASE("splines stand where LinuxCNC's interpreter has them") {
  if (!interpreter_is_there()) return;
  for (const char* program : {
           "G5 I1 J2 P-1 Q2 X10 Y10\nG5 P1 Q2 X20 Y5\nG1 X1\n",
           "G5.1 I1 J1 X20 Y20\nG1 X1\nG5.1 I3 J1 X0 Y9\nG0 Z1\n",
           "G5.2 P1 L3\nX1 Y1 P1\nX2 Y2 P1\nX3 Y3 P2\nX5 Y9 P1\nG5.3\nG1 X1\n",
           "G5.2 P1 L6\nX0 Y0 P1\nX2 Y2 P1\nX3 Y3 P2\nX5 Y9 P1\nX9 Y9 P1\nG5.3\nG1 X1\n",
       })
    compare(program);
}

TEST_CASE("modal state is saved and restored as LinuxCNC's interpreter does") {
  if (!interpreter_is_there()) return;
  for (const char* program : {
           "o1 sub\nM73\nG91 G20 F5\nG1 X1\no1 endsub\nG1 X25.4\no1 call\nX2\n",
           "o1 sub\nM70\nG91 G18 G55\nG1 X1\nM72\nX1\nG91\no1 endsub\no1 call\nX2\n",
           "o1 sub\nM73\nG91\no2 if [#1 eq 1]\nM71\no2 endif\nX1\no1 endsub\no1 call [0]\nX2\n"
           "o1 call [1]\nX2\n",
       })
    compare(program);
}

TEST_CASE("cutter compensation as LinuxCNC's interpreter has it") {
  if (!interpreter_is_there()) return;
  for (const char* program : {
           "G41.1 D4 G1 X0 Y10\nY20\nX10\nX10 Y10\nG40 X0 Y0\n",
           "G42.1 D4 G1 X0 Y10\nY20\nX10 Z-1\nZ-2\nX10 Y10\nX20 Y30\nG40\nX0 Y0\n",
           "G41.1 D4 G1 X0 Y10\nG3 X20 Y10 I10 J0\nG1 X30 Y30\nG2 X50 Y30 R10\nG3 X60 Y40 I0 J10\nG1 X60 "
           "Y60\n"
           "G40 G0 X0\n",
           "G42.1 D4 G1 X0 Y10\nG3 X20 Y10 I10 J0\nG1 X30 Y30\nG2 X50 Y30 R10\nG3 X60 Y40 I0 J10\n"
           "G2 X60 Y60 R20\nG40 G0 X0\n",
           "G41.1 D4\nG3 X10 Y10 I0 J10\nG3 X10 Y10 I-10 J0\nG1 Y20\nG0 X20\nG4 P1\nG0 X20 Y50\nG40 X0\n",
           "G41.1 D4 G1 X10 Y0\nX15\nX5\nG40 Y9\n",
           "G0 X-50 Y-100\nG41.1 D-.5 G1 Y-102\nG2 I4.980439 J-0.441843 X-40.097651 Y-103.322073\n"
           "G2 I-0.682919 J-1.106175 X-39.500873 Y-104.657107\nG1 X-54.500873 Y-94.657107\n"
           "G2 I-1.575966 J-2.552711 X-57.872219 Y-99.613276\nG40\nG1 X-62.872219 Y-114.613276\n",
           "G20 G42.1 D.25 G1 X1 Y1\nG2 X2 Y2 I1\nG1 X4\nG3 X4 Y4 J1\nG1 X1 Y2.5\nG40 X0 Y0\n",
       })
    compare(program);
}
