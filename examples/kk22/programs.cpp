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
#include "support/plan.hpp"
#include "support/stepping.hpp"

namespace kk22 {

using namespace cncplan;

namespace {

using Course = plan::JointCourse<plan::PolarGuide>;
using Path = plan::MappedPath<kinematics::PolarChart>;

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
std::vector<plan::Block> blocks_of(generate::Kind kind, const support::Machine& machine) {
  std::ostringstream stream;
  generate::write(stream, kind, 2022, 17);
  const std::string text = stream.str();
  gcode::Reader reader;
  plan::BlockMaker maker(limits, limits.velocity);
  std::vector<plan::Block> blocks;
  const auto take = [&](gcode::Item item) {
    if (auto* motion = std::get_if<gcode::Motion>(&item))
      for (std::size_t i = 0; i < 2; ++i) motion->offset[i] -= machine.table_center[i];
    if (const auto block = maker.take(item).value()) blocks.push_back(*block);
  };
  if (!gcode::read_program(gcode::TextLines(text), reader, take))
    throw support::Failure(support::Exit::other, "a generated program cannot be read");
  blocks.push_back(maker.finish().value());
  return blocks;
}

// Turned into steps on the machine, with look-ahead within the limits of its axes.
struct Run {
  double minutes{};
  support::StepReports axes;
};

Run run(const std::vector<plan::Block>& blocks, const support::Machine& machine) {
  Course course(plan::PolarGuide(machine.smallest_radius.value_or(1.0)));
  for (const plan::Block& block : blocks) {
    if (!course.append(block.segment, block.limits.velocity))
      throw support::Failure(support::Exit::other, "a program comes too near to the table's axis");
    if (block.stop_at_end) course.stop();
  }
  const auto& pieces = course.blocks();
  std::vector<plan::BlockCaps> caps;
  plan::joint_caps(std::span<const Course::Block>(pieces), machine.joint_limits<3>(), period,
                   std::back_inserter(caps));
  auto spans = support::spans_of(caps, plan::SevenPhase{});
  const support::Plan plan = support::plan_of(std::move(caps), std::move(spans));
  const auto path = [&](std::size_t i) -> const Path& { return pieces[i].path; };
  const auto where = [](std::size_t i) { return fmt::format("piece {}", i); };
  return {plan.duration / 60.0,
          support::make_steps<Path>(plan, machine, period, path, where, [](const step::Edge&) {})};
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
                                    [](const auto& block) { return block.segment.arc() != nullptr; });
    const Run ours = run(blocks, machine);
    fmt::print("| {} | {} / {} | {} / {} | {} | {:.1f} | {:.1f} | {:.1e} / {:.1e} |\n", paper.name,
               paper.lines, blocks.size(), paper.arcs, arcs, paper.minutes,
               published_plan(blocks).duration / 60.0, ours.minutes, paper.samples,
               std::floor(ours.minutes * 60.0 / period) + 1.0);
    for (std::size_t axis = 0; axis < 3; ++axis)
      errors += fmt::format("| {}, {} | {} | {:.3g} | {:.3g} |\n", paper.name, machine.axes[axis].letter,
                            paper.error[axis], ours.axes[axis].rms_error,
                            1.0 / machine.axes[axis].drive.steps_per_unit / std::sqrt(12.0));
  }
  fmt::print(
      "\n## Table 4: root mean square errors of the axes\n\nY and Z in mm, C in degrees, every "
      "millisecond.\n\n"
      "| | KK22, servo axes | cncplan, steps | a step over the root of 12 |\n|---|---|---|---|\n{}",
      errors);
}

}  // namespace kk22
