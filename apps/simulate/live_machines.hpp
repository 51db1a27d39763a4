// What `live_machines` does, for the files that define it for one kind of machine each.
#pragma once

#include <memory>
#include <vector>

#include "cncplan/executor_levels.hpp"
#include "cncplan/gcode/work_coordinates.hpp"
#include "machine.hpp"
#include "serve.hpp"
#include "serve/live_executor.hpp"

namespace simulate {

template <class M>
serve::LiveRun::Fresh live_machines(const Options& options, const support::Machine& file, const M& machine,
                                    const Program<M>& program) {
  return [&] {
    using Machine = serve::LiveExecutor<M, BlockOf<M>>;
    const auto shown = [&](const typename Machine::SetPoint& point, std::vector<double>& row) {
      const cncplan::Vector3 tool = tool_at(machine, point);
      row.insert(row.end(), tool.begin(), tool.end());
      for (std::size_t i = 0; i < file.axes.size(); ++i)
        for (const auto* of : {&point.position, &point.velocity, &point.acceleration, &point.jerk})
          row.push_back(file.shown(i, (*of)[static_cast<Eigen::Index>(i)]));
    };
    const double rotary_tolerance = options.rotary_tolerance * cncplan::gcode::radians_per_degree;
    return std::make_unique<Machine>(
        machine, program.blocks,
        cncplan::LevelExecutorOptions{.tolerance = options.tolerance,
                                      .level = options.level(),
                                      .rotary_tolerance = rotary_tolerance,
                                      .junction_deviation = options.corner_tolerance},
        shown);
  };
}

}  // namespace simulate
