// Arc from its end points and centre (the I J K words).
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <numbers>
#include <string_view>
#include <type_traits>

#include "cncplan/path/arc.hpp"
#include "cncplan/path/arc_tolerance.hpp"

namespace cncplan::path {

/// The arc from start round `center` (absolute; its third coordinate is ignored) to end; a full circle where
/// start and end are one point of the plane. `extra_turns` whole turns are added (P n: n - 1).
///
/// The centre stays as programmed. Radii that differ within tolerance give a spiral that hits the end point;
/// a difference within the rounding of the coordinates gives a circle. Errors: not_finite, above_limit
/// (start, end, center, extra turns), negative (extra turns), below_limit (radius), radius_mismatch (center:
/// the difference and the bound).
template <std::floating_point S = double>
[[nodiscard]] Expected<BasicArc<S>> arc_from_center(
    const BasicVector3<S>& start, const std::type_identity_t<BasicVector3<S>>& end,
    const std::type_identity_t<BasicVector3<S>>& center, Turn turn, Plane plane,
    const std::type_identity_t<ArcTolerance<S>>& tolerance = {}, int extra_turns = 0) {
  const PlaneAxes a = axes(plane);
  if (auto ok = check_point("start", start); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_point("end", end); !ok) return tl::unexpected(ok.error());
  for (const int axis : {a.first, a.second})
    if (auto ok = check_number("center", center(axis)); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_extra_turns(extra_turns); !ok) return tl::unexpected(ok.error());

  const S x0 = start(a.first) - center(a.first);
  const S y0 = start(a.second) - center(a.second);
  const S x1 = end(a.first) - center(a.first);
  const S y1 = end(a.second) - center(a.second);
  const S r0 = std::hypot(x0, y0);
  const S r1 = std::hypot(x1, y1);
  const auto [smaller, larger] = std::minmax({r0, r1});
  if (smaller < tolerance.smallest_radius)
    return refusal(ErrorCode::below_limit, "radius", smaller, tolerance.smallest_radius);
  const S allowed =
      std::max(tolerance.radius_mismatch,
               std::min(tolerance.radius_mismatch_largest, tolerance.radius_mismatch_relative * larger));
  if (larger - smaller > allowed)
    return refusal(ErrorCode::radius_mismatch, "center", larger - smaller, allowed);
  const S digits = 4 * (resolution(start, plane) + resolution(end, plane) + resolution(center, plane));

  // Angle from start to end about the centre, in the arc's sense and in (-pi, pi]; the cross product is taken
  // with the chord, which keeps the digits of short arcs. One point twice is a full circle, give or take what
  // they differ by.
  const S dx = end(a.first) - start(a.first);
  const S dy = end(a.second) - start(a.second);
  const S turned = static_cast<S>(sign(turn)) * std::atan2(x0 * dy - y0 * dx, x0 * x1 + y0 * y1);
  const bool full = turned <= S(0) || std::hypot(dx, dy) <= coincidence_bound(start, end, plane, tolerance);
  constexpr S whole = 2 * std::numbers::pi_v<S>;

  ArcGeometry<S> g{.start = start, .end = end, .center = center, .radial = start - center};
  g.start_radius = r0;
  g.end_radius = larger - smaller <= digits ? r0 : r1;
  g.angle = turned + whole * static_cast<S>(extra_turns + (full ? 1 : 0));
  g.turn = turn;
  g.plane = plane;
  return BasicArc<S>(g);
}

}  // namespace cncplan::path
