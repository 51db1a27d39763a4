#include <fmt/format.h>

#include <utility>

#include "cncplan/cncplan.hpp"
#include "experiments.hpp"
#include "published.hpp"

namespace kk22 {

using namespace cncplan;

namespace {

// Reconstructed, as examples/programs/kk22_figure9.ngc is: the paper does not print the program.
constexpr const char* six_helices =
    "G03 X20 Y0 Z10 R10\nX0 Y0 Z20 R10\nX20 Y0 Z30 R10\nX0 Y0 Z40 R10\nX20 Y0 Z50 R10\nX0 Y0 Z60 R10\n";

MillTrajectory planned(const char* program, Lengths lengths) {
  const MillTrajectory whole = plan_text(program, mill, {.tolerance = 0}).value();
  return published_plan({whole.program().begin(), whole.program().end()}, lengths);
}

void print_row(const char* name, const MillTrajectory& planned) {
  double least = limits.velocity;  // at the junctions
  const auto blocks = planned.blocks();
  for (std::size_t i = 0; i + 1 < blocks.size(); ++i) least = std::min(least, blocks[i].exit);
  fmt::print("| {} | {:.2f} | {:.2f} | {:.2f} | {:.3f} |\n", name, planned.length(), least,
             peaks(planned).along.velocity, planned.duration());
}

void put(support::Gnuplot& plot, const char* name, const MillTrajectory& planned) {
  plot("${} << EOD\n", name);
  for (const auto& point : planned.samples(0.01))
    plot("{:.4g} {:.5g} {:.5g} {:.5g} {:.5g}\n", point.time, point.position.x(), point.position.y(),
         point.position.z(), point.along.velocity);
  plot("EOD\n");
}

}  // namespace

void figure9(support::Gnuplot* plot) {
  const MillTrajectory in_space = planned(six_helices, Lengths::in_space);
  const MillTrajectory planar = planned(six_helices, Lengths::planar);
  fmt::print(
      "## Figs. 9 and 10: six helices\n\n"
      "| | length in space, mm | least speed at a junction, mm/s | largest speed, mm/s | time, s |\n"
      "|---|---|---|---|---|\n| KK22, read from its axes | | Vmax | constant | above 6 |\n");
  print_row("reconstructed, planned by lengths in space", in_space);
  print_row("reconstructed, planned by R theta", planar);
  fmt::print("\n");

  if (plot == nullptr) return;
  put(*plot, "helices", planar);
  put(*plot, "arcs", planned(five_arcs, Lengths::in_space));
  (*plot)("set terminal svg size 900,420 background 'white'\n");
  plot->picture("kk22_figure9.svg");
  (*plot)(
      "unset key\nset multiplot layout 1,2\nset xlabel 'X, mm'\nset ylabel 'Y, mm'\nset zlabel 'Z'\n"
      "splot $helices using 2:3:4 with lines lw 1.5\n"
      "set xlabel 't, s'\nset ylabel 'speed in space, mm/s'\nset yrange [0:*]\n"
      "plot $helices using 1:5 with lines lw 1.5\nunset multiplot\nset yrange [*:*]\n");
  (*plot)("set terminal svg size 900,600 background 'white'\n");
  plot->picture("kk22_figure10.svg");
  (*plot)("set key outside right\nset multiplot layout 2,1\nset ylabel 'mm'\n");
  for (const auto& [data, title] : {std::pair{"arcs", "the arcs of Fig. 7, and the way back"},
                                    std::pair{"helices", "the helices of Fig. 9, by R theta"}})
    (*plot)(
        "set title '{1}'\nset xlabel 't, s'\nplot ${0} using 1:2 with lines lw 1.5 title 'X', ${0} using 1:3 "
        "with lines lw 1.5 title 'Y', ${0} using 1:4 with lines lw 1.5 title 'Z'\n",
        data, title);
  (*plot)("unset multiplot\nunset title\nset key inside\n");
}

}  // namespace kk22
