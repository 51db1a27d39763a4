// Definitions of work_coordinates.hpp.
#pragma once

#include "cncplan/gcode/work_coordinates.hpp"

namespace cncplan::gcode {

CNCPLAN_INLINE void WorkCoordinates::rotate(Motion& motion) const {
  if (!rotated()) return;
  turn().forth(motion.start[0], motion.start[1]);
  turn().forth(motion.end[0], motion.end[1]);
  turn().forth(motion.center[0], motion.center[1]);
  for (SplineControl& control : motion.controls) turn().forth(control.first, control.second);
}

CNCPLAN_INLINE Position WorkCoordinates::at_machine(const NamedCoordinates& named) const {
  Position place = current_;
  if (rotated() && (named[0] || named[1])) {
    for (std::size_t i = 0; i < 2; ++i) place[i] = named[i].value_or(machine_[i]) - offset_[i];
    turn().back(place[0], place[1]);
    for (std::size_t i = 0; i < 2; ++i) place[i] = meet(i, place[i]);
  }
  for (std::size_t i = rotated() ? 2 : 0; i < count_; ++i)
    if (named[i]) place[i] = meet(i, *named[i] - offset_[i]);
  return place;
}

CNCPLAN_INLINE void WorkCoordinates::arrive(const Position& end) {
  current_ = end;
  const Position turned = this->turned(end);
  for (std::size_t i = 0; i < count_; ++i) machine_[i] = turned[i] + offset_[i];
}

CNCPLAN_INLINE void WorkCoordinates::set_origin(int number, const NamedCoordinates& named, bool here,
                                                std::optional<double> rotation) {
  const std::size_t system = index_of(number);
  Position& origin = systems_[system];
  Turn& turn = turns_[system];
  if (here && turn.degrees != 0.0) {
    const auto at = [&](std::size_t i) { return machine_[i] - origin[i] - tool_shift(i); };
    double x = at(0), y = at(1);
    turn.back(x, y);
    if (named[0]) x = *named[0] + shift_[0];
    if (named[1]) y = *named[1] + shift_[1];
    turn.forth(x, y);
    origin[0] = machine_[0] - tool_shift(0) - x;
    origin[1] = machine_[1] - tool_shift(1) - y;
  }
  for (std::size_t i = here && turn.degrees != 0.0 ? 2 : 0; i < count_; ++i)
    if (named[i]) origin[i] = here ? machine_[i] - shift_[i] - tool_shift(i) - *named[i] : *named[i];
  if (rotation) turn = Turn(*rotation);
  update();
}

CNCPLAN_INLINE void WorkCoordinates::set_tool(const NamedCoordinates& named) {
  for (std::size_t i = 0; i < count_; ++i)
    if (named[i]) tool_[i] = *named[i];
  update();
}

CNCPLAN_INLINE void WorkCoordinates::set_tool_point(bool on, const ToolPointControl& control) {
  if (on == tool_point_) return;
  tool_point_ = on;
  update();
  machine_ = (on ? control.to_tip : control.to_axes)(control.machine, machine_, tool_length());
  constexpr double roundings = 64.0;  // of the machine's formula
  for (std::size_t i = 0; i < count_; ++i) {
    blur(i, roundings * offset_[i] + roundings * machine_[i]);
    current_[i] = machine_[i] - offset_[i];
  }
  if (rotated()) turn().back(current_[0], current_[1]);
}

CNCPLAN_INLINE void WorkCoordinates::set_shift(const NamedCoordinates& named) {
  for (std::size_t i = 0; i < count_; ++i)
    if (named[i]) shift_[i] = *named[i];
  kept_shift_ = shift_;
  update();
}

CNCPLAN_INLINE void WorkCoordinates::shift_to(const NamedCoordinates& named) {
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

CNCPLAN_INLINE void WorkCoordinates::update() {
  const Position shift = turned(shift_);
  bool moved = false;
  for (std::size_t i = 0; i < count_; ++i) {
    const double offset = nameable(i, systems_[system_][i] + shift[i] + tool_shift(i));
    if (offset == offset_[i]) continue;
    moved = true;
    blur(i, offset);
    current_[i] = machine_[i] - offset;
    offset_[i] = offset;
  }
  const double angle = turn().degrees;
  if (angle == angle_ && (angle == 0.0 || !moved)) return;
  angle_ = angle;
  for (std::size_t i = 0; i < 2; ++i) {
    blur(i, offset_[i]);
    current_[i] = machine_[i] - offset_[i];
  }
  turn().back(current_[0], current_[1]);
}

}  // namespace cncplan::gcode
