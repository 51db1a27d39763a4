// The channels of a report: the tool, and the axes beside it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "cncplan_tools/detail/channel_point.hpp"
#include "cncplan_tools/machine_file.hpp"
#include "cncplan_tools/report.hpp"

namespace cncplan::tools::report {

/// Which channel of the report each axis is: X, Y and Z of a machine that moves these are the tool's.
[[nodiscard]] inline std::vector<std::size_t> channels_of(const MachineFile& file) {
  std::vector<std::size_t> result;
  std::size_t next = 3;
  for (const MachineAxis& axis : file.axes) {
    const std::size_t known = std::string_view("XYZ").find(axis.letter);
    const bool of_tool = file.kinematics == Kinematics::cartesian && known != std::string_view::npos;
    result.push_back(of_tool ? known : next++);
  }
  return result;
}

/// The tool and those axes of a machine whose channel is behind the tool's, in mm or degrees, where tool and
/// axes (mm or rad) go so. `channels` has one of each axis.
template <class V>
[[nodiscard]] ChannelPoint channel_point(const MachineFile& machine, const std::vector<std::size_t>& channels,
                                         const PathPoint<Vector3>& tool, const PathPoint<V>& axes) {
  std::size_t size = 3;
  for (const std::size_t channel : channels) size = std::max(size, channel + 1);
  const auto zero = Channels::Zero(static_cast<Eigen::Index>(size));
  ChannelPoint point{zero, zero, zero, zero};
  const auto fill = [&](Channels& to, const Vector3& of_tool, const V& of_axes) {
    to.head<3>() = of_tool;
    for (std::size_t i = 0; i < channels.size(); ++i)
      if (channels[i] >= 3)
        to[static_cast<Eigen::Index>(channels[i])] = machine.shown(i, of_axes[static_cast<Eigen::Index>(i)]);
  };
  fill(point.position, tool.position, axes.position);
  fill(point.first, tool.first, axes.first);
  fill(point.second, tool.second, axes.second);
  fill(point.third, tool.third, axes.third);
  return point;
}

/// The axes of a machine; peaks, of each axis, in mm or degrees.
template <class V>
[[nodiscard]] std::vector<ReportAxis> report_axes(const MachineFile& machine,
                                                  const std::vector<std::size_t>& channels, const V& velocity,
                                                  const V& acceleration, const V& jerk) {
  std::vector<ReportAxis> result;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    result.push_back({std::string(1, machine.axes[i].letter),
                      channels[i],
                      machine.axes[i],
                      {velocity[k], acceleration[k], jerk[k]}});
  }
  return result;
}

}  // namespace cncplan::tools::report
