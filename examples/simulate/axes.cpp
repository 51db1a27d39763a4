// What the exact path asks of the axes, inside blocks and at their joints.
#include <algorithm>
#include <cmath>

#include "run.hpp"

namespace simulate {

namespace {

using namespace cncplan;

void grow(Measures& measures, const path::Segment& segment, double along, const State& state) {
  const auto sample = interpolate::evaluate(segment, {along, state.velocity, state.acceleration, state.jerk});
  measures.axis_velocity = measures.axis_velocity.cwiseMax(sample.velocity.cwiseAbs());
  measures.axis_acceleration = measures.axis_acceleration.cwiseMax(sample.acceleration.cwiseAbs());
}

}  // namespace

void measure_axes(const Program& program, const Plan& plan, Measures& measures) {
  for (std::size_t i = 0; i < program.blocks.size(); ++i) {
    const path::Segment& segment = program.blocks[i].segment;
    if (!(segment.length() > 0.0)) continue;
    grow(measures, segment, 0.0, plan.timings[i].entry);
    grow(measures, segment, segment.length(), plan.timings[i].exit);
  }
  plan::Cursor cursor(plan.spans, plan.lengths);
  double start = 0.0;
  for (const plan::Span& span : plan.spans) {
    for (const Phase& phase : span.profile.phases()) {
      const plan::Place place = cursor.at(start + phase.time);
      const path::Segment& segment = program.blocks[place.block].segment;
      if (segment.length() > 0.0) grow(measures, segment, place.along, place.state);
    }
    start += span.profile.duration();
  }
  for (std::size_t i = 1; i < program.blocks.size(); ++i) {
    const path::Segment& before = program.blocks[i - 1].segment;
    const path::Segment& after = program.blocks[i].segment;
    if (!(before.length() > 0.0 && after.length() > 0.0)) continue;
    const Vector3 jump = after.start_tangent() * plan.timings[i].entry.velocity -
                         before.end_tangent() * plan.timings[i - 1].exit.velocity;
    measures.corner_velocity_step = std::max(measures.corner_velocity_step, jump.lpNorm<Eigen::Infinity>());
  }
}

}  // namespace simulate
