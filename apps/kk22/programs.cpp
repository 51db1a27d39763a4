#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "cncplan/cncplan.hpp"
#include "cncplan/kinematics/ready_made.hpp"
#include "cncplan_tools/machine_file.hpp"
#include "experiments.hpp"
#include "maps/maps.hpp"
#include "published.hpp"
#include "support/failure.hpp"
#include "table_programs.hpp"

namespace kk22 {

using namespace cncplan;

namespace {

using Table = MappedMachine<kinematics::ThreeJoints>;
using TableTrajectory = Trajectory<Table, ProgramBlock<Table>>;

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

// The axes at an instant, mm and degrees, and how far their steps are from there.
struct Tracked {
  double time{};
  std::array<double, 3> place{}, error{};
};

// Notes the axes and their steps every 1.25 s over the first ten minutes.
class Tracker {
 public:
  Tracker(const TableTrajectory& planned, const support::Machine& machine)
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

  const TableTrajectory& planned_;
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

// The text of a program, made from a fixed seed.
std::string text_of(generate::Kind kind) {
  std::ostringstream stream;
  generate::write(stream, kind, 2022, 17);
  return stream.str();
}

Run run(generate::Kind kind, const support::Machine& machine) {
  const support::Machine file = support::with_table_map(machine);
  const Table table = tools::with_axes(Table{.map = std::get<kinematics::ThreeJoints>(file.map.map)}, file,
                                       {.velocity = limits.velocity});
  const auto planned = plan_text(text_of(kind), table, {.tolerance = 0});
  if (!planned) throw support::Failure(support::Exit::other, to_text(planned.error()));
  Tracker tracker(*planned, machine);
  const auto axes = follow_steps(*planned, period, [&](const MotorEdge& edge) { tracker.take(edge); });
  if (!axes) throw support::Failure(support::Exit::other, to_text(axes.error().error));
  return {planned->duration() / 60.0, *axes, tracker.finish()};
}

}  // namespace

std::vector<MillBlock> blocks_of(generate::Kind kind) {
  const auto program = read_text(text_of(kind), mill);
  if (program.failed()) throw support::Failure(support::Exit::other, "a generated program cannot be read");
  std::vector<MillBlock> blocks;
  for (const MillBlock& block : program.blocks())
    if (block.path.length() > 0.0)
      blocks.push_back(block);
    else if (block.exact_stop && !blocks.empty())
      blocks.back().exact_stop = true;
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
    const auto blocks = blocks_of(paper.kind);
    const auto arcs = std::count_if(blocks.begin(), blocks.end(),
                                    [](const auto& block) { return block.path.arc() != nullptr; });
    const Run ours = run(paper.kind, machine);
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
