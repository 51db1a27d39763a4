// The four kinds of five-phase profile (KK22 Fig. 5), and beside each what seven phases make of it, at an
// acceleration limit that binds. Prints the times and draws profile_kinds.svg where gnuplot is installed.
#include <array>
#include <cncplan/cncplan.hpp>
#include <cstdio>
#include <cstdlib>
#include <string>

using namespace cncplan;

namespace {

struct Case {
  const char* title;
  double length;
  profile::BoundarySpeeds speeds;
};

// One panel: speed over time of both profiles, as data within the script.
void plot(std::FILE* script, int panel, const Case& c, const profile::Profile& five,
          const profile::Profile& seven) {
  std::fprintf(script, "$data%d << EOD\n", panel);
  constexpr int steps = 300;
  for (int k = 0; k <= steps; ++k) {
    const double t = five.duration() * k / steps;
    const State a = five.at(t), b = seven.at(t);
    std::fprintf(script, "%g %g %g %g %g\n", t, a.velocity, a.acceleration, b.velocity, b.acceleration);
  }
  std::fprintf(script, "EOD\nset title '%s'\n", c.title);
  std::fprintf(script,
               "plot $data%d using 1:2 with lines lw 2 lc '#2166ac' title 'five phases: mm/s', "
               "'' using 1:4 with lines lw 2 lc '#d73027' title 'seven', "
               "'' using 1:3 axes x1y2 with lines dt 2 lc '#2166ac' title 'mm/s^2', "
               "'' using 1:5 axes x1y2 with lines dt 2 lc '#d73027' notitle\n",
               panel);
}

}  // namespace

int main() {
  const Limits limits{.velocity = 30.0, .acceleration = 200.0, .jerk = 10000.0};
  const double ramp = profile::five_phase_law(limits).distance(5.0, 25.0);
  const std::array<Case, 4> cases{{{"all five phases", 12.0, {5.0, 10.0}},
                                   {"no cruise", 3.0, {5.0, 10.0}},
                                   {"acceleration only", ramp, {5.0, 25.0}},
                                   {"deceleration only", ramp, {25.0, 5.0}}}};

  const std::string file = "profile_kinds.gnuplot";
  std::FILE* const script = std::fopen(file.c_str(), "w");
  if (script == nullptr) return 1;
  std::fputs(
      "set terminal svg size 1000,700 background 'white'\nset output 'profile_kinds.svg'\nset grid\n"
      "set ytics nomirror\nset y2tics\nset xlabel 's'\nset key bottom\nset multiplot layout 2,2\n",
      script);
  std::printf("%-20s %8s %12s %12s %10s\n", "kind", "mm", "five s", "seven s", "saved %");
  int panel = 0;
  for (const Case& c : cases) {
    const auto five = profile::five_phase(c.length, c.speeds, limits);
    const auto seven = profile::seven_phase(c.length, c.speeds, limits);
    if (!five || !seven) return 1;
    std::printf("%-20s %8.3f %12.6f %12.6f %10.2f\n", c.title, c.length, five->duration(), seven->duration(),
                100 * (1 - seven->duration() / five->duration()));
    plot(script, panel++, c, *five, *seven);
  }
  std::fputs("unset multiplot\n", script);
  std::fclose(script);
  if (std::system(("gnuplot " + file + " 2>/dev/null").c_str()) != 0)
    std::puts("no picture: gnuplot is not installed");
}
