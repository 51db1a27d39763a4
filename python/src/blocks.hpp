// Blocks that Python made by hand, for machines with any number of axes.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "cncplan/core/plane.hpp"
#include "cncplan/core/vector.hpp"
#include "cncplan/gcode/motion.hpp"

namespace cncplan::python {

enum class BlockKind { line, arc_center, arc_radius, spline };

/// Positions are mm and rad, in the order of the machine's axes; 0 beyond the last one.
struct AnyBlock {
  BlockKind kind = BlockKind::line;
  std::size_t axes{};  ///< that the positions have
  gcode::Position start{};
  gcode::Position end{};
  Vector3 center = Vector3::Zero();
  double radius{};
  Turn turn{};
  Plane plane{};
  int extra_turns{};
  std::array<Vector3, 2> controls{};  ///< of a spline, between start and end
  double feed = std::numeric_limits<double>::infinity();
  double pause{};
  bool exact_stop{};
  bool rapid{};
  std::optional<double> tolerance{};
  int line{};
};

}  // namespace cncplan::python
