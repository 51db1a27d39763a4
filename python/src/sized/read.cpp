// From a program's text, or from blocks made by hand, to a trajectory, for machines of AXES axes.
#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <string>

#include "cncplan/gcode/stream_lines.hpp"
#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/path/arc_from_radius.hpp"
#include "cncplan/plan/block_checks.hpp"
#include "cncplan/plan/block_reader.hpp"
#include "cncplan/plan/plan_program.hpp"
#include "fault.hpp"
#include "planned.hpp"
#include "program.hpp"

namespace cncplan::python {

namespace {

[[noreturn]] void refuse(ProgramError error, const std::string& file) {
  error.file = file;
  raise(std::move(error));
}

VectorN<double, AXES> place_of(const gcode::Position& position) {
  VectorN<double, AXES> place;
  for (int i = 0; i < AXES; ++i) place[i] = position[static_cast<std::size_t>(i)];
  return place;
}

Expected<path::Arc> arc_of(const AnyBlock& block) {
  const Vector3 start(block.start[0], block.start[1], block.start[2]);
  const Vector3 end(block.end[0], block.end[1], block.end[2]);
  if (block.kind == BlockKind::arc_center)
    return path::arc_from_center(start, end, block.center, block.turn, block.plane, {}, block.extra_turns);
  return path::arc_from_radius(start, end, block.radius, block.turn, block.plane, {}, block.extra_turns);
}

// An arc as it is in space, and as it is with axes that go along.
const path::Arc& in_space(const path::Arc& arc) { return arc; }
template <class ArcAlong>
const path::Arc& in_space(const ArcAlong& arc) {
  return arc.arc();
}
template <int N>
typename ReadBlock<N>::Path with_others(const path::Arc& arc, const VectorN<double, N>& start,
                                        const VectorN<double, N>& end) {
  if constexpr (N == 3)
    return arc;
  else
    return path::BasicArcAlong<double, N>(arc, start, end);
}

MotionRow row_of(const gcode::Motion& motion, const ReadBlock<AXES>& block) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  constexpr std::array<int, 4> planes{17, 18, 19, 18};
  MotionRow row{.line = motion.line,
                .column = motion.column,
                .kind = motion.kind == gcode::MotionKind::rapid ? 0 : 3,
                .plane = planes[static_cast<std::size_t>(motion.plane)],
                .center = {none, none, none},
                .radius = none,
                .sweep = none,
                .length = block.path.length(),
                .feed = block.rapid || !motion.feed ? none : block.feed};
  const auto start = block.path.position_at(0), end = block.path.position_at(row.length);
  std::copy_n(start.data(), AXES, row.start.begin());
  std::copy_n(end.data(), AXES, row.end.begin());
  const auto tell_arc = [&](const path::Arc& arc) {
    row.kind = 2;
    std::copy_n(arc.center().data(), 3, row.center.begin());
    row.radius = arc.start_radius();
    row.sweep = arc.sweep();
  };
  if (block.path.line() != nullptr) {
    if (row.kind != 0) row.kind = 1;
  } else if (const auto* arc = block.path.arc()) {
    tell_arc(in_space(*arc));
  }
  return row;
}

}  // namespace

template <>
ReadProgram read_all<AXES>(const AnyMachine& given, std::istream& text, const PlanOptions& options,
                           const std::string& file, std::size_t most) {
  const auto machine = machine_of<AXES>(given);
  ReadProgram program;
  program.dialect = given.dialect;
  gcode::StreamLines lines(text);
  gcode::Reader reader(given.dialect, start_position(options));
  BlockBuilder<Machine<AXES>> builder(machine, given.dialect);
  builder.start_at(start_position(options));
  gcode::ProgramLines flat(lines, reader, options.subprograms);
  const auto file_here = [&] { return flat.file().empty() ? file : std::string(flat.file()); };
  // What a loop meets in every pass is told once.
  const auto tell = [&](const gcode::Diagnostic& problem) {
    ProgramError error{problem, file_here(), {}};
    const auto same = [&](const ProgramError& other) {
      return other.about == problem && other.file == error.file;
    };
    if (std::none_of(program.problems.begin(), program.problems.end(), same))
      program.problems.push_back(std::move(error));
    return program.problems.size() < most;
  };
  gcode::read_program(
      flat, reader,
      [&](const gcode::Item& item) {
        program.items.push_back(item);
        if (const auto* warning = std::get_if<gcode::Warning>(&item);
            warning != nullptr && !(options.tolerance > 0 && gcode::void_if_smoothed(warning->about)))
          program.warnings.push_back(gcode::to_text(file_here(), warning->about, "warning"));
        const auto block = builder.take(item);
        if (!block) return tell(block.error());
        const auto* motion = std::get_if<gcode::Motion>(&item);
        if (motion == nullptr || !*block || !((*block)->path.length() > 0)) return true;
        program.motions.push_back(row_of(*motion, **block));
        for (const auto& ok : {plan::within_travel((*block)->path, machine), plan::limited(**block, machine)})
          if (!ok && !tell({ok.error(), motion->line, motion->column, {}})) return false;
        return true;
      },
      tell);
  program.lines = reader.line();
  return program;
}

template <>
ReadBlock<AXES> block_of<AXES>(const AnyBlock& from) {
  const auto start = place_of(from.start), end = place_of(from.end);
  ReadBlock<AXES> block;
  block.feed = from.feed;
  block.pause = from.pause;
  block.exact_stop = from.exact_stop;
  block.rapid = from.rapid;
  block.tolerance = from.tolerance;
  block.line = from.line;
  if (from.kind == BlockKind::line) {
    block.path = path::BasicLine<double, AXES>(start, end);
  } else if (from.kind == BlockKind::spline) {
    auto second = start, third = end;
    second.head<3>() = from.controls[0];
    third.head<3>() = from.controls[1];
    const path::RationalCubic<AXES> curve({start, second, third, end});
    if (path::is_straight(curve))
      block.path = path::BasicLine<double, AXES>(start, end);
    else
      block.path = value_of(path::spline(curve));
  } else {
    block.path = with_others<AXES>(value_of(arc_of(from)), start, end);
  }
  return block;
}

template <>
TrajectoryPointer plan_program<AXES>(const AnyMachine& given, std::istream& text, const PlanOptions& options,
                                     Level level, const std::string& file) {
  const auto machine = machine_of<AXES>(given);
  const std::string whole(std::istreambuf_iterator<char>(text), {});
  Program<Machine<AXES>> program(whole, machine, with_dialect(options, given), file);
  if (const Problem* error = program.first_error()) raise(ProgramError(*error));
  auto memory = std::make_unique<InterruptibleMemory>();
  auto planned = plan<AXES>(level, std::move(program).take_blocks(), machine, options, memory.get());
  if (!planned) {
    const auto at = planned.error().block;
    refuse(planned.error(), at ? program.file_of(*at) : file);
  }
  cncplan::plan::tell(*planned, program, options.tolerance > 0);
  return any_trajectory<AXES>(std::move(memory), std::move(*planned));
}

template <>
TrajectoryPointer plan_hand_made<AXES>(const AnyMachine& given, const std::vector<AnyBlock>& blocks,
                                       const PlanOptions& options, Level level) {
  const auto machine = machine_of<AXES>(given);
  std::vector<ReadBlock<AXES>> own;
  own.reserve(blocks.size());
  for (const AnyBlock& block : blocks) own.push_back(block_of<AXES>(block));
  auto memory = std::make_unique<InterruptibleMemory>();
  auto planned = plan<AXES>(level, std::move(own), machine, options, memory.get());
  if (!planned) raise(planned.error());
  return any_trajectory<AXES>(std::move(memory), std::move(*planned));
}

}  // namespace cncplan::python
