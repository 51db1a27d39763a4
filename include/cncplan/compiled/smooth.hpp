// Smoothing that the library `cncplan::compiled` has ready, whatever path it serves (set-up).
#pragma once

#include "cncplan/detail/curve/smooth_run.hpp"

/// Curves of N coordinates.
#define CNCPLAN_SMOOTH_CURVES(PREFIX, N) PREFIX template class BasicBand<double, N>;

/// The same where the axes of the curve are those of the limits.
#define CNCPLAN_SMOOTH_RUNS(PREFIX, N) PREFIX template class SmoothRun<double, N>;

/// Speeds where N axes and coordinates of the tool have limits.
#define CNCPLAN_PLAN_SPEED(PREFIX, N)                                                  \
  PREFIX template BasicSpeedPlan<double> plan_speed(                                   \
      std::span<const BasicSpeedCell<double, N>>, const BasicMotionLimits<double, N>&, \
      const BasicPlanSpeedOptions<double>&, const BasicPlanSpeedMemory<double>&,       \
      const BasicSpeedEnds<double>&, const Progress&);

#ifdef CNCPLAN_COMPILED
namespace cncplan::detail {

CNCPLAN_SMOOTH_CURVES(extern, 3)
CNCPLAN_SMOOTH_CURVES(extern, 4)
CNCPLAN_SMOOTH_CURVES(extern, 5)
CNCPLAN_SMOOTH_CURVES(extern, 6)
CNCPLAN_SMOOTH_RUNS(extern, 3)
CNCPLAN_SMOOTH_RUNS(extern, 4)
CNCPLAN_SMOOTH_RUNS(extern, 6)
CNCPLAN_PLAN_SPEED(extern, 1)
CNCPLAN_PLAN_SPEED(extern, 2)
CNCPLAN_PLAN_SPEED(extern, 3)
CNCPLAN_PLAN_SPEED(extern, 4)
CNCPLAN_PLAN_SPEED(extern, 5)
CNCPLAN_PLAN_SPEED(extern, 6)
CNCPLAN_PLAN_SPEED(extern, 7)
CNCPLAN_PLAN_SPEED(extern, 8)
CNCPLAN_PLAN_SPEED(extern, 9)

}  // namespace cncplan::detail
#endif
