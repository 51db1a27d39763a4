// A machine, as its TOML file says.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "cncplan/cncplan.hpp"

namespace support {

/// Lengths in mm, angles in degrees; so `drive` counts per mm or per degree.
struct MachineAxis {
  char letter{};
  cncplan::step::Drive drive{.steps_per_unit = 400.0, .high_time = 2e-6};
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  cncplan::Limits limits{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                         std::numeric_limits<double>::infinity()};
};

struct Machine {
  double unit = 1.0;  ///< mm, the unit of the file's lengths
  cncplan::gcode::Dialect dialect;
  std::vector<MachineAxis> axes{{.letter = 'X'}, {.letter = 'Y'}, {.letter = 'Z'}};
  std::optional<double> rapid_rate;                             ///< mm/s
  double feed_limit = std::numeric_limits<double>::infinity();  ///< mm/s
  std::optional<double> smallest_radius;  ///< mm from a rotary table's axis; nothing nearer is driven
};

/// Reads a machine file. Throws `Failure` for one that cannot be read or has an unknown or wrong entry.
[[nodiscard]] Machine read_machine(const std::string& file);

}  // namespace support
