#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "cncplan/cncplan.hpp"
#include "experiments.hpp"
#include "published.hpp"

namespace kk22 {

using namespace cncplan;

namespace {

void print_row(const char* name, const MillTrajectory& planned) {
  const auto blocks = planned.blocks();
  const double arcs = std::accumulate(blocks.begin(), blocks.end() - 1, 0.0,
                                      [](double sum, const BlockMotion& arc) { return sum + arc.length; });
  fmt::print("| {} | {:.3f} | {:.4g}, {:.4g}, {:.4g}, {:.4g} | {:.4g} | {:.3f} |\n", name, arcs,
             blocks[0].exit, blocks[1].exit, blocks[2].exit, blocks[3].exit, blocks[4].exit + 0.0,
             planned.duration());
}

// Of the five arcs from rest to rest, with these speeds between them.
double time_of_arcs(const MillTrajectory& planned, const std::array<double, 4>& between) {
  double time = 0.0;
  for (std::size_t i = 0; i < 5; ++i)
    time += profile::five_phase(planned.program()[i].path.length(),
                                {.start = i == 0 ? 0.0 : between[i - 1], .end = i == 4 ? 0.0 : between[i]},
                                limits)
                .value()
                .duration();
  return time;
}

// Of an axis on the arcs, mm/s^2.
double largest_acceleration(const MillTrajectory& planned) {
  double largest = 0.0;
  for (const auto& point : planned.samples(period))
    if (point.block < 5) largest = std::max(largest, point.acceleration.cwiseAbs().maxCoeff());
  return largest;
}

void put_samples(support::Gnuplot& plot, const char* name, const MillTrajectory& planned) {
  plot("${} << EOD\n", name);
  for (const auto& point : planned.samples(0.005))
    plot("{:.4g} {:.4g} {:.4g} {:.4g}\n", point.time, point.along.velocity, point.along.acceleration,
         point.along.jerk);
  plot("EOD\n");
}

}  // namespace

void figure7(support::Gnuplot* plot) {
  const MillTrajectory ours = plan_text(five_arcs, mill, {.tolerance = 0}).value();
  const MillTrajectory published =
      published_plan({ours.program().begin(), ours.program().end()}, Lengths::in_space);

  fmt::print(
      "## Fig. 7: five arcs, and the way back\n\n"
      "| | length of the arcs, mm | speeds from arc to arc, mm/s | before the line | time, s |\n"
      "|---|---|---|---|---|\n"
      "| KK22, our reading | 47.124 | 15, 15, 15, 15 | 0 | arcs alone: above 1.6, below 1.8 |\n");
  print_row("cncplan, planned as published", published);
  print_row("cncplan, look-ahead, deviation of 0.01 mm", ours);
  fmt::print(
      "\nThe arcs alone, by readings of Table 3:\n\n| speeds from arc to arc, mm/s | time, s |\n|---|---|\n");
  for (const std::array<double, 4>& between :
       {std::array{15.0, 15.0, 15.0, 15.0}, {30.0, 15.0, 15.0, 30.0}, {30.0, 30.0, 30.0, 30.0}})
    fmt::print("| {}, {}, {}, {} | {:.3f} |\n", between[0], between[1], between[2], between[3],
               time_of_arcs(published, between));
  fmt::print("\nLargest acceleration of an axis on the arcs, planned as published: {:.0f} mm/s^2.\n",
             largest_acceleration(published));
  fmt::print("\n");

  if (plot == nullptr) return;
  put_samples(*plot, "published", published);
  put_samples(*plot, "ours", ours);
  (*plot)("set terminal svg size 900,600 background 'white'\n");
  plot->picture("kk22_figure7.svg");
  (*plot)("set key bottom\nset multiplot layout 3,1\n");
  int column = 2;
  for (const char* label : {"speed, mm/s", "acceleration, mm/s^2", "jerk, mm/s^3"}) {
    (*plot)("set xlabel '{}'\nset ylabel '{}'\n", column == 4 ? "t, s" : "", label);
    (*plot)(
        "plot $published using 1:{0} with {1} lw 1.5 lc '#2166ac' title 'as published', $ours using 1:{0} "
        "with "
        "{1} lw 1.5 lc '#d73027' title 'look-ahead'\n",
        column, column == 4 ? "steps" : "lines");
    ++column;
  }
  (*plot)("unset multiplot\n");
}

}  // namespace kk22
