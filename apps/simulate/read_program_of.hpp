// What `read_program` does, for the files that define it for one kind of machine each.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <type_traits>
#include <utility>

#include "cncplan/gcode/language/find_file.hpp"
#include "cncplan/gcode/work_coordinates.hpp"
#include "cncplan/program.hpp"
#include "read_program.hpp"
#include "rows_program.hpp"

namespace simulate {

namespace detail {

using Place = std::array<double, 9>;

/// Where the axes are before a program, mm and rad.
template <class M>
[[nodiscard]] Place start_axes(const support::Machine& file, const M&) {
  Place axes{};
  if constexpr (cncplan::MappedModel<M>) std::ranges::copy(file.map.start, axes.begin());
  return axes;
}
/// The same in the coordinates of programs.
template <class M>
[[nodiscard]] Place start_place(const support::Machine& file, const M& machine) {
  Place place = start_axes(file, machine);
  if constexpr (cncplan::MappedModel<M>)
    if constexpr (!cncplan::path::switchable<cncplan::MapOf<M>>) {  // else its map is off, and they are
      cncplan::path::MapJoints<cncplan::MapOf<M>, double> joints;   // the axes
      std::copy_n(place.begin(), joints.size(), joints.begin());
      place = {};
      std::ranges::copy(machine.map.point(joints), place.begin());
    }
  return place;
}

template <class M>
struct ReadAs {
  using type = cncplan::Program<M>;
};
template <>
struct ReadAs<Rows> {
  using type = RowsProgram;
};

/// Where the tool is at a length of a path.
template <class M, class P>
[[nodiscard]] cncplan::Vector3 tip(const M& machine, const P& path, double s) {
  if constexpr (std::is_same_v<M, Rows>)
    return machine.tip(path.position_at(s));
  else
    return cncplan::tool_position(machine, path, s, path.position_at(s), cncplan::tool_axes(machine));
}

/// Sets where a motion goes, and what kind it is.
template <class M>
void take_path(Origin& motion, const M& machine, const BlockOf<M>& block) {
  using Kind = cncplan::junction::Kind;
  const auto follow = [&](const auto& programmed) {
    motion.path = tool_path(programmed);
    motion.kind = block.rapid ? Kind::rapid : programmed.arc() != nullptr ? Kind::arc : Kind::line;
  };
  const auto go_straight = [&] {
    motion.followed = false;
    motion.path =
        cncplan::path::Line<3>(tip(machine, block.path, 0.0), tip(machine, block.path, block.path.length()));
    motion.kind = block.rapid ? Kind::rapid : Kind::line;
  };
  if constexpr (std::is_same_v<M, Rows>) {
    go_straight();
  } else if constexpr (cncplan::MappedModel<M>) {
    using Path = cncplan::detail::MappedPath<cncplan::MapOf<M>>;
    const auto* mapped = block.path.template as<Path>();
    if (mapped == nullptr) return go_straight();
    if (!cncplan::is_direct(*mapped)) return follow(mapped->programmed());
    go_straight();
    motion.axes_path = tool_path(mapped->programmed());
  } else {
    follow(block.path);
  }
}

/// Each block that moves is a motion; one that rests has the motion before it.
template <class M, class Read>
void take_motions(Program<M>& program, const Read& read, const M& machine) {
  const auto offset = [&](std::size_t block) {  // X Y Z are the first of the program's letters
    const cncplan::gcode::Position all = read.offset_of(block);
    return cncplan::Vector3(all[0], all[1], all[2]);
  };
  const auto& blocks = read.blocks();
  const cncplan::Vector3 at = tip(machine, blocks[0].path, 0.0);
  program.motions.push_back({.line = 1,
                             .column = 1,
                             .offset = offset(0),
                             .path = cncplan::path::Line<3>(at, at),
                             .followed = false});
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const auto& block = blocks[i];
    program.take_tolerance(block.tolerance, block.exact_path);
    if (block.path.length() > 0.0) {
      Origin& motion = program.motions.emplace_back(
          Origin{.line = block.line, .column = block.column, .plane = read.plane_of(i), .offset = offset(i)});
      take_path(motion, machine, block);
      motion.length = block.path.length();
      if constexpr (!std::is_same_v<M, Rows>)
        motion.turns = cncplan::length_of(block.path, machine) == cncplan::LengthOf::rotary_axes;
      motion.feed = block.rapid                 ? rapid_speed(machine)
                    : std::isfinite(block.feed) ? block.feed
                                                : feed_speed(machine);
    }
    program.motion_of.push_back(program.motions.size() - 1);
  }
}

/// Leaves out what comes before a line: the machine stands where its first motion begins.
template <class M>
void begin_at(Program<M>& program, int line) {
  std::size_t first = 0;
  while (first < program.blocks.size() && program.motions[program.motion_of[first]].line < line) ++first;
  const bool moves = std::any_of(program.motions.begin() + 1, program.motions.end(),
                                 [&](const Origin& motion) { return motion.line >= line; });
  if (!moves)
    throw support::Failure(
        support::Exit::bad_input,
        fmt::format("--from-line {}: {} has no motion there or behind", line, program.file));
  const std::size_t motion = program.motion_of[first];
  program.blocks.erase(program.blocks.begin(), program.blocks.begin() + static_cast<std::ptrdiff_t>(first));
  program.motion_of.erase(program.motion_of.begin(),
                          program.motion_of.begin() + static_cast<std::ptrdiff_t>(first));
  program.motions.erase(program.motions.begin(),
                        program.motions.begin() + static_cast<std::ptrdiff_t>(motion));
  for (std::size_t& of : program.motion_of) of -= motion;
}

}  // namespace detail

template <class M>
Program<M> read_program(const Options& options, const support::Machine& file, const M& machine,
                        Problems& problems) {
  Program<M> program;
  program.file = options.program;
  program.text = program_text(options);
  const cncplan::PlanOptions reading{.start = detail::start_place(file, machine),
                                     .dialect = file.dialect,
                                     .orientation = options.orientation.value_or(file.map.orientation),
                                     .subprograms = cncplan::gcode::files_beside(options.program)};
  typename detail::ReadAs<M>::type read(program.text, machine, reading, options.program);
  const auto axes = detail::start_axes(file, machine);
  const auto take = [&](const cncplan::Problem& problem) {
    if (problem.is_error()) return problems.add(problem, file, axes);
    program.warnings.push_back(to_text(problem));
    fmt::print(stderr, "{}\n", program.warnings.back());
  };
  std::ranges::for_each(read.problems(), take);
  if (!(options.tolerance > 0.0)) std::ranges::for_each(read.if_not_smoothed(), take);
  program.lines = static_cast<std::size_t>(read.lines());
  program.tools.assign(read.tools().begin(), read.tools().end());
  if (!problems.found().empty()) return program;
  detail::take_motions(program, read, machine);
  program.blocks = std::move(read).take_blocks();
  if (options.from_line) detail::begin_at(program, *options.from_line);
  return program;
}

}  // namespace simulate
