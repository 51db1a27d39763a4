// The machine that a program runs on, as its TOML file says.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "cncplan/cncplan.hpp"

namespace simulate {

struct MachineAxis {
  char letter{};
  double steps_per_unit = 400.0;  ///< per mm or, for a rotary axis, per degree
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  cncplan::Limits limits{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                         std::numeric_limits<double>::infinity()};
  double pulse_width = 2e-6;  ///< s
};

struct Travel {
  char letter;
  double low;
  double high;
};

struct Machine {
  cncplan::gcode::Dialect dialect;
  std::vector<MachineAxis> axes{{.letter = 'X'}, {.letter = 'Y'}, {.letter = 'Z'}};
  std::optional<double> rapid_rate;  ///< mm/s
  double smallest_radius = 1.0;      ///< mm from a rotary table's axis; nothing nearer is driven

  [[nodiscard]] Travel travel(int axis) const {
    const MachineAxis& a = axes[static_cast<std::size_t>(axis)];
    return {a.letter, a.low, a.high};
  }

  /// The block's limits, lowered so that no axis breaks its own.
  [[nodiscard]] cncplan::Limits limits_along(const cncplan::plan::Block& block) const;
};

/// Reads the file of a machine with the axes X, Y, Z. Throws `Failure` for one that cannot be read or has an
/// unknown or wrong entry.
[[nodiscard]] Machine read_machine(const std::string& file);

/// The same for a machine with any axes.
[[nodiscard]] Machine read_machine_of_any_axes(const std::string& file);

}  // namespace simulate
