// A machine, as its TOML file says.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <tl/expected.hpp>

#include "cncplan/core/error.hpp"
#include "cncplan/core/error_text.hpp"
#include "cncplan/core/limits.hpp"
#include "cncplan/gcode/dialect.hpp"
#include "cncplan/kinematics/ready_made.hpp"
#include "cncplan/machine.hpp"
#include "cncplan/orientation.hpp"
#include "cncplan/step/drive.hpp"

namespace cncplan::tools {

/// The other motor of an axis that two drive: it makes the steps of the first.
struct SecondMotor {
  bool inverted = false;
  double offset = 0.0;  ///< mm or degrees that it goes by itself, at the start, to square the two up
};

/// Lengths in mm, angles in degrees; so `drive` counts per mm or per degree. An inverted one steps backwards
/// where its axis goes forward.
struct MachineAxis {
  char letter{};
  step::Drive drive{.steps_per_unit = 400.0, .high_time = 2e-6};
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  Limits limits{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
                std::numeric_limits<double>::infinity()};
  bool rotary = false;
  std::optional<SecondMotor> second{};

  /// Of positions as they are shown: 1 mm, or a degree in rad.
  [[nodiscard]] double unit() const { return rotary ? std::numbers::pi / 180.0 : 1.0; }
};

/// Says that an axis would leave its travel, or stands outside it before it moves; its place in mm or rad.
[[nodiscard]] std::string beyond_travel(const MachineAxis& axis, double place, bool at_start = false);

/// What moves the tool.
enum class Kinematics {
  cartesian,  ///< X, Y and maybe Z
  tire_mold,  ///< radial and vertical slide, tilting spindle, rotary table; programs name these axes
  polar,      ///< radial and vertical slide, rotary table; programs name X, Y, Z
  mapped,     ///< what `map` says
};

/// A ready-made machine of the library's (docs/kinematics.md).
struct MapEntry {
  std::string name;  ///< as in the file: "table-table-ac"
  kinematics::ReadyMadeMap map;
  std::vector<double> start;  ///< of each joint, mm or rad
  Orientation orientation{};  ///< along lines of tool-point control

  /// Whether its programs can name the tip and the tool's angles.
  [[nodiscard]] bool has_tool_point_control() const {
    return std::holds_alternative<kinematics::FiveAxes>(map);
  }
};

struct MachineFile {
  double unit = 1.0;  ///< mm, the unit of the file's lengths
  gcode::Dialect dialect;
  std::vector<MachineAxis> axes{{.letter = 'X'}, {.letter = 'Y'}, {.letter = 'Z'}};
  Kinematics kinematics = Kinematics::cartesian;
  MapEntry map;
  std::optional<double> rapid_rate;                             ///< mm/s
  double feed_limit = std::numeric_limits<double>::infinity();  ///< mm/s
  std::optional<double> smallest_radius;  ///< mm from a rotary table's axis; nothing nearer is driven
  std::array<double, 2> table_center{};   ///< X, Y of a polar machine's table axis, mm

  /// mm from the table's axis of a polar machine: nothing nearer is driven; 0 for others.
  [[nodiscard]] double least_radius() const {
    return kinematics == Kinematics::polar ? smallest_radius.value_or(1.0) : 0.0;
  }
  /// An axis' position, speed ... in mm or degrees.
  [[nodiscard]] double shown(std::size_t axis, double joint) const { return joint / axes[axis].unit(); }

  /// An axis of the library, with its motors; mm, rad, s.
  [[nodiscard]] Axis axis(std::size_t i) const;
};

/// A machine whose programs name X, Y, Z over a rotary table (`polar`) as one behind a map (`mapped`), at X0
/// Y0 Z0, whose slide keeps the `least_radius`. Others as they are.
[[nodiscard]] MachineFile with_table_map(MachineFile machine);

/// Reads a machine file. The error, of one that cannot be read or has an unknown or wrong entry, is a line as
/// programs print it: "mill.toml:3:1: error: ...".
[[nodiscard]] tl::expected<MachineFile, std::string> read_machine(const std::string& file);
/// The same of a text; `name` stands for the file in messages.
[[nodiscard]] tl::expected<MachineFile, std::string> parse_machine(const std::string& text,
                                                                   const std::string& name);

/// The axes of a file as those of a machine, from the first one on, under limits of the tool (mm, s). X, Y
/// and Z that are not in the file cannot move; other axes that are not there have no words. The file has no
/// more axes than the machine.
template <MachineModel M>
[[nodiscard]] M with_axes(M machine, const MachineFile& file, const Limits& limits) {
  machine.limits = limits;
  machine.rapid_rate = file.rapid_rate.value_or(0.0);
  if (std::isfinite(file.feed_limit)) machine.feed_limit = file.feed_limit;
  for (std::size_t i = 0; i < machine.axes.size(); ++i)
    if (i < file.axes.size())
      machine.axes[i] = file.axis(i);
    else
      machine.axes[i] = i < 3 ? Axis{.letter = "XYZ"[i], .low = 0.0, .high = 0.0} : Axis{};
  return machine;
}

/// Nothing, or above_limit where a file has more axes than there are places for.
[[nodiscard]] inline Expected<void> fits(const MachineFile& file, int most) {
  const auto count = static_cast<int>(file.axes.size());
  if (count <= most) return {};
  return refusal(ErrorCode::above_limit, "axes of the machine's file", static_cast<double>(count),
                 static_cast<double>(most));
}

/// The machine of N axes of a file, under limits of the tool (mm, s). Error: a sentence, for a file whose
/// axes are not the coordinates of programs (`kinematics`, a rotary table), or are more than N.
template <int N>
[[nodiscard]] tl::expected<Machine<N>, std::string> machine_of(const MachineFile& file,
                                                               const Limits& limits) {
  if (file.kinematics != Kinematics::cartesian)
    return tl::unexpected<std::string>("the axes of the machine are not the coordinates of its programs");
  if (const auto ok = fits(file, N); !ok) return tl::unexpected(to_text(ok.error()));
  return with_axes(Machine<N>{}, file, limits);
}

}  // namespace cncplan::tools
