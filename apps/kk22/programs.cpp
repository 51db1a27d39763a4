#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "cncplan/cncplan.hpp"
#include "experiments.hpp"
#include "published.hpp"
#include "support/failure.hpp"
#include "table_programs.hpp"

namespace kk22 {

using namespace cncplan;

namespace {

using Table = MappedMachine<kinematics::PolarMap>;
using TablePath = cncplan::TablePath<kinematics::PolarMap, MillBlock::Path>;
using TableBlock = cncplan::Block<3, TablePath>;

// What the paper says of a program: minutes, and Table 4's errors of the servo axes, root mean square and
// mean square.
struct Printed {
  const char* name;
  const char* picture;
  generate::Kind kind;
  const char* lines;
  const char* arcs;
  double minutes;
  double samples;                     // per axis
  std::array<double, 3> rms;          // Y, Z, C
  std::array<double, 3> mean_square;  // Y, Z, C
};
constexpr std::array<Printed, 3> printed{{
    {"roughing",
     "kk22_figure15a.svg",
     generate::Kind::roughing,
     "1500",
     "about 500",
     50,
     3.0e6,
     {0.0032, 8.61e-4, 5.52e-5},
     {1.05e-5, 7.46e-7, 3.05e-9}},
    {"finishing",
     "kk22_figure15b.svg",
     generate::Kind::finishing,
     "35000",
     "not given",
     90,
     5.4e6,
     {0.0023, 0.0014, 5.24e-5},
     {5.32e-6, 1.87e-6, 2.74e-9}},
    {"pocket",
     "kk22_figure17.svg",
     generate::Kind::pocket,
     "1200",
     "800",
     20,
     1.2e6,
     {0.0391, 0.0, 6.95e-5},
     {0.0015, 0.0, 4.82e-9}},
}};

// The blocks round the table, C without a jump.
std::vector<TableBlock> on_table(const std::vector<MillBlock>& blocks, double smallest_radius) {
  std::vector<TableBlock> result;
  double table = 0.0;
  for (const MillBlock& block : blocks) {
    const auto followed =
        follow_table(block.path, kinematics::PolarMap{}, smallest_radius, table, [&](const TablePath& path) {
          result.push_back({.path = path, .feed = block.feed, .rapid = block.rapid});
        });
    if (!followed)
      throw support::Failure(support::Exit::other, "a program comes too near to the table's axis");
    if (block.exact_stop && !result.empty()) result.back().exact_stop = true;
  }
  return result;
}

// The axes at an instant, mm and degrees, and how far their steps are from there.
struct Tracked {
  double time{};
  std::array<double, 3> place{}, error{};
};

// Notes the axes and their steps every 1.25 s over the first ten minutes.
class Tracker {
 public:
  Tracker(const Trajectory<Table, TableBlock>& planned, const support::Machine& machine)
      : planned_(planned), machine_(machine), until_(std::min(600.0, planned.duration())) {
    std::size_t motor = 0;
    for (std::size_t i = 0; i < axes; ++i) {
      const auto& motors = planned.machine().axes[i].motors;
      scale_[i] = motors[0].steps_per_unit;
      counts_[i] = step::count_at(planned.at(0.0).position[static_cast<Eigen::Index>(i)] * scale_[i]);
      first_[i] = motor;
      motor += motors.size();
    }
  }

  void take(const MotorEdge& edge) {
    note_until(edge.time);
    const auto axis = static_cast<std::size_t>(edge.axis);
    if (edge.motor == first_[axis]) counts_[axis] += edge.direction;
  }

  std::vector<Tracked> finish() {
    note_until(until_ + every);
    return std::move(tracked_);
  }

 private:
  static constexpr std::size_t axes = 3;
  static constexpr double every = 1.25;  // s

  void note_until(double time) {
    for (; due_ < time && due_ <= until_; due_ = every * static_cast<double>(tracked_.size())) {
      const auto planned = planned_.at(due_).position;
      Tracked& now = tracked_.emplace_back();
      now.time = due_;
      for (std::size_t i = 0; i < axes; ++i) {
        const double place = planned[static_cast<Eigen::Index>(i)];
        now.place[i] = machine_.shown(i, place);
        now.error[i] = machine_.shown(i, static_cast<double>(counts_[i]) / scale_[i] - place);
      }
    }
  }

  const Trajectory<Table, TableBlock>& planned_;
  const support::Machine& machine_;
  double until_;
  double due_ = 0.0;
  std::array<double, axes> scale_{};
  std::array<std::int64_t, axes> counts_{};
  std::array<std::size_t, axes> first_{};  // motors of the axes
  std::vector<Tracked> tracked_;
};

void draw(support::Gnuplot& plot, const char* picture, const std::vector<Tracked>& tracked) {
  plot("$tracked << EOD\n");
  for (const auto& [time, place, error] : tracked)
    plot("{:.5g} {:.6g} {:.6g} {:.6g} {:.3g} {:.3g} {:.3g}\n", time / 60, place[0], place[1], place[2],
         1e3 * error[0], 1e3 * error[1], 1e3 * error[2]);
  plot("EOD\nset terminal svg size 900,700 background 'white'\n");
  plot.picture(picture);
  plot("unset key\nset multiplot layout 3,2\n");
  int column = 2;
  for (const auto& [axis, unit] : {std::pair{"Y", "mm"}, std::pair{"Z", "mm"}, std::pair{"C", "degrees"}}) {
    plot("set xlabel 't, min'\nset ylabel '{}, {}'\nplot $tracked using 1:{} with lines\n", axis, unit,
         column);
    plot("set ylabel 'error, {}'\nplot $tracked using 1:{} with dots lc '#b2182b'\n",
         *axis == 'C' ? "1e-3 degrees" : "um", column + 3);
    ++column;
  }
  plot("unset multiplot\n");
}

// Turned into steps on the machine, with look-ahead within the limits of its axes.
struct Run {
  double minutes{};
  std::array<step::AxisReport, 3> axes;
  std::vector<Tracked> tracked;
};

Run run(const std::vector<MillBlock>& blocks, const support::Machine& machine) {
  Table table;
  for (std::size_t i = 0; i < table.axes.size(); ++i) table.axes[i] = machine.axis(i);
  table.limits.velocity = limits.velocity;
  const auto planned =
      plan_blocks(on_table(blocks, machine.smallest_radius.value_or(1.0)), table, {.tolerance = 0});
  if (!planned) throw support::Failure(support::Exit::other, to_text(planned.error()));
  Tracker tracker(*planned, machine);
  const auto axes = follow_steps(*planned, period, [&](const MotorEdge& edge) { tracker.take(edge); });
  if (!axes) throw support::Failure(support::Exit::other, to_text(axes.error().error));
  return {planned->duration() / 60.0, *axes, tracker.finish()};
}

}  // namespace

std::vector<MillBlock> blocks_of(generate::Kind kind, const std::array<double, 2>& table_center) {
  std::ostringstream stream;
  generate::write(stream, kind, 2022, 17);
  const std::string text = stream.str();
  const gcode::Dialect dialect = dialect_of(mill);
  gcode::Reader reader(dialect);
  BlockBuilder<Machine<3>> builder(mill, dialect);
  std::vector<MillBlock> blocks;
  const auto take = [&](gcode::Item item) {
    if (auto* motion = std::get_if<gcode::Motion>(&item))
      for (std::size_t i = 0; i < 2; ++i) motion->offset[i] -= table_center[i];
    const auto block = builder.take(item).value();
    if (block && block->path.length() > 0.0)
      blocks.push_back(*block);
    else if (block && !blocks.empty())
      blocks.back().exact_stop = true;
  };
  if (!gcode::read_program(gcode::TextLines(text), reader, take))
    throw support::Failure(support::Exit::other, "a generated program cannot be read");
  return blocks;
}

void programs(const support::Machine& machine, const std::vector<std::string>& names, Lengths lengths,
              support::Gnuplot* plot) {
  std::string errors;
  fmt::print(
      "## The three programs\n\nKK22's / ours: the programs are of the paper's kinds and sizes, not its own. "
      "Time "
      "in minutes.\n\n"
      "| | moves | arcs | KK22 | planned as published | on the table, look-ahead | samples |\n"
      "|---|---|---|---|---|---|---|\n");
  for (const Printed& paper : printed) {
    if (std::find(names.begin(), names.end(), paper.name) == names.end()) continue;
    const auto blocks = blocks_of(paper.kind, machine.table_center);
    const auto arcs = std::count_if(blocks.begin(), blocks.end(),
                                    [](const auto& block) { return block.path.arc() != nullptr; });
    const Run ours = run(blocks, machine);
    fmt::print("| {} | {} / {} | {} / {} | {} | {:.1f} | {:.1f} | {:.1e} / {:.1e} |\n", paper.name,
               paper.lines, blocks.size(), paper.arcs, arcs, paper.minutes,
               published_plan(blocks, lengths).duration() / 60.0, ours.minutes, paper.samples,
               std::floor(ours.minutes * 60.0 / period) + 1.0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto& own = ours.axes[axis];
      errors += fmt::format("| {}, {} | {} | {:.3g} | {:.3g} | {:.3g} | {:.3g} | {:.3g} |\n", paper.name,
                            machine.axes[axis].letter, paper.rms[axis], paper.mean_square[axis],
                            machine.shown(axis, own.rms_error),
                            machine.shown(axis, machine.shown(axis, own.mean_square_error)),
                            machine.shown(axis, own.max_error),
                            1.0 / machine.axes[axis].drive.steps_per_unit / std::sqrt(12.0));
    }
    if (plot != nullptr) draw(*plot, paper.picture, ours.tracked);
  }
  fmt::print(
      "\n## Table 4: errors of the axes\n\nRoot mean square and mean square (Eq. 18), every millisecond. Y "
      "and Z in mm and mm^2, C in degrees and their square here; the paper does not print its unit.\n\n"
      "| | KK22, servo axes: RMSE | MSE | cncplan, steps: RMSE | MSE | largest | a step over the root of 12 "
      "|\n|---|---|---|---|---|---|---|\n{}",
      errors);
}

}  // namespace kk22
