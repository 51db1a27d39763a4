// A program planned, sampled and stepped, and what was measured on the way.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "cncplan/cncplan.hpp"
#include "machine.hpp"
#include "options.hpp"
#include "program.hpp"
#include "route.hpp"
#include "support/plan.hpp"
#include "support/stepping.hpp"

namespace simulate {

using support::Plan;

/// One value for each axis of the route; without heap.
using PerAxis = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, cncplan::gcode::max_axes, 1>;

/// One row of the samples. Axes in mm and rad.
struct Sample {
  double time{};
  std::size_t block{};        ///< of the program
  cncplan::Vector3 position;  ///< of the tool, machine coordinates
  PerAxis axes;
  PerAxis velocity;
  PerAxis acceleration;
  cncplan::State along;
};

/// What the summary reports. Axes in mm and degrees.
struct Measures {
  std::size_t samples = 0;
  cncplan::State peak;
  PerAxis axis_velocity;
  PerAxis axis_acceleration;
  PerAxis axis_jerk;
  double corner_velocity_step = 0.0;
  double end_error = 0.0;
  double contour_error = 0.0;
  std::size_t junctions_limited = 0;
  support::StepReports steps;  ///< none where no steps are made
  double plan_seconds = 0.0;
  double interpolate_seconds = 0.0;
  double steps_seconds = 0.0;
};

/// Each of these is there for the paths of route.hpp.
template <class P>
[[nodiscard]] Plan make_plan(const Program& program, const Route<P>& route, const Options& options,
                             const Machine& machine, Measures& measures);

/// Slows pieces and junctions where an axis with backlash turns round, so that its drive has the time to make
/// up for it.
template <class P>
void slow_reversals(const Route<P>& route, const Machine& machine,
                    std::vector<cncplan::plan::BlockCaps>& caps);

/// Calls `take` with every sample, in order.
template <class P>
void make_samples(const Program& program, const Route<P>& route, const Plan& plan, const Options& options,
                  Measures& measures, const std::function<void(const Sample&)>& take);

/// Measures what the exact path asks of the axes.
template <class P>
void measure_axes(const Route<P>& route, const Plan& plan, const Machine& machine, Measures& measures);

/// Turns the plan into edges at their exact times, hands them to `take` in order, and holds the stepped
/// positions against the planned ones at every period.
template <class P>
void make_steps(const Program& program, const Route<P>& route, const Plan& plan, const Options& options,
                const Machine& machine, Measures& measures,
                const std::function<void(const cncplan::step::Edge&)>& take);

}  // namespace simulate
