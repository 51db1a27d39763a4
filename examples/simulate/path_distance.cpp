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
  using cncplan::BasicVector3;
  if (place.motion != motion_) exact_ = extended(place.motion->path);
  motion_ = place.motion;
  const BasicVector3<Extended> point = place.position.cast<Extended>();
  Extended u = place.motion->path.parameter_at(std::clamp(place.within, 0.0, place.motion->length));
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
