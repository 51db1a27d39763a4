#include "cncplan_tools/motor_signals.hpp"

#include <cmath>

#include "cncplan/profile/seven_phase.hpp"

namespace cncplan::tools {

MotorSignals::MotorSignals(const MachineFile& machine) {
  for (const MachineAxis& axis : machine.axes) {
    add(axis, "", axis.drive.inverted);
    if (!axis.second) continue;
    add(axis, "2", axis.second->inverted);
    square_up(axis);
  }
}

void MotorSignals::add(const MachineAxis& axis, const char* name, bool inverted) {
  traces_.push_back({axis.letter + std::string(name), axis.drive.high_time, axis.drive.direction_setup});
  inverted_.push_back(inverted);
}

// The motor added last, by itself and from rest to rest within the limits of its axis.
void MotorSignals::square_up(const MachineAxis& axis) {
  const double offset = axis.second->offset, scale = axis.drive.steps_per_unit;
  const auto steps = step::count_at(std::abs(offset) * scale);
  if (steps == 0) return;
  const auto way = profile::seven_phase(static_cast<double>(steps) / scale, {}, axis.limits).value();
  const int direction = (offset > 0.0) != inverted_.back() ? 1 : -1;
  for (std::int64_t k = 0; k < steps; ++k)
    squaring_.push_back({since_ + way.time_at((static_cast<double>(k) + 0.5) / scale),
                         static_cast<int>(traces_.size()) - 1, direction});
  since_ += way.duration();
}

}  // namespace cncplan::tools
