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

using Extended = long double;
using ExtendedSegment = path::BasicSegment<Extended>;

ExtendedSegment extended(const path::Segment<3>& segment) {
  const auto wide = [](const Vector3& v) { return BasicVector3<Extended>(v.cast<Extended>()); };
  const path::Arc* const arc = segment.arc();
  if (arc == nullptr) return path::BasicLine<Extended>(wide(segment.start()), wide(segment.end()));
  return path::BasicArc<Extended>(path::ArcGeometry<Extended>{
      wide(arc->start()), wide(arc->end()), wide(arc->center()), wide(arc->radial()), arc->start_radius(),
      arc->end_radius(), arc->parameter_end(), arc->turn(), arc->plane(), 0.0L});
}

// Distance of points from the programmed path, which is computed in higher precision than the points were:
// the nearest parameter by Newton's method, from a guess that is close.
class PathDistance {
 public:
  double operator()(const Programmed& programmed, const Vector3& position) {
    if (programmed.segment == nullptr) return 0.0;
    if (programmed.segment != segment_) exact_ = extended(*programmed.segment);
    segment_ = programmed.segment;
    const BasicVector3<Extended> point = position.cast<Extended>();
    Extended u = programmed.parameter;
    for (int step = 0; step < 3; ++step) {
      const auto at = exact_.at(u);
      const BasicVector3<Extended> gap = at.position - point;
      const Extended slope = at.first.squaredNorm() + gap.dot(at.second);
      if (!(slope > 0.0L)) break;
      u = std::clamp(u - gap.dot(at.first) / slope, 0.0L, exact_.parameter_end());
    }
    return static_cast<double>((exact_.position(u) - point).norm());
  }

 private:
  const path::Segment<3>* segment_ = nullptr;
  ExtendedSegment exact_;
};

}  // namespace

template <class P>
void make_samples(const Program& program, const Route<P>& route, const Plan& plan, const Options& options,
                  Measures& measures, const std::function<void(const Sample&)>& take) {
  constexpr bool mill = std::is_same_v<P, MillPath>;
  support::PlanCursor cursor(plan);
  std::optional<TaylorFollower> follow;
  if constexpr (mill)
    if (options.interpolator == Interpolator::taylor) follow.emplace(route, plan);
  PathDistance distance;
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
