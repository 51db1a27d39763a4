// Set points of a trajectory as a table in CSV.
#pragma once

#include <array>
#include <charconv>
#include <cstddef>
#include <ostream>

#include "cncplan/trajectory.hpp"
#include "cncplan_tools/machine_file.hpp"

namespace cncplan::tools {

/// A row every `period` seconds, on the grid of `Trajectory::samples`, from the start to the end: time, each
/// axis of the machine's file (mm or degrees, machine coordinates), and place, speed, acceleration and jerk
/// along the path (mm, s), in 17 digits. The trajectory is of a machine of this file (`machine_of`). Errors:
/// that of `samples`, of a period that is none; above_limit for a file of more axes than the trajectory has.
template <MachineModel M, BlockModel B>
[[nodiscard]] Expected<void> write_samples(std::ostream& out, const Trajectory<M, B>& trajectory,
                                           const MachineFile& machine, double period) {
  if (auto ok = fits(machine, M::axis_count); !ok) return ok;
  const auto samples = trajectory.samples(period);
  if (const auto error = samples.error()) return tl::unexpected(*error);
  const auto put = [&out](double number, char behind) {
    std::array<char, 32> text{};
    const auto end =
        std::to_chars(text.data(), text.data() + text.size(), number + 0.0, std::chars_format::general, 17);
    out.write(text.data(), end.ptr - text.data());
    out.put(behind);
  };
  out << "t,";
  for (const MachineAxis& axis : machine.axes) out << axis.letter << ',';
  out << "s,v,a,j\n";
  for (const auto& point : samples) {
    put(point.time, ',');
    for (std::size_t i = 0; i < machine.axes.size(); ++i)
      put(machine.shown(i, point.position[static_cast<Eigen::Index>(i)]), ',');
    put(point.along.position, ',');
    put(point.along.velocity, ',');
    put(point.along.acceleration, ',');
    put(point.along.jerk, '\n');
  }
  return {};
}

}  // namespace cncplan::tools
