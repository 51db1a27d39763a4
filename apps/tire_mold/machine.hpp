// The four-axis machine that runs the program.
#pragma once

#include <optional>
#include <string>

#include "cncplan/machine.hpp"
#include "support/machine_file.hpp"

namespace tire_mold {

using support::Machine;

/// The fastest that the tool's tip goes, mm/s.
[[nodiscard]] double rapid_rate(const Machine& machine);
/// Nothing nearer to the table's axis is driven, mm.
[[nodiscard]] double smallest_radius(const Machine& machine);

/// The machine as the library plans it: its axes, and the tip no faster than the rapid rate.
[[nodiscard]] cncplan::Machine<4> planned_machine(const Machine& machine);

/// Flat programs name X, Y and Z, and the words that pass through.
[[nodiscard]] cncplan::gcode::Dialect artwork_dialect(const Machine& machine);

/// Reads a machine file, or gives the machine of the thesis. Throws `Failure`.
[[nodiscard]] Machine machine_of(const std::optional<std::string>& file);

}  // namespace tire_mold
