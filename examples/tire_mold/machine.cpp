#include "machine.hpp"

#include <fmt/format.h>

#include <numbers>

#include "support/failure.hpp"

namespace tire_mold {

namespace {

using namespace cncplan;

constexpr double degree = std::numbers::pi / 180.0;

// K17's travels, table speed and words of its control; the rest is a machine of that size.
support::Machine of_the_thesis() {
  const auto axis = [](char letter, double steps, double low, double high, const Limits& limits) {
    return support::MachineAxis{letter, {.steps_per_unit = steps, .high_time = 2e-6}, low, high, limits};
  };
  constexpr double infinite = std::numeric_limits<double>::infinity();
  support::Machine machine;
  machine.axes = {axis('R', 400.0, 0.0, 900.0, {100.0, 500.0, 5000.0}),
                  axis('Z', 400.0, 0.0, 600.0, {100.0, 500.0, 5000.0}),
                  axis('A', 200.0, -90.0, 90.0, {60.0, 300.0, 3000.0}),
                  axis('C', 1000.0, -infinite, infinite, {60.0, 300.0, 3000.0})};
  machine.dialect.axes = {{'R', gcode::AxisKind::linear},
                          {'Z', gcode::AxisKind::linear},
                          {'A', gcode::AxisKind::rotary},
                          {'C', gcode::AxisKind::rotary}};
  machine.dialect.pass_through = {{'G', 251.0}, {'G', 8.0}, {'G', 5.0}};
  return machine;
}

}  // namespace

double Machine::shown(std::size_t axis, double joint) const { return rotary[axis] ? joint / degree : joint; }

Machine machine_of(const std::optional<std::string>& file) {
  const support::Machine read = file ? support::read_machine(*file) : of_the_thesis();
  Machine machine;
  bool right = read.axes.size() == 4;
  for (std::size_t i = 0; i < 4 && right; ++i)
    right = (read.dialect.axes[i].kind == gcode::AxisKind::rotary) == machine.rotary[i];
  if (!right)
    throw support::Failure(
        support::Exit::bad_input,
        fmt::format(
            "{}:1:1: error: the axes must be a radial, a vertical (linear), a tilting and a table axis "
            "(rotary), in this order",
            *file));
  for (std::size_t i = 0; i < 4; ++i) {
    const support::MachineAxis& axis = read.axes[i];
    const double unit = machine.rotary[i] ? degree : 1.0;
    const auto k = static_cast<Eigen::Index>(i);
    machine.letters[i] = axis.letter;
    machine.limits.low[k] = axis.low * unit;
    machine.limits.high[k] = axis.high * unit;
    machine.limits.velocity[k] = axis.limits.velocity * unit;
    machine.limits.acceleration[k] = axis.limits.acceleration * unit;
    machine.limits.jerk[k] = axis.limits.jerk * unit;
    machine.steps_per_unit[i] = axis.drive.steps_per_unit / unit;
    machine.pulse_width[i] = axis.drive.high_time;
  }
  if (read.rapid_rate) machine.rapid_rate = *read.rapid_rate;
  machine.smallest_radius = read.smallest_radius.value_or(1.0);
  machine.artwork.pass_through = read.dialect.pass_through;
  return machine;
}

}  // namespace tire_mold
