// What a report shows of a trajectory of a machine of SIZE axes.
#include <array>
#include <charconv>

#include "cncplan/peaks.hpp"
#include "planned.hpp"
#include "planner.hpp"
#include "report/channels.hpp"
#include "report/driven_trajectory.hpp"
#include "simulate/channels_of.hpp"

namespace cncplan::python {

namespace {

// The largest magnitudes of the axes that the machine has, mm or degrees.
Eigen::VectorXd shown(const support::Machine& machine, const Planned<SIZE>::SetPoint::Vector& axes) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(machine.axes.size()));
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    result[k] = machine.shown(i, axes[k]);
  }
  return result;
}

std::string text_of(const gcode::Word& word) {
  std::array<char, 32> number{};
  const auto end = std::to_chars(number.data(), number.data() + number.size(), word.number).ptr;
  return word.letter + std::string(number.data(), end);
}

}  // namespace

template <>
report::Report report_of<SIZE>(const Planned<SIZE>& trajectory, const AnyMachine& machine,
                               const ReportText& text) {
  const auto channels = simulate::channels_of(machine.file);
  const auto tool = tool_axes(trajectory.machine());
  const auto channels_at = [&](std::size_t piece, double s) {
    const auto path = trajectory.path(piece);
    const auto tool_at = path.visit([&](const auto& inside) { return tool_point(inside, s, tool); });
    return report::channel_point(machine.file, channels, tool_at, path.point_at(s));
  };
  const auto place_of = [&](std::size_t piece) {
    const ReadBlock<SIZE>& block = trajectory.program()[trajectory.block_of(piece)];
    report::Place place{.line = block.line, .kind = junction::Kind::line};
    if (block.rapid) place.kind = junction::Kind::rapid;
    if (block.path.arc() != nullptr) place.kind = junction::Kind::arc;
    return place;
  };
  const auto found = peaks(trajectory);
  report::Report result{
      .file = text.name,
      .text = text.text,
      .summary = text.summary,
      .warnings = {trajectory.warnings().begin(), trajectory.warnings().end()},
      .limits = machine.limits,
      .tool_peak = found.tool,
      .axes = report::report_axes(machine.file, channels, shown(machine.file, found.velocity),
                                  shown(machine.file, found.acceleration), shown(machine.file, found.jerk)),
      .marks = {},
      .drawings = {},
      .plans = {}};
  for (const TimedWord& word : trajectory.words()) result.marks.push_back({word.time, text_of(word.word)});
  result.plans.push_back(
      {std::string(to_text(trajectory.level())), report::motion_data(trajectory, channels_at, place_of)});
  return result;
}

}  // namespace cncplan::python
