// What a report shows of a trajectory.
#pragma once

#include <array>
#include <charconv>
#include <cstddef>
#include <string>

#include "cncplan/peaks.hpp"
#include "cncplan/smooth_level.hpp"
#include "cncplan/trajectory.hpp"
#include "cncplan_tools/detail/channels.hpp"
#include "cncplan_tools/detail/driven_trajectory.hpp"
#include "cncplan_tools/machine_file.hpp"
#include "cncplan_tools/report.hpp"

namespace cncplan::tools {

/// A report of a trajectory on a machine without a map, whose file says how its axes are called and shown:
/// the machine is one of this file (`machine_of`). `report::write` makes a page of it. Error: above_limit for
/// a file of more axes than the trajectory has.
template <MachineModel M, BlockModel B>
  requires(!MappedModel<M>)
[[nodiscard]] Expected<report::Report> report_of(const Trajectory<M, B>& trajectory,
                                                 const MachineFile& machine, const ReportText& text) {
  if (const auto ok = fits(machine, M::axis_count); !ok) return tl::unexpected(ok.error());
  const auto channels = report::channels_of(machine);
  const auto tool = tool_axes(trajectory.machine());
  const auto channels_at = [&](std::size_t piece, double s) {
    const auto path = trajectory.path(piece);
    const auto tool_at = path.visit([&](const auto& inside) { return tool_point(inside, s, tool); });
    return report::channel_point(machine, channels, tool_at, path.point_at(s));
  };
  const auto place_of = [&](std::size_t piece) {
    const B& block = trajectory.program()[trajectory.block_of(piece)];
    report::Place place{.line = block.line, .kind = junction::Kind::line};
    if (block.rapid) place.kind = junction::Kind::rapid;
    if (block.path.arc() != nullptr) place.kind = junction::Kind::arc;
    return place;
  };
  const auto shown = [&](const auto& axes) {  // mm or degrees, of the axes that the machine has
    Eigen::VectorXd result(static_cast<Eigen::Index>(machine.axes.size()));
    for (std::size_t i = 0; i < machine.axes.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      result[k] = machine.shown(i, axes[k]);
    }
    return result;
  };
  const auto found = peaks(trajectory);
  report::Report result{.file = text.name,
                        .text = text.text,
                        .summary = text.summary,
                        .warnings = {trajectory.warnings().begin(), trajectory.warnings().end()},
                        .limits = trajectory.machine().limits,
                        .tool_peak = found.tool,
                        .axes = report::report_axes(machine, channels, shown(found.velocity),
                                                    shown(found.acceleration), shown(found.jerk)),
                        .marks = {},
                        .drawings = {},
                        .plans = {}};
  for (const TimedWord& word : trajectory.words()) {
    std::array<char, 32> number{};
    const auto end = std::to_chars(number.data(), number.data() + number.size(), word.word.number).ptr;
    result.marks.push_back({word.time, word.word.letter + std::string(number.data(), end)});
  }
  result.plans.push_back(
      {std::string(to_text(trajectory.level())), report::motion_data(trajectory, channels_at, place_of)});
  return result;
}

}  // namespace cncplan::tools
