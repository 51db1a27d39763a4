// The step signals of a machine's motors.
#pragma once

#include <span>
#include <vector>

#include "cncplan/motor_edge.hpp"
#include "cncplan/step/edge.hpp"
#include "cncplan/step/vcd.hpp"
#include "cncplan_tools/machine_file.hpp"

namespace cncplan::tools {

/// Steps of a plan as signals of motors, one trace a motor. An inverted motor steps backwards where its axis
/// goes forward. Where an axis' second motor is to be squared up, its steps come before all others, and the
/// plan's are later by the time that this takes.
class MotorSignals {
 public:
  explicit MotorSignals(const MachineFile& machine);

  /// "Y", and "Y2" for the second motor of Y.
  [[nodiscard]] const std::vector<step::Trace>& traces() const { return traces_; }
  /// The steps that square up, in order of time.
  [[nodiscard]] std::span<const step::Edge> squaring() const { return squaring_; }
  /// A step of the plan; the axis of a signal is the number of its motor.
  [[nodiscard]] step::Edge signal(const MotorEdge& edge) const {
    return {since_ + edge.time, static_cast<int>(edge.motor),
            inverted_[edge.motor] ? -edge.direction : edge.direction};
  }

 private:
  void add(const MachineAxis& axis, const char* name, bool inverted);
  void square_up(const MachineAxis& axis);

  std::vector<step::Trace> traces_;
  std::vector<bool> inverted_;
  std::vector<step::Edge> squaring_;
  double since_ = 0.0;  // s that squaring up takes
};

}  // namespace cncplan::tools
