// Points beside the plan: those of Taylor steps, and how far any point is from the programmed path.
#pragma once

#include <algorithm>

#include "cncplan/cncplan.hpp"
#include "measures.hpp"

namespace simulate {

/// Eq. 16 from sample to sample; a block entered between two samples starts with the time that is left of the
/// period.
template <class T>
class TaylorFollower {
 public:
  explicit TaylorFollower(const T& trajectory) : trajectory_(trajectory) {}

  cncplan::Vector3 operator()(const typename T::SetPoint& point) {
    const auto& path = trajectory_.program()[point.block].path;
    if (point.block != block_ || !started_) {
      started_ = true;
      block_ = point.block;
      parameter_ = 0.0;
      time_ = trajectory_.start_time(block_);
      along_ = trajectory_.at(time_).along;
    }
    if (path.length() > 0.0)
      parameter_ = cncplan::published::taylor_step(path, parameter_, along_.velocity, along_.acceleration,
                                                   point.time - time_);
    along_ = point.along;
    time_ = point.time;
    return path.position(parameter_);
  }

 private:
  const T& trajectory_;
  bool started_ = false;
  std::size_t block_ = 0;
  double parameter_ = 0.0;
  double time_ = 0.0;
  cncplan::State along_;
};

/// Distance of samples from the programmed path, which is computed in higher precision than the points were:
/// the nearest parameter by Newton's method, from a guess that is close.
class PathDistance {
 public:
  double operator()(const Sample& sample) { return gap(sample).norm(); }

  /// From the programmed path to the sample, mm.
  cncplan::Vector3 gap(const Sample& sample) {
    using cncplan::BasicVector3;
    if (sample.motion != motion_) exact_ = extended(sample.motion->path);
    motion_ = sample.motion;
    const BasicVector3<Extended> point = sample.position.cast<Extended>();
    Extended u = sample.motion->path.parameter_at(std::clamp(sample.within, 0.0, sample.motion->length));
    for (int step = 0; step < 3; ++step) {
      const auto at = exact_.at(u);
      const BasicVector3<Extended> gap = at.position - point;
      const Extended slope = at.first.squaredNorm() + gap.dot(at.second);
      if (!(slope > 0.0L)) break;
      u = std::clamp(u - gap.dot(at.first) / slope, 0.0L, exact_.parameter_end());
    }
    return (point - exact_.position(u)).cast<double>();
  }

 private:
  using Extended = long double;
  using ExtendedSpline = cncplan::path::BasicSpline<Extended, 3>;
  using ExtendedSegment = cncplan::path::BasicSegment<Extended, 3, ExtendedSpline>;

  static ExtendedSegment extended(const ToolPath& segment) {
    using namespace cncplan;
    const auto wide = [](const Vector3& v) { return BasicVector3<Extended>(v.cast<Extended>()); };
    if (const auto* spline = segment.as<path::Spline<3>>()) {
      const auto& curve = spline->curve();
      const auto& [start, second, third, end] = curve.controls();
      return ExtendedSpline(path::BasicRationalCubic<Extended, 3>(
          {wide(start), wide(second), wide(third), wide(end)}, curve.weights()[0], curve.weights()[1]));
    }
    const path::Arc* const arc = segment.arc();
    if (arc == nullptr) return path::BasicLine<Extended>(wide(segment.start()), wide(segment.end()));
    return path::BasicArc<Extended>(path::ArcGeometry<Extended>{
        wide(arc->start()), wide(arc->end()), wide(arc->center()), wide(arc->radial()), arc->start_radius(),
        arc->end_radius(), arc->parameter_end(), arc->turn(), arc->plane(), 0.0L});
  }

  const Origin* motion_ = nullptr;
  ExtendedSegment exact_;
};

}  // namespace simulate
