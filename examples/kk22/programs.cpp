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
#include "generate/programs.hpp"
#include "published.hpp"
#include "support/failure.hpp"

namespace kk22 {

using namespace cncplan;

namespace {

using Table = MappedMachine<kinematics::PolarMap>;
using TablePath = plan::TablePath<kinematics::PolarMap, path::Segment<3>>;
using TableBlock = cncplan::Block<3, TablePath>;

// What the paper says of a program: minutes, and Table 4's root mean square errors of the servo axes, mm and
// degrees.
struct Printed {
  const char* name;
  generate::Kind kind;
  const char* lines;
  const char* arcs;
  double minutes;
  double samples;               // per axis
  std::array<double, 3> error;  // Y, Z, C
};
constexpr std::array<Printed, 3> printed{{
    {"roughing", generate::Kind::roughing, "1500", "about 500", 50, 3.0e6, {0.0032, 8.61e-4, 5.52e-5}},
    {"finishing", generate::Kind::finishing, "35000", "not given", 90, 5.4e6, {0.0023, 0.0014, 5.24e-5}},
    {"pocket", generate::Kind::pocket, "1200", "800", 20, 1.2e6, {0.0391, 0.0, 6.95e-5}},
}};

// A program like the paper's, clamped beside the table's axis.
std::vector<cncplan::Block<3>> blocks_of(generate::Kind kind, const support::Machine& machine) {
  std::ostringstream stream;
  generate::write(stream, kind, 2022, 17);
  const std::string text = stream.str();
  const gcode::Dialect dialect = dialect_of(mill);
  gcode::Reader reader(dialect);
  BlockBuilder<Machine<3>> builder(mill, dialect);
  std::vector<cncplan::Block<3>> blocks;
  const auto take = [&](gcode::Item item) {
    if (auto* motion = std::get_if<gcode::Motion>(&item))
      for (std::size_t i = 0; i < 2; ++i) motion->offset[i] -= machine.table_center[i];
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

// The blocks round the table, C without a jump.
std::vector<TableBlock> on_table(const std::vector<cncplan::Block<3>>& blocks, double smallest_radius) {
  std::vector<TableBlock> result;
  double table = 0.0;
  for (const cncplan::Block<3>& block : blocks) {
    const auto followed = plan::follow_table(
        block.path, kinematics::PolarMap{}, smallest_radius, table, [&](const TablePath& path) {
          result.push_back({.path = path, .feed = block.feed, .rapid = block.rapid});
        });
    if (!followed)
      throw support::Failure(support::Exit::other, "a program comes too near to the table's axis");
    if (block.exact_stop && !result.empty()) result.back().exact_stop = true;
  }
  return result;
}

// Turned into steps on the machine, with look-ahead within the limits of its axes.
struct Run {
  double minutes{};
  std::array<step::AxisReport, 3> axes;
};

Run run(const std::vector<cncplan::Block<3>>& blocks, const support::Machine& machine) {
  Table table;
  for (std::size_t i = 0; i < table.axes.size(); ++i) table.axes[i] = machine.axis(i);
  table.limits.velocity = limits.velocity;
  const auto planned = plan_blocks(on_table(blocks, machine.smallest_radius.value_or(1.0)), table);
  if (!planned) throw support::Failure(support::Exit::other, to_text(planned.error()));
  const auto axes = follow_steps(*planned, period, [](const MotorEdge&) {});
  if (!axes) throw support::Failure(support::Exit::other, to_text(axes.error().error));
  return {planned->duration() / 60.0, *axes};
}

}  // namespace

void programs(const support::Machine& machine, const std::vector<std::string>& names) {
  std::string errors;
  fmt::print(
      "## The three programs\n\nKK22's / ours: the programs are of the paper's kinds and sizes, not its own. "
      "Time "
      "in minutes.\n\n"
      "| | moves | arcs | KK22 | planned as published | on the table, look-ahead | samples |\n"
      "|---|---|---|---|---|---|---|\n");
  for (const Printed& paper : printed) {
    if (std::find(names.begin(), names.end(), paper.name) == names.end()) continue;
    const auto blocks = blocks_of(paper.kind, machine);
    const auto arcs = std::count_if(blocks.begin(), blocks.end(),
                                    [](const auto& block) { return block.path.arc() != nullptr; });
    const Run ours = run(blocks, machine);
    fmt::print("| {} | {} / {} | {} / {} | {} | {:.1f} | {:.1f} | {:.1e} / {:.1e} |\n", paper.name,
               paper.lines, blocks.size(), paper.arcs, arcs, paper.minutes,
               published_plan(blocks).duration() / 60.0, ours.minutes, paper.samples,
               std::floor(ours.minutes * 60.0 / period) + 1.0);
    for (std::size_t axis = 0; axis < 3; ++axis)
      errors += fmt::format("| {}, {} | {} | {:.3g} | {:.3g} |\n", paper.name, machine.axes[axis].letter,
                            paper.error[axis], machine.shown(axis, ours.axes[axis].rms_error),
                            1.0 / machine.axes[axis].drive.steps_per_unit / std::sqrt(12.0));
  }
  fmt::print(
      "\n## Table 4: root mean square errors of the axes\n\nY and Z in mm, C in degrees, every "
      "millisecond.\n\n"
      "| | KK22, servo axes | cncplan, steps | a step over the root of 12 |\n|---|---|---|---|\n{}",
      errors);
}

}  // namespace kk22
