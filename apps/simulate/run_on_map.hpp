// A program on a machine behind a map: read, planned and handed on to what is made of any plan.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cncplan/gcode/language/find_file.hpp"
#include "cncplan/gcode/work_coordinates.hpp"
#include "cncplan/plan_program.hpp"
#include "mapped_motion.hpp"
#include "maps/maps.hpp"
#include "options.hpp"
#include "outputs.hpp"
#include "plan.hpp"
#include "problems.hpp"
#include "program.hpp"
#include "stopwatch.hpp"
#include "support/failure.hpp"
#include "support/machine_file.hpp"
#include "tool_path.hpp"

namespace simulate {

/// Does what the options ask for; the exit code of the program. Each shape of maps has a file of its own,
/// as it takes long to compile. Throws `Failure`.
template <cncplan::path::Map Map>
int run_on_map(const Options& options, const support::Machine& file, const std::string& text, const Map& map);

namespace detail {

using cncplan::junction::Kind;

/// mm from a table's axis: nothing nearer is driven; 0 for other machines.
[[nodiscard]] inline double least_radius(const support::Machine& file) {
  return file.kinematics == support::Kinematics::polar ? file.smallest_radius.value_or(1.0) : 0.0;
}

/// Takes an error of a program; of travel in mm or degrees.
inline void add(Problems& problems, const cncplan::Problem& problem, const support::Machine& file) {
  const cncplan::Error& error = problem.about.error;
  const double least = least_radius(file);
  if (error.code == cncplan::ErrorCode::below_limit && error.bound == least && least > 0.0 &&
      error.field == cncplan::axis_name(file.axes[0].letter))
    return problems.add(
        problem, "too near to the table's axis",
        fmt::format("{:.6g} mm from the table's axis: no nearer than {:.6g} is driven", error.value, least));
  const bool travel =
      error.code == cncplan::ErrorCode::above_limit || error.code == cncplan::ErrorCode::below_limit;
  for (const support::MachineAxis& axis : file.axes)
    if (travel && error.field == cncplan::axis_name(axis.letter))
      return problems.add(problem, fmt::format("axis {} would leave its travel", axis.letter),
                          support::beyond_travel(axis, error.value));
  const std::string text = cncplan::gcode::to_text(problem.about);
  problems.add(problem, text, text);
}

/// A program's text, and of each block which of its motions it is part of.
struct MappedText : ProgramText {
  std::vector<std::size_t> motion_of;
};

/// Each block that moves is a motion; one that rests has the motion before it.
template <class M>
[[nodiscard]] MappedText text_of(const cncplan::Program<M>& program, const M& machine) {
  using Map = cncplan::MapOf<M>;
  using cncplan::path::Line;
  const auto axes = cncplan::tool_axes(machine);
  const auto tip = [&](const auto& path, double s) {
    return cncplan::tool_position(machine, path, s, path.position_at(s), axes);
  };
  const auto offset = [&](std::size_t block) {  // X Y Z are the first of the program's letters
    const cncplan::gcode::Position all = program.offset_of(block);
    return cncplan::Vector3(all[0], all[1], all[2]);
  };
  const auto blocks = program.blocks();
  const cncplan::Vector3 at = tip(blocks[0].path, 0.0);
  MappedText text;
  text.motions.push_back(
      {.line = 1, .column = 1, .offset = offset(0), .path = Line<3>(at, at), .followed = false});
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const auto& block = blocks[i];
    text.take_tolerance(block.tolerance, block.exact_path);
    if (block.path.length() > 0.0) {
      Origin& motion = text.motions.emplace_back(
          Origin{.line = block.line, .column = block.column, .kind = Kind::line, .offset = offset(i)});
      const auto* mapped = block.path.template as<cncplan::detail::MappedPath<Map>>();
      if (mapped != nullptr && mapped->programmed().arc() != nullptr) motion.kind = Kind::arc;
      if (block.rapid) motion.kind = Kind::rapid;
      motion.followed = mapped != nullptr && !cncplan::is_direct(*mapped);
      motion.path = motion.followed
                        ? tool_path<cncplan::path::coordinate_count<Map>>(mapped->programmed())
                        : ToolPath(Line<3>(tip(block.path, 0.0), tip(block.path, block.path.length())));
      motion.length = block.path.length();
      motion.turns = cncplan::length_of(block.path, machine) == cncplan::LengthOf::rotary_axes;
      motion.feed = block.rapid                 ? rapid_speed(machine)
                    : std::isfinite(block.feed) ? block.feed
                                                : feed_speed(machine);
    }
    text.motion_of.push_back(text.motions.size() - 1);
  }
  return text;
}

}  // namespace detail

template <cncplan::path::Map Map>
int run_on_map(const Options& options, const support::Machine& file, const std::string& text,
               const Map& map) {
  using support::Exit;
  using support::Failure;
  cncplan::MappedMachine<Map> machine{.map = map};
  machine.limits = options.limits;
  machine.rapid_rate = file.rapid_rate.value_or(0.0);
  if (std::isfinite(file.feed_limit)) machine.feed_limit = file.feed_limit;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) machine.axes[i] = file.axis(i);
  if (const double least = detail::least_radius(file); least > 0.0)
    machine.axes[0].low = std::max(machine.axes[0].low, least);
  cncplan::PlanOptions planning{
      .rotary_tolerance = options.rotary_tolerance * cncplan::gcode::radians_per_degree,
      .dialect = file.dialect,
      .orientation = options.orientation.value_or(file.map.orientation),
      .subprograms = cncplan::gcode::files_beside(options.program)};
  cncplan::path::MapJoints<Map, double> joints;
  std::copy(file.map.start.begin(), file.map.start.end(), joints.begin());
  if constexpr (cncplan::path::switchable<Map>) {  // the map is off, coordinates are the joints
    std::copy(joints.begin(), joints.end(), planning.start.begin());
  } else {
    const auto start = map.point(joints);
    std::copy(start.begin(), start.end(), planning.start.begin());
  }

  const cncplan::Program<cncplan::MappedMachine<Map>> program(text, machine, planning, options.program);
  Problems problems(options);
  std::vector<std::string> warnings;
  const auto take = [&](const cncplan::Problem& problem) {
    if (problem.is_error()) return detail::add(problems, problem, file);
    warnings.push_back(to_text(problem));
    fmt::print(stderr, "{}\n", warnings.back());
  };
  for (const cncplan::Problem& problem : program.problems()) take(problem);
  if (!(options.tolerance > 0.0))
    for (const cncplan::Problem& problem : program.if_not_smoothed()) take(problem);
  tell(options, problems, static_cast<std::size_t>(program.lines()), warnings.size());
  if (options.check) return static_cast<int>(Exit::done);

  auto origin = detail::text_of(program, machine);
  origin.file = options.program;
  origin.kept = text;
  origin.lines = static_cast<std::size_t>(program.lines());
  origin.tools.assign(program.tools().begin(), program.tools().end());
  origin.warnings = std::move(warnings);

  const auto plan_as = [&](const Options& wanted) {
    planning.tolerance = wanted.tolerance;
    planning.level = wanted.level();
    Plan result;
    auto trajectory = [&] {
      const Stopwatch watch(result.seconds);
      return wanted.tolerance > 0.0 ? plan_program(program, machine, planning)
                                    : plan_program(program, machine, wanted.junction);
    }();
    if (!trajectory) throw Failure(Exit::bad_input, to_text(trajectory.error()));
    result.motion_of = origin.motion_of;
    result.other_levels = other_levels(*trajectory);
    result.motion = mapped_motion(file, std::move(*trajectory));
    return result;
  };
  return write_outputs(options, file, origin, plan_as);
}

}  // namespace simulate
