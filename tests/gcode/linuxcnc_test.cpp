// Debian's linuxcnc-uspace has LinuxCNC's interpreter as a program, rs274: where it is installed it says what
// our motions should be.
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string>

#include "gcode/support.hpp"
#include "support/catch.hpp"
#include "support/program_run.hpp"

using namespace cncplan;

namespace {

/// Motions (machine coordinates to a thousandth) and dwells, a line each.
class Steps {
 public:
  void place(const char* kind, const Vector3& machine) {
    std::array<char, 128> text;
    std::snprintf(text.data(), text.size(), "%s %.3f %.3f %.3f\n", kind, machine[0] + 0.0, machine[1] + 0.0,
                  machine[2] + 0.0);
    if ((machine - here_).norm() > 1e-3) steps_ += text.data();
    here_ = machine;
  }
  void dwell(double seconds) { steps_ += "dwell " + std::to_string(seconds) + '\n'; }
  [[nodiscard]] const std::string& text() const { return steps_; }

 private:
  std::string steps_;
  Vector3 here_ = Vector3::Zero();
};

std::string ours(const std::string& program) {
  Steps steps;
  const auto reading = test::read(program);
  for (const gcode::Item& item : reading.items) {
    if (const auto* dwell = std::get_if<gcode::Dwell>(&item)) steps.dwell(dwell->seconds);
    const auto* motion = std::get_if<gcode::Motion>(&item);
    if (motion == nullptr) continue;
    const auto at = [motion](std::size_t i) { return motion->end[i] + motion->offset[i]; };
    steps.place(motion->kind == gcode::MotionKind::rapid ? "rapid" : "feed", {at(0), at(1), at(2)});
  }
  return steps.text() + reading.error;
}

std::string theirs(const std::string& printed) {
  Steps steps;
  std::istringstream lines(printed);
  double unit = 1.0;
  Vector3 system = Vector3::Zero(), shift = Vector3::Zero(), tool = Vector3::Zero();
  for (std::string line; std::getline(lines, line);) {
    const auto is = [&](const char* name) { return line.find(name) != std::string::npos; };
    const std::size_t open = line.find('(');
    if (open == std::string::npos) continue;
    std::array<double, 4> v{};
    std::sscanf(line.c_str() + open, "(%lf, %lf, %lf, %lf", &v[0], &v[1], &v[2], &v[3]);
    if (is("USE_LENGTH_UNITS")) unit = is("INCHES") ? 25.4 : 1.0;
    if (is("SET_G5X_OFFSET")) system = Vector3(v[1], v[2], v[3]) * unit;
    if (is("SET_G92_OFFSET")) shift = Vector3(v[0], v[1], v[2]) * unit;
    if (is("USE_TOOL_LENGTH_OFFSET")) tool = Vector3(v[0], v[1], v[2]) * unit;
    if (is("DWELL")) steps.dwell(v[0]);
    if (is("STRAIGHT_"))
      steps.place(is("TRAVERSE") ? "rapid" : "feed",
                  Vector3(v[0], v[1], v[2]) * unit + system + shift + tool);
  }
  return steps.text();
}

}  // namespace

TEST_CASE("cycles, offsets and diameters as LinuxCNC's interpreter has them") {
  if (std::system("command -v rs274 >/dev/null 2>&1") != 0) {
    WARN("SKIPPED: rs274 (linuxcnc-uspace) is not installed");
    return;
  }
  for (const char* program : {
           "G98 G81 X1 Y2 Z-3 R2\nX5\nG99 X7 Y3\nG98 X9\nG80 G0 Z0\nG81 X1 Z-2 R1\n",
           "G82 Z-4 P.5 X10 R3\nY5\nG91 G83 X1 Y1 Z-5 R-2 Q2 L3\nX1\n",
           "G99 G85 X0 Y0 Z-2 R1\nG86 X1 Z-2 R1 P.2\nG98 G89 X2 Z-2 R1 P.2\n",
           "G18 G99 G73 X1 Z2 Y-7 R1 Q3\nG19 G81 Y1 Z3 X-7 R1\n",
           "G20 G83 X.1 Z-.5 R.1 Q.2\nX.2\nG91 X.1 L2\n",
           "G10 L2 P2 X5 Y6 Z7\nG55 G0 X1 Y1 Z1\nG10 L20 P0 X100 Y100\nG0 X101\nG54 X3 Y3 Z3\n"
           "G10 L20 P1 X0 Y0\nG0 X1\nG10 L2 P1 X1 Y1 Z1\nG1 X9\nG92 X0\nG1 X1\nG92.1\nG1 X1\n",
           "G7 X8 Z1\nG8 X8\nG7 G91 X2\n",
       }) {
    INFO(program);
    const std::string text = std::string("G21 G17 G90 G94 M3 S1000 F100\nG0 X0 Y0 Z10\n") + program + "M2\n";
    const test::TemporaryFolder folder;
    folder.write("part.ngc", text);
    folder.write("tools.tbl", "T1 P1 Z0\n");
    REQUIRE(folder.run_program("rs274", "-g -n 0 -t tools.tbl -v none.var part.ngc out.txt").exit == 0);
    CHECK(ours(text) == theirs(folder.read("out.txt")));
  }
}
