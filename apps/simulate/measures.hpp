// What a run shows: samples, and what the summary reports.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "cncplan/core/limits.hpp"
#include "cncplan/core/state.hpp"
#include "cncplan/core/vector.hpp"
#include "cncplan/step/backend.hpp"
#include "per_axis.hpp"
#include "program.hpp"

namespace simulate {

/// One row of the samples. Axes in mm and rad.
struct Sample {
  double time{};
  const Origin* motion{};
  cncplan::Vector3 position = cncplan::Vector3::Zero();  ///< of the tool, machine coordinates
  PerAxis axes;
  PerAxis velocity;
  PerAxis acceleration;
  cncplan::State along;
  double within{};  ///< mm from the motion's start
};

/// Speeds of a motion, and s from when it first moves to when it last does.
struct MotionTiming {
  double entry{};
  double peak{};
  double exit{};
  double duration{};
};

/// Lines of the program that are planned at another level of smoothing than was asked for.
struct OtherLevel {
  int first_line{}, last_line{};
  std::string_view level, reason;
};

/// Axes in mm and degrees.
struct Measures {
  double duration = 0.0;
  double length = 0.0;
  bool completed = true;
  std::vector<MotionTiming> motions;
  PerAxis travel;           ///< way of each axis, between the ends of blocks
  std::size_t samples = 0;  ///< none where none are made
  cncplan::Limits peak;
  cncplan::Limits tool_peak;
  PerAxis axis_velocity;
  PerAxis axis_acceleration;
  PerAxis axis_jerk;
  double corner_velocity_step = 0.0;
  std::size_t acceleration_jumps = 0;
  double end_error = 0.0;      ///< of the last sample from the program's end
  double contour_error = 0.0;  ///< of samples from the programmed path, where that is driven
  double deviation = 0.0;      ///< of smoothed paths from the programmed ones
  std::optional<std::size_t> junctions_limited{};
  std::vector<OtherLevel> other_levels;
  std::vector<cncplan::step::AxisReport> steps;  ///< none where no steps are made
  double plan_seconds = 0.0;
  double measure_seconds = 0.0;
  double interpolate_seconds = 0.0;
  double steps_seconds = 0.0;
};

}  // namespace simulate
