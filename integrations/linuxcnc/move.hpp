// SPDX-License-Identifier: GPL-2.0-or-later
// One move as LinuxCNC hands it over, with all that was said before it, in the machine's units.
#pragma once

#include <cstdint>

#include "coordinates.hpp"

namespace cncplan::linuxcnc {

enum class Shape : std::uint8_t { line, circle, rigid_tap };

struct Move {
  Shape shape = Shape::line;
  bool by_linuxcnc{};  ///< run by LinuxCNC's own planner
  bool pure_rotary{};  ///< only A B C move: velocities are of angles
  EmcPose start{};
  EmcPose end{};
  PmCartesian center{};  ///< of a circle
  PmCartesian normal{};  ///< of a circle
  int turn{};            ///< of a circle: whole turns; below 0 clockwise about the normal, -1 - turn of them
  double scale{};        ///< of a rigid tap: the spindle's speed on the way out by that on the way in
  double velocity{};     ///< asked for
  double most_velocity{};
  double acceleration{};
  double jerk{};  ///< of LinuxCNC 2.10, for its own planner
  double tolerance{};
  double per_revolution{};  ///< of the spindle
  double length{};          ///< as the library counts it; mm, or rad
  double begins_at{};       ///< length of its part before it
  int id{};
  int motion_type{};
  int end_condition{};
  int synchronized{};  ///< with the spindle: TC_SYNC_...
  int spindle{};
  int indexer = -1;          ///< joint to unlock
  unsigned char enables{};   ///< FS_ENABLED and others
  bool waits_for_spindle{};  ///< until it is at speed
  struct state_tag_t tag {};
  syncdio_t outputs{};  ///< to switch where it begins

  /// Begins at rest, whatever comes before it.
  [[nodiscard]] bool begins_part() const { return waits_for_spindle; }
};

}  // namespace cncplan::linuxcnc
