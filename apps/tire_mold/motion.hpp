// The artwork as motion of the four axes: planned within their limits, sampled and stepped.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "artwork.hpp"
#include "cncplan/cncplan.hpp"
#include "cncplan_tools/motor_signals.hpp"
#include "conversion.hpp"
#include "machine.hpp"
#include "options.hpp"

namespace tire_mold {

/// Without a block where there is nothing over the mold.
using Motion = cncplan::Trajectory<cncplan::Machine<4>, WallBlock>;
using Sample = Motion::SetPoint;
using Peaks = cncplan::BasicPeaks<double, 4>;

/// The artwork from its first point on as blocks of the machine, the table turned on by whole turns into its
/// travel where that is possible. Throws `Failure` for what cannot be mapped.
struct WallProgram {
  std::vector<WallBlock> blocks;
  TableTurns table;
};
[[nodiscard]] WallProgram wall_program(const Artwork& artwork, const cncplan::kinematics::Sidewall& sidewall,
                                       const Machine& machine, const Options& options);

/// Plans it. Throws `Failure`.
[[nodiscard]] Motion plan_motion(const WallProgram& program, const Artwork& artwork, const Machine& machine);

/// The point of the artwork at a set point: X, Y and Z, mm. Over a kink that of the kink.
[[nodiscard]] std::array<double, 3> flat_point(const Motion& motion, const Sample& sample);

/// Calls `take` with the set point at every period, and at the end.
void make_samples(const Motion& motion, double period, const std::function<void(const Sample&)>& take);

/// What each axis has done, in steps.
using StepReports = std::array<cncplan::step::AxisReport, 4>;

/// Calls `take` with every signal of the motors, in order of time. Throws `Failure` for a plan that breaks a
/// rule of a drive.
StepReports make_steps(const Motion& motion, const cncplan::tools::MotorSignals& signals,
                       const Artwork& artwork, double period,
                       const std::function<void(const cncplan::step::Edge&)>& take);

}  // namespace tire_mold
