#include "plots.hpp"

#include "support/axes_plot.hpp"

namespace simulate {

void draw(const std::string& folder, bool quiet, const support::Machine& machine,
          const std::vector<Sample>& samples) {
  auto plot = support::Gnuplot::start(folder, quiet);
  if (!plot) return;
  (*plot)("$samples << EOD\n");
  for (const Sample& s : samples) {
    (*plot)("{:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}", s.time, s.tool.x(), s.tool.y(), s.tool.z(),
            s.along.velocity, s.along.acceleration, s.along.jerk);
    support::put_axis_shares(*plot, machine, s.velocity, s.acceleration);
  }
  (*plot)("EOD\n");
  plot->picture("path.svg");
  (*plot)(
      "set size ratio -1\nset xlabel 'X mm'\nset ylabel 'Y mm'\n"
      "set cblabel 'speed mm/s'\nset palette defined (0 '#2166ac', 0.5 '#66bd63', 1 '#d73027')\n"
      "plot $samples using 2:3:5 with lines linewidth 2 palette\n");
  // each of X, Y and Z at the same scale, 120 degrees apart
  plot->picture("path_isometric.svg");
  (*plot)(
      "unset xlabel\nunset ylabel\nunset xtics\nunset ytics\n"
      "plot $samples using (($2-$3)/sqrt(2)):(($2+$3)/sqrt(6)+$4*sqrt(2./3)):5 with lines linewidth 2 "
      "palette\n"
      "set xtics\nset ytics\n");
  plot->picture("profile.svg");
  (*plot)(
      "set size noratio\nset multiplot layout 3,1\nset xlabel 't s'\nunset "
      "colorbox\n");
  struct Curve {
    const char* label;
    int column;
  };
  for (const auto& [label, column] :
       {Curve{"speed mm/s", 5}, Curve{"acceleration mm/s^2", 6}, Curve{"jerk mm/s^3", 7}})
    (*plot)("set ylabel '{}'\nplot $samples using 1:{} with {} linewidth 1.5 linecolor '#2166ac'\n", label,
            column, column == 7 ? "steps" : "lines");
  (*plot)("unset multiplot\n");
  support::draw_axes(*plot, machine, 8);
  plot->finish();
}

}  // namespace simulate
