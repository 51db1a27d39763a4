#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "cncplan/cncplan.hpp"
#include "experiments.hpp"
#include "published.hpp"

namespace kk22 {

using namespace cncplan;

namespace {

// No F word: everything runs at the speed limit.
constexpr const char* program = "G02 X5 Y5 R5\nX10 Y0 R5\nX10 Y-10 R5\nX5 Y-15 R5\nX0 Y-10 R5\nG01 X0 Y0\n";

std::vector<double> junction_speeds(const plan::Plan& plan) {
  std::vector<plan::BlockTiming> timings;
  plan::block_timings(std::span<const plan::Span>(plan.spans), std::span<const double>(plan.lengths),
                      std::back_inserter(timings));
  std::vector<double> speeds(timings.size());
  std::transform(timings.begin(), timings.end(), speeds.begin(),
                 [](const auto& block) { return block.exit.velocity; });
  return speeds;
}

void print_row(const char* name, const plan::Plan& plan) {
  const auto v = junction_speeds(plan);
  fmt::print("| {} | {:.3f} | {:.4g}, {:.4g}, {:.4g}, {:.4g} | {:.4g} | {:.3f} |\n", name,
             std::accumulate(plan.lengths.begin(), plan.lengths.end() - 1, 0.0), v[0], v[1], v[2], v[3],
             v[4] + 0.0, plan.duration);
}

void put_samples(support::Gnuplot& plot, const char* name, const std::vector<plan::Block>& blocks,
                 const plan::Plan& plan) {
  plot("${} << EOD\n", name);
  plan::Sampler sampler(blocks, plan.spans, plan.lengths, 0.005);
  while (const auto next = sampler.next()) {
    const State& along = next->sample.along;
    plot("{:.4g} {:.4g} {:.4g} {:.4g}\n", next->sample.time, along.velocity, along.acceleration, along.jerk);
  }
  plot("EOD\n");
}

}  // namespace

void figure7(support::Gnuplot* plot) {
  gcode::Reader reader;
  const auto blocks = plan::read_blocks(gcode::TextLines(program), reader, limits, limits.velocity).value();
  const plan::Plan published = published_plan(blocks);
  const plan::Plan ours = plan::whole_plan(blocks, junction::Deviation{0.01}).value();

  fmt::print(
      "## Fig. 7: five arcs, and the way back\n\n"
      "| | length of the arcs, mm | speeds from arc to arc, mm/s | before the line | time, s |\n"
      "|---|---|---|---|---|\n"
      "| KK22, our reading | 47.124 | 15, 15, 15, 15 | 0 | arcs alone: about 1.6 |\n");
  print_row("cncplan, planned as published", published);
  print_row("cncplan, look-ahead, deviation of 0.01 mm", ours);
  fmt::print("\n");

  if (plot == nullptr) return;
  put_samples(*plot, "published", blocks, published);
  put_samples(*plot, "ours", blocks, ours);
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
