// The channels of a report: the tool, and the axes beside it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "report/channel_point.hpp"
#include "report/report.hpp"
#include "support/machine_file.hpp"

namespace report {

/// The tool and those axes of a machine whose channel is behind the tool's, in mm or degrees, where tool and
/// axes (mm or rad) go so. `channels` has one of each axis.
template <class V>
[[nodiscard]] ChannelPoint channel_point(const support::Machine& machine,
                                         const std::vector<std::size_t>& channels,
                                         const cncplan::PathPoint<cncplan::Vector3>& tool,
                                         const cncplan::PathPoint<V>& axes) {
  std::size_t size = 3;
  for (const std::size_t channel : channels) size = std::max(size, channel + 1);
  const auto zero = Channels::Zero(static_cast<Eigen::Index>(size));
  ChannelPoint point{zero, zero, zero, zero};
  const auto fill = [&](Channels& to, const cncplan::Vector3& of_tool, const V& of_axes) {
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
[[nodiscard]] std::vector<ReportAxis> report_axes(const support::Machine& machine,
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

}  // namespace report
