// Where the axes stand, in work and in machine coordinates, and the offsets that lie between the two.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>

#include "cncplan/core/compiled.hpp"
#include "cncplan/gcode/dialect.hpp"
#include "cncplan/gcode/motion.hpp"

namespace cncplan::gcode {

/// Radians per degree, the unit of rotary axes in the text.
inline constexpr double radians_per_degree = std::numbers::pi / 180.0;

/// Coordinates of the axes that a line names, mm and rad.
using NamedCoordinates = std::array<std::optional<double>, max_axes>;

/// Machine coordinates are work coordinates and the sum of three offsets: of the work coordinate system, of
/// G92, and of the tool. A system may be rotated about Z, by what G10 L2 R says: work coordinates and the
/// offset of G92 are turned by it then (LinuxCNC: Coordinate Systems). The machine stays where it is when an
/// offset changes.
class WorkCoordinates {
 public:
  WorkCoordinates(const Dialect& dialect, const Position& machine)
      : count_(std::min<std::size_t>(dialect.axes.size(), max_axes)),
        machine_(machine),
        systems_(dialect.work_offsets) {
    for (std::size_t i = 0; i < count_; ++i) {
      kinds_[i] = dialect.axes[i].kind;
      if (dialect.axes[i].letter == 'Z') z_ = i;
    }
    offset_ = systems_[0];
    for (std::size_t i = 0; i < count_; ++i) current_[i] = machine_[i] - offset_[i];
  }

  /// Where the axes stand, in work coordinates.
  [[nodiscard]] const Position& current() const { return current_; }
  [[nodiscard]] const Position& machine() const { return machine_; }
  /// What takes work coordinates, turned by the rotation, to machine coordinates.
  [[nodiscard]] const Position& offset() const { return offset_; }
  /// Degrees of a system, and whether the one in force has any.
  [[nodiscard]] double rotation(std::size_t system) const { return turns_[system].degrees; }
  [[nodiscard]] bool rotated() const { return turn().degrees != 0.0; }
  /// A motion of work coordinates as the machine's axes lie.
  void rotate(Motion& motion) const;
  /// Where the axes would stand at machine coordinates, those of the others as they are.
  [[nodiscard]] Position at_machine(const NamedCoordinates& named) const;
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

  void arrive(const Position& end);

  /// G54 to G59.3, from 0.
  void select(std::size_t system) {
    system_ = system;
    update();
  }

  /// G10 L2 and, if `here`, L20: the origin of a system in machine coordinates, or such that the axes stand
  /// at the coordinates named. `number` 1 is G54, 0 the system in force. The first two axes are X and Y where
  /// a system is rotated, by R in degrees.
  void set_origin(int number, const NamedCoordinates& named, bool here, std::optional<double> rotation);

  /// G10 L10 and, if `fixture`, L11: the offset of a tool along an axis with which the axes stand at a
  /// coordinate, of the system in force or of G59.3 without G92; that is not rotated, or the axis is not X,
  /// Y.
  [[nodiscard]] double tool_for(std::size_t axis, double coordinate, bool fixture) const {
    const double shift = fixture ? 0.0 : shift_[axis];
    return machine_[axis] - systems_[fixture ? work_systems - 1 : system_][axis] - shift - coordinate;
  }

  /// G43 and its kin: the axes named get new lengths of the tool.
  void set_tool(const NamedCoordinates& named);

  /// G43.2 adds to them.
  void add_tool(const NamedCoordinates& named) {
    for (std::size_t i = 0; i < count_; ++i) tool_[i] += named[i].value_or(0.0);
    update();
  }

  /// Whether places are the tip's in the part. The tool's length is no offset then.
  [[nodiscard]] bool tool_point() const { return tool_point_; }
  /// mm.
  [[nodiscard]] double tool_length() const { return z_ < count_ ? tool_[z_] : 0.0; }
  /// Changes between the tip's places and those of the axes; the machine stays where it is.
  void set_tool_point(bool on, const ToolPointControl& control);

  /// G52: the shift of the axes named is this.
  void set_shift(const NamedCoordinates& named);
  /// G92: the present place gets the coordinates named.
  void shift_to(const NamedCoordinates& named);
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
  /// What G92.3 restores.
  [[nodiscard]] const Position& kept_shift() const { return kept_shift_; }

 private:
  /// A rotation about Z, of coordinates of X and Y.
  struct Turn {
    double degrees{}, cosine = 1.0, sine{};

    Turn() = default;
    explicit Turn(double angle)
        : degrees(angle),
          cosine(std::cos(angle * radians_per_degree)),
          sine(std::sin(angle * radians_per_degree)) {}
    void forth(double& x, double& y) const {
      const double along = x;
      x = cosine * along - sine * y;
      y = sine * along + cosine * y;
    }
    void back(double& x, double& y) const {
      const double along = x;
      x = cosine * along + sine * y;
      y = cosine * y - sine * along;
    }
  };

  [[nodiscard]] const Turn& turn() const { return turns_[system_]; }
  /// What the tool adds to work coordinates.
  [[nodiscard]] double tool_shift(std::size_t i) const { return tool_point_ && i == z_ ? 0.0 : tool_[i]; }
  [[nodiscard]] std::size_t index_of(int number) const {
    return number == 0 ? system_ : static_cast<std::size_t>(number - 1);
  }
  [[nodiscard]] Position turned(Position place) const {
    if (rotated()) turn().forth(place[0], place[1]);
    return place;
  }

  void update();

  /// What the change to an offset leaves of roundings.
  void blur(std::size_t i, double offset) {
    const double scale = std::abs(machine_[i]) + std::abs(offset_[i]) + std::abs(offset);
    rounding_[i] = std::max(rounding_[i], 8.0 * std::numeric_limits<double>::epsilon() * scale);
  }

  std::size_t count_;
  std::array<AxisKind, max_axes> kinds_{};
  Position current_{};
  Position machine_{};  ///< what stays when the offset changes
  Position offset_{};
  double angle_{};       ///< degrees of the rotation that `current_` has
  Position rounding_{};  ///< what changes of offset may have left; 0 without any
  Position shift_{};
  Position kept_shift_{};
  Position tool_{};
  std::array<Position, work_systems> systems_{};
  std::array<Turn, work_systems> turns_{};
  std::size_t system_{};
  std::size_t z_ = max_axes;  ///< which axis the tool's length is along
  bool tool_point_{};
};

}  // namespace cncplan::gcode

#ifndef CNCPLAN_COMPILED
#include "cncplan/gcode/work_coordinates-inl.hpp"
#endif
