// A planned program, whatever its machine: what is asked of it from plan to pulses.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "cncplan/core/error.hpp"
#include "cncplan/core/limits.hpp"
#include "cncplan/core/state.hpp"
#include "cncplan/core/vector.hpp"
#include "cncplan/motor_edge.hpp"
#include "cncplan/step/backend.hpp"
#include "cncplan/step/drive.hpp"
#include "cncplan_tools/detail/driven.hpp"
#include "per_axis.hpp"
#include "support/report.hpp"

namespace simulate {

/// Where everything is at an instant; mm, rad and s.
struct SetPoint {
  double time{};
  std::size_t block{}, piece{};
  cncplan::Vector3 tool = cncplan::Vector3::Zero();
  PerAxis position, velocity, acceleration;  ///< of the axes
  cncplan::State along;
};

/// The most that a plan asks for.
struct PlanPeaks {
  PerAxis velocity, acceleration, jerk;  ///< of the axes, inside blocks
  PerAxis corner_velocity_step;          ///< of the axes, at junctions
  cncplan::Limits tool, along;
  std::size_t acceleration_jumps{};  ///< junctions
};

/// Speeds of a block, and s from when it first moves to when it last does.
struct BlockTiming {
  std::size_t block{};
  double entry{}, peak{}, exit{};
  double duration{};
};

/// Its template parameter stays behind this: what is made of a plan is compiled once.
class Planned : public report::Driven {
 public:
  [[nodiscard]] virtual bool completed() const = 0;
  [[nodiscard]] virtual PlanPeaks peaks() const = 0;
  [[nodiscard]] virtual std::vector<BlockTiming> timings() const = 0;
  [[nodiscard]] virtual std::size_t block_count() const = 0;
  /// mm from the program's start to a block's.
  [[nodiscard]] virtual double block_start(std::size_t block) const = 0;
  /// How far each axis is at a block's end from where it was at its start.
  [[nodiscard]] virtual PerAxis way(std::size_t block) const = 0;
  /// The block that a piece is part of.
  [[nodiscard]] virtual std::size_t block_of(std::size_t piece) const = 0;
  /// Whether a piece is driven as it was programmed, not smoothed and no part of a merged line.
  [[nodiscard]] virtual bool as_programmed(std::size_t piece) const = 0;
  /// When so much of a piece has been travelled, where the tool is, or X Y Z of the axes where the program
  /// drives these.
  [[nodiscard]] virtual cncplan::Vector3 driven_point(std::size_t piece, double s) const = 0;
  /// Hands all set points at k period, and one at the end, to `take`.
  virtual void sample(double period, const std::function<void(const SetPoint&)>& take) const = 0;
  /// Hands every step edge to `take`, and holds them against the rules of the drives; see
  /// `cncplan::follow_steps`.
  [[nodiscard]] virtual cncplan::Expected<std::vector<cncplan::step::AxisReport>, cncplan::step::Violation>
  step(double period, const std::function<void(const cncplan::MotorEdge&)>& take) const = 0;
};

}  // namespace simulate
