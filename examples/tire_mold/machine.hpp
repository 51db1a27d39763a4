// The 4-axis machine: what its file says, in the units of the library.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "support/machine_file.hpp"

namespace tire_mold {

/// Axes in the order of the joints R, Z, A, C.
struct Machine {
  std::array<char, 4> letters{'R', 'Z', 'A', 'C'};
  std::array<bool, 4> rotary{false, false, true, true};
  cncplan::BasicJointLimits<double, 4> limits;  ///< mm, rad, s
  std::array<double, 4> steps_per_unit{};       ///< per mm and per rad
  std::array<double, 4> pulse_width{};          ///< s
  double rapid_rate = 1000.0;                   ///< mm/s of the tool's tip
  double smallest_radius = 1.0;                 ///< mm
  cncplan::gcode::Dialect artwork;              ///< X, Y, Z, and the words that pass through

  /// In mm or degrees.
  [[nodiscard]] double shown(std::size_t axis, double joint) const;
};

/// Reads a machine file, or gives the machine of the thesis. Throws `Failure`.
[[nodiscard]] Machine machine_of(const std::optional<std::string>& file);

}  // namespace tire_mold
