// From a program's text, or from blocks made by hand, to a trajectory, for machines of AXES axes.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/path/arc_from_radius.hpp"
#include "cncplan/plan/plan_program.hpp"
#include "fault.hpp"
#include "planned.hpp"
#include "planner.hpp"
#include "program.hpp"

namespace cncplan::python {

namespace {

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
[[maybe_unused]] const path::Arc& in_space(const path::Arc& arc) { return arc; }
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

MotionRow row_of(const ReadBlock<AXES>& block) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  MotionRow row{.line = block.line,
                .column = block.column,
                .kind = block.rapid ? 0 : 3,
                .center = {none, none, none},
                .radius = none,
                .sweep = none,
                .length = block.path.length(),
                .feed = block.rapid || !std::isfinite(block.feed) ? none : block.feed};
  const auto start = block.path.position_at(0), end = block.path.position_at(row.length);
  std::copy_n(start.data(), AXES, row.start.begin());
  std::copy_n(end.data(), AXES, row.end.begin());
  if (block.path.line() != nullptr) {
    if (!block.rapid) row.kind = 1;
  } else if (const auto* along = block.path.arc()) {
    constexpr std::array<int, 4> planes{17, 18, 19, 18};
    const path::Arc& arc = in_space(*along);
    row.kind = 2;
    row.plane = planes[static_cast<std::size_t>(arc.plane())];
    std::copy_n(arc.center().data(), 3, row.center.begin());
    row.radius = arc.start_radius();
    row.sweep = arc.sweep();
  }
  return row;
}

}  // namespace

template <>
ReadProgram read_all<AXES>(const AnyMachine& machine, std::string_view text, const PlanOptions& given,
                           const std::string& file) {
  const PlanOptions options = with_dialect(given, machine);
  const Program<Machine<AXES>> program(text, machine_of<AXES>(machine), options, file);
  ReadProgram result;
  result.dialect = machine.dialect;
  result.lines = program.lines();
  const auto tell = [&](std::span<const Problem> problems) {
    for (const Problem& problem : problems)
      if (problem.warning)
        result.warnings.push_back(to_text(problem));
      else
        result.problems.push_back(problem);
  };
  tell(program.problems());
  if (!(options.tolerance > 0)) tell(program.if_not_smoothed());
  for (const ReadBlock<AXES>& block : program.blocks())
    if (block.path.length() > 0) result.motions.push_back(row_of(block));
  for (const ProgramWord& word : program.words()) result.words.push_back(word.word);
  if (!result.problems.empty()) return result;
  // What is written is the program as its items.
  gcode::Reader reader(machine.dialect, start_position(options));
  gcode::TextLines lines(text);
  gcode::ProgramLines flat(lines, reader, options.subprograms);
  gcode::read_program(
      flat, reader, [&](const gcode::Item& item) { result.items.push_back(item); },
      [](const gcode::Diagnostic&) { return true; });
  return result;
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
TrajectoryPointer plan_text<AXES>(const AnyMachine& given, std::string_view text, const PlanOptions& options,
                                  const std::string& file) {
  const auto machine = machine_of<AXES>(given);
  Program<Machine<AXES>> program(text, machine, with_dialect(options, given), file);
  if (const Problem* error = program.first_error()) raise(*error);
  auto planned = plan_blocks(std::move(program).take_blocks(), machine, options);
  if (!planned) {
    planned.error().file = program.file_of(planned.error().block.value_or(0));
    raise(planned.error());
  }
  plan::tell(*planned, program, level_of(options) != SmoothLevel::exact);
  return any_trajectory<AXES>(given, std::move(*planned));
}

template <>
TrajectoryPointer plan_hand_made<AXES>(const AnyMachine& given, const std::vector<AnyBlock>& blocks,
                                       const PlanOptions& options) {
  const auto machine = machine_of<AXES>(given);
  std::vector<ReadBlock<AXES>> own;
  own.reserve(blocks.size());
  for (const AnyBlock& block : blocks) own.push_back(block_of<AXES>(block));
  auto planned = plan_blocks(std::move(own), machine, options);
  if (!planned) raise(planned.error());
  return any_trajectory<AXES>(given, std::move(*planned));
}

}  // namespace cncplan::python
