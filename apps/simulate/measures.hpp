// What a run shows: samples, and what the summary reports.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "cncplan/fallback.hpp"
#include "cncplan/step/backend.hpp"
#include "per_axis.hpp"
#include "planned.hpp"
#include "program.hpp"

namespace simulate {

/// One row of the samples.
struct Sample : SetPoint {
  const Origin* motion{};
  double within{};  ///< mm from the motion's start
};

/// Speeds of a motion, and s from when it first moves to when it last does.
struct MotionTiming {
  double entry{};
  double peak{};
  double exit{};
  double duration{};
};

/// Axes in mm and degrees.
struct Measures {
  double duration = 0.0;
  double length = 0.0;
  bool completed = true;
  std::vector<MotionTiming> motions;
  PerAxis travel;           ///< way of each axis, between the ends of blocks
  std::size_t samples = 0;  ///< none where none are made
  PlanPeaks peaks;
  double end_error = 0.0;      ///< of the last sample from the program's end
  double contour_error = 0.0;  ///< of samples from the programmed path, where that is driven
  double deviation = 0.0;      ///< of smoothed paths from the programmed ones
  std::optional<std::size_t> junctions_limited{};
  std::vector<cncplan::Fallback> fallbacks;      ///< lines of the program
  std::vector<cncplan::step::AxisReport> steps;  ///< none where no steps are made
  double plan_seconds = 0.0;
  double measure_seconds = 0.0;
  double interpolate_seconds = 0.0;
  double steps_seconds = 0.0;
};

}  // namespace simulate
