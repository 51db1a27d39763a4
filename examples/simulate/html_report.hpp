// A run as the report that a browser shows.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "cncplan/cncplan.hpp"
#include "contour.hpp"
#include "events.hpp"
#include "machine.hpp"
#include "measures.hpp"
#include "options.hpp"
#include "program.hpp"
#include "report.hpp"
#include "report/channels.hpp"
#include "report/report.hpp"
#include "report/tip_point.hpp"

namespace simulate {

/// Which channel of the report each axis is: X, Y and Z of a machine that moves these are the tool's.
[[nodiscard]] inline std::vector<std::size_t> channels_of(const support::Machine& file) {
  std::vector<std::size_t> result;
  std::size_t next = 3;
  for (const MachineAxis& axis : file.axes) {
    const std::size_t known = std::string_view("XYZ").find(axis.letter);
    const bool of_tool = file.kinematics == Kinematics::cartesian && known != std::string_view::npos;
    result.push_back(of_tool ? known : next++);
  }
  return result;
}

template <class M, class Trajectory>
[[nodiscard]] report::MotionData motion_of(const support::Machine& file, const Program<M>& program,
                                           const Trajectory& trajectory) {
  const auto channels = channels_of(file);
  const M& machine = trajectory.machine();
  const auto channels_at = [&](std::size_t block, double s) {
    const auto path = trajectory.path(block);
    const auto axes = path.point_at(s);
    if constexpr (std::is_same_v<M, Rows>)
      return report::channel_point(file, channels, report::tip_point(machine.tool_length, axes), axes);
    else
      return report::channel_point(
          file, channels,
          path.exact() ? cncplan::tool_point(path.programmed(), s, cncplan::tool_axes(machine))
                       : path.tool_point_at(s),
          axes);
  };
  return report::motion_data(trajectory, channels_at, [&](std::size_t block) {
    const Origin& motion = program.motions[program.motion_of[block]];
    return report::Place{motion.line, motion.kind, motion.offset};
  });
}

/// How far the driven path is from the programmed one; nothing where that is driven.
template <class M, class Trajectory>
[[nodiscard]] report::Deviation deviation_of(const Options& options, const Program<M>& program,
                                             const Trajectory& trajectory) {
  report::Deviation result;
  if (!(options.tolerance > 0.0) || !(trajectory.duration() > 0.0)) return result;
  constexpr double shortest = 0.0005, most = 60000;
  const double count = std::ceil(std::min(most, trajectory.duration() / shortest));
  result.period = trajectory.duration() / count;
  const bool one = std::none_of(program.blocks.begin(), program.blocks.end(),
                                [](const auto& block) { return block.tolerance.has_value(); });
  result.tolerance = one ? options.tolerance : 0.0;
  std::vector<double> motion_start(program.motions.size());
  for (std::size_t i = program.blocks.size(); i-- > 0;)
    motion_start[program.motion_of[i]] = trajectory.start_length(i);
  PathDistance distance;
  Sample sample;
  for (double k = 0.0; k <= count; ++k) {
    const auto point = trajectory.at(k * result.period);
    const std::size_t motion = program.motion_of[point.block];
    sample.motion = &program.motions[motion];
    sample.position = tool_at(trajectory.machine(), point);
    sample.within = point.along.position - motion_start[motion];
    for (const double gap : distance.gap(sample)) result.vectors.push_back(static_cast<float>(gap));
  }
  return result;
}

/// A run as one of the plans of a report.
template <class M, class Trajectory>
[[nodiscard]] report::Plan plan_of(const Options& options, const support::Machine& file,
                                   const Program<M>& program, const Trajectory& trajectory) {
  const std::string name =
      options.tolerance > 0.0 ? fmt::format("tolerance {} mm", options.tolerance) : std::string("exact path");
  return {name, motion_of(file, program, trajectory), deviation_of(options, program, trajectory)};
}

/// What there is to be seen of a run.
template <class M, class Trajectory>
[[nodiscard]] report::Report html_report(const Options& options, const support::Machine& file,
                                         const Program<M>& program, const Measures& measures,
                                         const Trajectory& trajectory) {
  report::Report result{.file = program.file,
                        .text = program.kept ? *program.kept : report::read_text(program.file),
                        .summary = summary_rows(program, options, measures),
                        .warnings = program.warnings,
                        .limits = options.limits,
                        .tool_peak = measures.tool_peak,
                        .axes = report::report_axes(file, channels_of(file), measures.axis_velocity,
                                                    measures.axis_acceleration, measures.axis_jerk),
                        .marks = {},
                        .drawings = {},
                        .plans = {}};
  if (options.events)
    for (const Event& event : read_events(*options.events))
      result.marks.push_back({event.time, event_text(event)});
  result.plans.push_back(plan_of(options, file, program, trajectory));
  return result;
}

}  // namespace simulate
