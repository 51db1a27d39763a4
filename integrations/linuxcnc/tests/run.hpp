// SPDX-License-Identifier: GPL-2.0-or-later
// A program driven through a planner period by period, and what its positions show.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "canon.hpp"
#include "host.hpp"

namespace cncplan::linuxcnc::test {

struct Sample {
  Coordinates position = Coordinates::Zero();  ///< mm, degrees
  int id{};
  double current_vel{};  ///< as LinuxCNC shows it, machine units/s
};

struct Run {
  std::vector<Sample> samples;
  bool ended{};  ///< all moves were sent and LinuxCNC was told that the motion is done
};

/// Sends a move a period, as task does, until all is done; `ask` is called before each period.
[[nodiscard]] Run drive(Host& host, const std::vector<CanonMove>& moves,
                        const std::function<void(long)>& ask = {}, long most_periods = 2'000'000);

/// Greatest magnitudes of the differences of one coordinate, or of several.
struct Peaks {
  double velocity{}, acceleration{}, jerk{};
};
[[nodiscard]] Peaks peaks(const Run& run, int coordinate);

/// "" where every axis keeps its limits, else what does not and when. Share: of a limit that rounding may
/// add.
[[nodiscard]] std::string beyond_limits(const Run& run, const HostOptions& options, double jerk,
                                        double rotary_jerk = 1e300);

/// How far X Y Z are from the program, at most, mm.
[[nodiscard]] double deviation(const Run& run, const std::vector<CanonMove>& moves);

/// Whether the numbers of moves never go back.
[[nodiscard]] bool ids_ascend(const Run& run);

}  // namespace cncplan::linuxcnc::test
