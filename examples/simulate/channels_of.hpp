// The channels of a machine's report.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

#include "support/machine_file.hpp"

namespace simulate {

/// Which channel of the report each axis is: X, Y and Z of a machine that moves these are the tool's.
[[nodiscard]] inline std::vector<std::size_t> channels_of(const support::Machine& file) {
  std::vector<std::size_t> result;
  std::size_t next = 3;
  for (const support::MachineAxis& axis : file.axes) {
    const std::size_t known = std::string_view("XYZ").find(axis.letter);
    const bool of_tool = file.kinematics == support::Kinematics::cartesian && known != std::string_view::npos;
    result.push_back(of_tool ? known : next++);
  }
  return result;
}

}  // namespace simulate
