#include "machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "support/failure.hpp"

namespace simulate {

using namespace cncplan;
using support::Exit;
using support::Failure;

Travel travel(const Machine& machine, int axis) {
  const auto i = static_cast<std::size_t>(axis);
  if (i >= machine.axes.size()) return {"XYZ"[axis], 0.0, 0.0};
  return {machine.axes[i].letter, machine.axes[i].low, machine.axes[i].high};
}

Limits limits_along(const Machine& machine, const plan::Block& block) {
  Limits limits = block.limits;
  const bool curved = block.segment.arc() != nullptr;
  // On an arc both the acceleration along the path and the one across it stay below this; at right angles to
  // each other, they add up to the axis' limit at most.
  const double shared = curved ? std::sqrt(2.0) : 1.0;
  const auto box = block.segment.bounds();
  for (int i = 0; i < static_cast<int>(machine.axes.size()); ++i) {
    const double share = curved ? 1.0 : std::abs(block.segment.start_tangent()[i]);
    if (box.low[i] == box.high[i] || share == 0.0) continue;
    const Limits& axis = machine.axes[static_cast<std::size_t>(i)].limits;
    limits.velocity = std::min(limits.velocity, axis.velocity / share);
    limits.acceleration = std::min(limits.acceleration, axis.acceleration / (share * shared));
    limits.jerk = std::min(limits.jerk, axis.jerk / share);
  }
  return limits;
}

Machine read_mill(const std::string& file) {
  Machine machine = support::read_machine(file);
  if (machine.smallest_radius)
    throw Failure(Exit::bad_input,
                  fmt::format("{}:1:1: error: smallest_radius is for machines with a rotary table", file));
  std::string letters;
  bool linear = true;
  for (const gcode::Axis& axis : machine.dialect.axes) {
    letters += axis.letter;
    linear = linear && axis.kind == gcode::AxisKind::linear;
  }
  if (letters != "XY" && letters != "XYZ")
    throw Failure(Exit::bad_input,
                  fmt::format("{}:1:1: error: the axes must be X, Y, Z, in this order, or X, Y", file));
  if (!linear)
    throw Failure(Exit::bad_input, fmt::format("{}:1:1: error: the axes X, Y, Z must be linear", file));
  // The language has a Z whatever the machine; where it lacks one, the travel of Z is none.
  if (letters == "XY") machine.dialect.axes.push_back({'Z', gcode::AxisKind::linear});
  return machine;
}

}  // namespace simulate
