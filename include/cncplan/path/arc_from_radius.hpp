// Arc from its end points and radius (the R word): the well-conditioned form of KK22's centre selection.
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

/// The arc from start to end with the given radius; radius > 0 the way of at most 180 degrees, radius < 0 the
/// other one (ISO 6983). `extra_turns` whole turns are added (P n: n - 1). A third-axis difference makes it a
/// helix.
///
/// The centre lies on the chord's perpendicular bisector at the distance h = sqrt((R - d/2)(R + d/2)), to the
/// left of the chord for counter-clockwise short arcs; this is what KK22 Eqs. 1-7 and Table 1 select (see
/// published/center_selection.hpp), without their division by y0 - y1. The angle is 2 atan2(d/2, h) (KK22
/// Eqs. 10-11).
///
/// A radius that is half the chord up to rounding (of the relative bound `semicircle`, or of the coordinates'
/// own digits), or too short within tolerance, gives the semicircle about the midpoint; radius_adjustment()
/// tells by how much. Errors: not_finite, above_limit (start, end, radius, extra turns), negative (extra
/// turns), coincident_points (end: distance and bound), chord_exceeds_diameter (radius as programmed, and
/// half the chord).
template <std::floating_point S>
[[nodiscard]] Expected<BasicArc<S>> arc_from_radius(
    const std::type_identity_t<BasicVector3<S>>& start, const std::type_identity_t<BasicVector3<S>>& end,
    S radius, Turn turn, Plane plane, const std::type_identity_t<ArcTolerance<S>>& tolerance = {},
    int extra_turns = 0) {
  if (auto ok = check_point("start", start); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_point("end", end); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_number("radius", radius); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_extra_turns(extra_turns); !ok) return tl::unexpected(ok.error());

  const PlaneAxes a = axes(plane);
  const S dx = end(a.first) - start(a.first);
  const S dy = end(a.second) - start(a.second);
  const S chord = std::hypot(dx, dy);
  const S coincident = coincidence_bound(start, end, plane, tolerance);
  if (chord <= coincident) return refusal(ErrorCode::coincident_points, "end", chord, coincident);

  const S programmed = std::abs(radius);
  const S half = chord / 2;
  const S missing = half - programmed;
  if (missing > std::min(tolerance.short_radius, tolerance.short_radius_relative * programmed))
    return refusal(ErrorCode::chord_exceeds_diameter, "radius", radius, half);
  const S digits = std::max(resolution(start, plane), resolution(end, plane));
  const bool semicircle = missing >= -std::max(tolerance.semicircle * programmed, digits);

  const S h = semicircle ? S(0) : std::sqrt((programmed - half) * (programmed + half));
  const S side = static_cast<S>(sign(turn)) * (radius < S(0) ? S(-1) : S(1));
  const S offset_x = side * h * (-dy / chord);
  const S offset_y = side * h * (dx / chord);
  const S short_way = 2 * std::atan2(half, h);
  constexpr S whole = 2 * std::numbers::pi_v<S>;

  ArcGeometry<S> g{.start = start, .end = end, .center = (start + end) / 2, .radial = (start - end) / 2};
  g.center(a.first) += offset_x;
  g.center(a.second) += offset_y;
  g.radial(a.first) -= offset_x;
  g.radial(a.second) -= offset_y;
  g.start_radius = g.end_radius = semicircle ? half : programmed;
  g.angle = (radius < S(0) ? whole - short_way : short_way) + whole * static_cast<S>(extra_turns);
  g.turn = turn;
  g.plane = plane;
  g.radius_adjustment = semicircle ? missing : S(0);
  return BasicArc<S>(g);
}

}  // namespace cncplan::path
