#include "path_distance.hpp"

#include <algorithm>

namespace simulate {

namespace {

using Extended = long double;
using ExtendedSpline = cncplan::path::BasicSpline<Extended, 3>;
using ExtendedSegment = cncplan::path::BasicSegment<Extended, 3, ExtendedSpline>;

ExtendedSegment extended(const ToolPath& segment) {
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

}  // namespace

cncplan::Vector3 PathDistance::gap(const PlaceBeside& place) {
  const Origin& own = *place.motion;
  const double within = std::clamp(place.within, 0.0, own.length);
  // What is nearer than the place where the point belongs is at most twice that far from it, along a path
  // that turns little; where it turns sharply, motions on both sides of the corner are that near to it.
  const double reach = 2.0 * (place.position - own.driven_path()->position_at(within)).norm();
  cncplan::Vector3 nearest = gap_of(own, place.position, within, reach);
  const auto look = [&](const Origin& motion, double start) {
    if (!(motion.length > 0.0) || motion.turns) return 0.0;
    if (motion.driven_path() == nullptr || motion.axes_path.has_value() != own.axes_path.has_value())
      return motion.length;
    const cncplan::Vector3 gap = gap_of(motion, place.position, start, reach);
    if (gap.squaredNorm() < nearest.squaredNorm()) nearest = gap;
    return motion.length;
  };
  const Origin* const first = program_.motions.data();
  const Origin* const end = first + program_.motions.size();
  double way = own.length - within;
  for (const Origin* motion = &own + 1; motion != end && way < reach; ++motion) way += look(*motion, 0.0);
  way = within;
  for (const Origin* motion = &own; motion != first && way < reach;) {
    --motion;
    way += look(*motion, motion->length);
  }
  return nearest;
}

cncplan::Vector3 PathDistance::gap_of(const Origin& motion, const cncplan::Vector3& position, double within,
                                      double reach) {
  using cncplan::BasicVector3;
  const ToolPath& path = *motion.driven_path();
  if (&motion != motion_) exact_ = extended(path);
  motion_ = &motion;
  const BasicVector3<Extended> point = position.cast<Extended>();
  if (constexpr double few = 8.0; motion.length < few * reach && path.line() == nullptr) {
    constexpr int places = 16;
    const double from = std::max(within - reach, 0.0), to = std::min(within + reach, motion.length);
    double least = (path.position_at(within) - position).squaredNorm();
    for (int i = 0; i <= places; ++i) {
      const double s = from + (to - from) * i / places;
      const double gap = (path.position_at(s) - position).squaredNorm();
      if (!(gap < least)) continue;
      least = gap;
      within = s;
    }
  }
  Extended u = path.parameter_at(within);
  for (int step = 0; step < 3; ++step) {
    const auto at = exact_.at(u);
    const BasicVector3<Extended> gap = at.position - point;
    const Extended slope = at.first.squaredNorm() + gap.dot(at.second);
    if (!(slope > 0.0L)) break;
    u = std::clamp(u - gap.dot(at.first) / slope, 0.0L, exact_.parameter_end());
  }
  return (point - exact_.position(u)).cast<double>();
}

}  // namespace simulate
