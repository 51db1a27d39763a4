// What `smooth_trajectory` does, for the files that define it for one kind of machine each.
#pragma once

#include "cncplan/gcode/work_coordinates.hpp"
#include "cncplan/plan/smooth_blocks.hpp"
#include "smooth_trajectory.hpp"

namespace simulate {

template <int N>
cncplan::Expected<Pieces<N>, cncplan::ProgramError> smooth_trajectory(const Options& options,
                                                                      const Mill<N>& machine,
                                                                      const Program<Mill<N>>& program) {
  return cncplan::plan_smooth(
      program.blocks, machine,
      {.tolerance = options.tolerance,
       .rotary_tolerance = options.rotary_tolerance * cncplan::gcode::radians_per_degree},
      options.smooth == Smooth::good ? cncplan::SmoothLevel::good : cncplan::SmoothLevel::best);
}

}  // namespace simulate
