// Tool-point control: what a machine brings so that its programs can switch it on and off.
#pragma once

#include <optional>

#include "cncplan/core/vector.hpp"
#include "cncplan/gcode/motion.hpp"

namespace cncplan::gcode {

/// Where the coordinates of a program are those of the tool's tip in the part, and where those of the axes.
/// Places are machine coordinates in the order of the dialect's axes, mm and rad; lengths are the tool's, mm.
/// A machine without it has null pointers: G43.4 and its kin are not supported then.
struct ToolPointControl {
  const void* machine{};  ///< handed to the functions; it outlives the reader
  Position (*to_tip)(const void* machine, const Position& axes, double length){};
  Position (*to_axes)(const void* machine, const Position& tip, double length){};
  /// The place with the rotary axes that give a direction of the tool, those that are nearest; none where no
  /// position of theirs does.
  std::optional<Position> (*turned)(const void* machine, const Vector3& direction, const Position& from){};

  [[nodiscard]] bool possible() const { return to_tip != nullptr; }

  friend bool operator==(const ToolPointControl&, const ToolPointControl&) = default;
};

}  // namespace cncplan::gcode
