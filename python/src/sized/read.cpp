// From a program's text to a trajectory, for machines of the number SIZE of `SizedMachine`.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

#include "cncplan/gcode/language/program_lines.hpp"
#include "cncplan/gcode/read_program.hpp"
#include "cncplan/plan_program.hpp"
#include "fault.hpp"
#include "memory.hpp"
#include "planned.hpp"
#include "planner.hpp"
#include "program.hpp"

namespace cncplan::python {

namespace {

// An arc as it is in space, and as it is with axes that go along.
[[maybe_unused]] const path::Arc& in_space(const path::Arc& arc) { return arc; }
template <class ArcAlong>
const path::Arc& in_space(const ArcAlong& arc) {
  return arc.arc();
}
template <int N>
MotionRow row_of(const ReadBlock<N>& block) {
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
  std::copy_n(start.data(), start.size(), row.start.begin());
  std::copy_n(end.data(), end.size(), row.end.begin());
  if constexpr (N < 0) {
    if (!block.rapid) row.kind = 4;
  } else if (block.path.line() != nullptr) {
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
ReadProgram read_all<SIZE>(const AnyMachine& machine, std::string_view text, const PlanOptions& given,
                           const std::string& file) {
  const PlanOptions options = with_dialect(given, machine);
  const Program<SizedMachine<SIZE>> program(text, machine_of<SIZE>(machine), options, file);
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
  for (const ReadBlock<SIZE>& block : program.blocks())
    if (block.path.length() > 0) result.motions.push_back(row_of<SIZE>(block));
  for (const ProgramWord& word : program.words()) result.words.push_back(word.word);
  result.behind_map = SIZE < 0;
  if (!result.problems.empty() || result.behind_map) return result;
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
TrajectoryPointer plan_text<SIZE>(const AnyMachine& given, std::string_view text, const PlanOptions& options,
                                  const std::string& file) {
  const auto machine = machine_of<SIZE>(given);
  Program<SizedMachine<SIZE>> program(text, machine, with_dialect(options, given), file);
  if (const Problem* error = program.first_error()) raise(*error);
  auto planned = plan_blocks(std::move(program).take_blocks(), machine, options, guarded_memory());
  if (!planned) {
    planned.error().file = program.file_of(planned.error().block.value_or(0));
    raise(planned.error());
  }
  cncplan::detail::tell(*planned, program, level_of(options) != SmoothLevel::exact);
  return any_trajectory<SIZE>(given, std::move(*planned));
}

}  // namespace cncplan::python
