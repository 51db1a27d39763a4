#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "experiments.hpp"
#include "published.hpp"
#include "table_programs.hpp"

namespace kk22 {

using namespace cncplan;

void figure14(Lengths lengths, support::Gnuplot* plot) {
  constexpr double from = 400.0, to = 410.0;  // s
  const MillTrajectory planned = published_plan(blocks_of(generate::Kind::roughing), lengths);
  Limits peak{0.0, 0.0, 0.0};
  if (plot != nullptr) (*plot)("$section << EOD\n");
  for (double time = from; time <= to; time += period) {
    const auto point = planned.at(time);
    const auto& [position, velocity, acceleration, jerk] = point.along;
    peak = {std::max(peak.velocity, velocity), std::max(peak.acceleration, std::abs(acceleration)),
            std::max(peak.jerk, std::abs(jerk))};
    if (plot != nullptr && std::fmod(time - from, 5 * period) < period)
      (*plot)("{:.6g} {:.5g} {:.5g} {:.4g} {:.4g} {:.4g}\n", time, point.position.x(), point.position.y(),
              velocity, acceleration, jerk);
  }
  fmt::print(
      "## Fig. 14: ten seconds of the roughing program\n\nLargest along the path:\n\n"
      "| | mm/s | mm/s^2 | mm/s^3 |\n|---|---|---|---|\n| KK22 | 30 | within 1000 | within 10000 |\n"
      "| cncplan, planned as published | {:.4g} | {:.4g} | {:.6g} |\n\n",
      peak.velocity, peak.acceleration, peak.jerk);
  if (plot == nullptr) return;
  (*plot)("EOD\nset terminal svg size 900,700 background 'white'\n");
  plot->picture("kk22_figure14.svg");
  (*plot)("unset key\nset multiplot layout 2,2\nset xlabel 'X, mm'\nset ylabel 'Y, mm'\n");
  (*plot)("plot $section using 2:3 with lines lw 1.5\nset xlabel 't, s'\n");
  int column = 4;
  for (const char* label : {"speed, mm/s", "acceleration, mm/s^2", "jerk, mm/s^3"})
    (*plot)("set ylabel '{}'\nplot $section using 1:{} with {}\n", label, column,
            column == 6 ? "steps" : "lines"),
        ++column;
  (*plot)("unset multiplot\n");
}

}  // namespace kk22
