// Where the axes stand, in work and in machine coordinates, and the offsets that lie between the two.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>

#include "cncplan/gcode/dialect.hpp"
#include "cncplan/gcode/motion.hpp"

namespace cncplan::gcode {

/// Radians per degree, the unit of rotary axes in the text.
inline constexpr double radians_per_degree = std::numbers::pi / 180.0;

/// Coordinates of the axes that a line names, mm and rad.
using NamedCoordinates = std::array<std::optional<double>, max_axes>;

/// Machine coordinates are work coordinates and the sum of three offsets: of the work coordinate system, of
/// G92, and of the tool. The machine stays where it is when an offset changes.
class WorkCoordinates {
 public:
  WorkCoordinates(const Dialect& dialect, const Position& machine)
      : count_(std::min<std::size_t>(dialect.axes.size(), max_axes)),
        machine_(machine),
        systems_(dialect.work_offsets) {
    for (std::size_t i = 0; i < count_; ++i) kinds_[i] = dialect.axes[i].kind;
    offset_ = systems_[0];
    for (std::size_t i = 0; i < count_; ++i) current_[i] = machine_[i] - offset_[i];
  }

  /// Where the axes stand, in work coordinates.
  [[nodiscard]] const Position& current() const { return current_; }
  [[nodiscard]] const Position& machine() const { return machine_; }
  /// What takes work to machine coordinates.
  [[nodiscard]] const Position& offset() const { return offset_; }
  /// What G92 has shifted, and what is in force of it.
  [[nodiscard]] const Position& shift() const { return shift_; }
  [[nodiscard]] const Position& tool() const { return tool_; }
  /// Index of the system in force: 0 for G54.
  [[nodiscard]] std::size_t system() const { return system_; }
  [[nodiscard]] const Position& origin(std::size_t system) const { return systems_[system]; }

  /// A coordinate that some word names: the radians of a rotary axis are those of a number of degrees, sums
  /// too, so that whatever was read can be written again.
  [[nodiscard]] double nameable(std::size_t axis, double coordinate) const {
    return kinds_[axis] == AxisKind::linear ? coordinate
                                            : coordinate / radians_per_degree * radians_per_degree;
  }

  /// An axis of a target. Nearer than the roundings that changes of offset have left is where the axis
  /// already is: no motion, and the full circle that was meant.
  [[nodiscard]] double meet(std::size_t axis, double coordinate) const {
    const double target = nameable(axis, coordinate);
    return std::abs(target - current_[axis]) <= rounding_[axis] ? current_[axis] : target;
  }

  void arrive(const Position& end) {
    current_ = end;
    for (std::size_t i = 0; i < count_; ++i) machine_[i] = end[i] + offset_[i];
  }

  /// G54 to G59.3, from 0.
  void select(std::size_t system) {
    system_ = system;
    update();
  }

  /// G10 L2 and, if `here`, L20: the origin of a system in machine coordinates, or such that the axes stand
  /// at the coordinates named. `number` 1 is G54, 0 the system in force.
  void set_origin(int number, const NamedCoordinates& named, bool here) {
    Position& origin = systems_[number == 0 ? system_ : static_cast<std::size_t>(number - 1)];
    for (std::size_t i = 0; i < count_; ++i)
      if (named[i]) origin[i] = here ? machine_[i] - shift_[i] - tool_[i] - *named[i] : *named[i];
    update();
  }

  /// G43 and its kin: the axes named get new lengths of the tool.
  void set_tool(const NamedCoordinates& named) {
    for (std::size_t i = 0; i < count_; ++i)
      if (named[i]) tool_[i] = *named[i];
    update();
  }

  /// G92: the present place gets the coordinates named.
  void shift_to(const NamedCoordinates& named) {
    Position to = current_;
    for (std::size_t i = 0; i < count_; ++i)
      if (named[i]) {
        shift_[i] += current_[i] - *named[i];
        to[i] = *named[i];
      }
    kept_shift_ = shift_;
    update();
    current_ = to;  // to the last bit
  }
  /// G92.1 forgets the shift, G92.2 suspends it, G92.3 restores it.
  void forget_shift() {
    kept_shift_ = {};
    suspend_shift();
  }
  void suspend_shift() {
    shift_ = {};
    update();
  }
  void restore_shift() {
    shift_ = kept_shift_;
    update();
  }

 private:
  void update() {
    for (std::size_t i = 0; i < count_; ++i) {
      const double offset = nameable(i, systems_[system_][i] + shift_[i] + tool_[i]);
      if (offset == offset_[i]) continue;
      const double scale = std::abs(machine_[i]) + std::abs(offset_[i]) + std::abs(offset);
      rounding_[i] = std::max(rounding_[i], 8.0 * std::numeric_limits<double>::epsilon() * scale);
      current_[i] = machine_[i] - offset;
      offset_[i] = offset;
    }
  }

  std::size_t count_;
  std::array<AxisKind, max_axes> kinds_{};
  Position current_{};
  Position machine_{};  ///< what stays when the offset changes
  Position offset_{};
  Position rounding_{};  ///< what changes of offset may have left; 0 without any
  Position shift_{};
  Position kept_shift_{};
  Position tool_{};
  std::array<Position, work_systems> systems_{};
  std::size_t system_{};
};

}  // namespace cncplan::gcode
