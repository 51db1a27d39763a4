// A program planned, sampled and stepped, and what was measured on the way.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

#include "cncplan/cncplan.hpp"
#include "machine.hpp"
#include "options.hpp"
#include "program.hpp"

namespace simulate {

/// The planned program.
struct Plan {
  std::vector<double> lengths;  ///< of each block
  std::vector<cncplan::plan::BlockCaps> caps;
  std::vector<cncplan::plan::Span> spans;
  std::vector<cncplan::plan::BlockTiming> timings;
  double duration = 0.0;
  double length = 0.0;
};

/// One row of the samples.
struct Sample {
  double time{};
  std::size_t block{};
  cncplan::Vector3 position;  ///< machine coordinates
  cncplan::State along;
};

/// What the summary reports.
struct Measures {
  std::size_t samples = 0;
  cncplan::State peak;
  cncplan::Vector3 axis_velocity = cncplan::Vector3::Zero();
  cncplan::Vector3 axis_acceleration = cncplan::Vector3::Zero();
  double corner_velocity_step = 0.0;
  double end_error = 0.0;
  double contour_error = 0.0;
  std::size_t junctions_limited = 0;
  std::array<cncplan::step::AxisReport, 3> steps{};
  double plan_seconds = 0.0;
  double interpolate_seconds = 0.0;
  double steps_seconds = 0.0;
};

[[nodiscard]] Plan make_plan(const Program& program, const Options& options, Measures& measures);

/// Calls `take` with every sample, in order.
void make_samples(const Program& program, const Plan& plan, const Options& options, Measures& measures,
                  const std::function<void(const Sample&)>& take);

/// Measures what the exact path asks of the axes.
void measure_axes(const Program& program, const Plan& plan, Measures& measures);

/// Turns the plan into edges at their exact times, hands them to `take` in order, and holds the stepped
/// positions against the planned ones at every period.
void make_steps(const Program& program, const Plan& plan, const Options& options, const Machine& machine,
                Measures& measures, const std::function<void(const cncplan::step::Edge&)>& take);

}  // namespace simulate
