// Samples a plan on the grid of the period, by the interpolator that was asked for.
#include <algorithm>
#include <cmath>
#include <optional>
#include <type_traits>

#include "run.hpp"
#include "stopwatch.hpp"
#include "support/axis_motion.hpp"

namespace simulate {

namespace {

using namespace cncplan;

// Eq. 16 from sample to sample; a block entered between two samples starts with the time that is left of the
// period.
class TaylorFollower {
 public:
  TaylorFollower(const Route<MillPath>& route, const Plan& plan) : route_(route), plan_(plan) {}

  Vector3 operator()(const plan::Place& place, double time) {
    if (place.block != block_ || !started_) {
      started_ = true;
      block_ = place.block;
      parameter_ = 0.0;
      along_ = plan_.timings[block_].entry;
      time_ = plan_.timings[block_].start;
    }
    const path::Segment<3>& segment = route_[block_].path;
    if (segment.length() > 0.0)
      parameter_ =
          published::taylor_step(segment, parameter_, along_.velocity, along_.acceleration, time - time_);
    along_ = place.state;
    time_ = time;
    return segment.position(parameter_);
  }

 private:
  const Route<MillPath>& route_;
  const Plan& plan_;
  bool started_ = false;
  std::size_t block_ = 0;
  double parameter_ = 0.0;
  double time_ = 0.0;
  State along_;
};

// Distance of a point from a segment: the nearest parameter by Newton's method, from a guess that is close.
double distance(const Programmed& programmed, const Vector3& point) {
  if (programmed.segment == nullptr) return 0.0;
  const path::Segment<3>& segment = *programmed.segment;
  double u = programmed.parameter;
  for (int step = 0; step < 3; ++step) {
    const Vector3 gap = segment.position(u) - point;
    const Vector3 first = segment.derivative(u);
    const double slope = first.squaredNorm() + gap.dot(segment.second_derivative(u));
    if (!(slope > 0.0)) break;
    u = std::clamp(u - gap.dot(first) / slope, 0.0, segment.parameter_end());
  }
  return (segment.position(u) - point).norm();
}

}  // namespace

template <class P>
void make_samples(const Program& program, const Route<P>& route, const Plan& plan, const Options& options,
                  Measures& measures, const std::function<void(const Sample&)>& take) {
  constexpr bool mill = std::is_same_v<P, MillPath>;
  support::PlanCursor cursor(plan);
  std::optional<TaylorFollower> follow;
  if constexpr (mill)
    if (options.interpolator == Interpolator::taylor) follow.emplace(route, plan);
  Sample row;
  const auto sample = [&](double time, const plan::Place& place) {
    const auto& [path, block] = route[place.block];
    const bool last = !(time < plan.duration);
    const bool at_end = last && !(place.along < plan.lengths[place.block]);  // whatever rounding says
    double u = 0.0;
    {
      const Stopwatch watch(measures.interpolate_seconds);
      u = at_end ? path.parameter_end() : path.parameter_at(place.along);
      row.position = follow && !last ? (*follow)(place, time) : tool(path, u);
    }
    measures.contour_error = std::max(measures.contour_error, distance(programmed(path, u), row.position));
    ++measures.samples;
    row.time = time;
    row.block = block;
    row.along = place.state;
    if (!mill || options.plot) {
      State within = place.state;
      within.position = place.along;
      const auto axes = support::axis_motion(path, within);
      row.axes = axes.position;
      row.velocity = axes.velocity;
      row.acceleration = axes.acceleration;
    }
    take(row);
  };
  for (std::size_t k = 0; static_cast<double>(k) * options.period < plan.duration; ++k) {
    const double time = static_cast<double>(k) * options.period;
    sample(time, cursor.at(time));
  }
  sample(plan.duration, plan.end);  // whatever rounding left of the last phase
  measures.end_error = (row.position - program.blocks.back().segment.end()).norm();
}

using Take = std::function<void(const Sample&)>;
template void make_samples(const Program&, const Route<MillPath>&, const Plan&, const Options&, Measures&,
                           const Take&);
template void make_samples(const Program&, const Route<PolarPath>&, const Plan&, const Options&, Measures&,
                           const Take&);
template void make_samples(const Program&, const Route<RowPath>&, const Plan&, const Options&, Measures&,
                           const Take&);

}  // namespace simulate
