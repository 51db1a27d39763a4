// Arc from its start, centre, angle and sense: what YO04's card is told (Table 1: f, F, V, y).
#pragma once

#include <cmath>
#include <concepts>
#include <numbers>
#include <type_traits>

#include "cncplan/path/arc.hpp"
#include "cncplan/path/arc_tolerance.hpp"

namespace cncplan::path {

/// The arc from start round `center` (absolute; its third coordinate is ignored) that turns by `angle` (rad,
/// > 0, more than a turn allowed); the third coordinate goes evenly from start to start + `rise` (mm).
/// Errors: not_finite, above_limit (start, center, angle, rise), not_positive (angle), below_limit (radius).
template <std::floating_point S = double>
[[nodiscard]] Expected<BasicArc<S>> arc_from_angle(
    const BasicVector3<S>& start, const std::type_identity_t<BasicVector3<S>>& center,
    std::type_identity_t<S> angle, Turn turn, Plane plane, std::type_identity_t<S> rise = 0,
    const std::type_identity_t<ArcTolerance<S>>& tolerance = {}) {
  const PlaneAxes a = axes(plane);
  if (auto ok = check_point("start", start); !ok) return tl::unexpected(ok.error());
  for (const int axis : {a.first, a.second})
    if (auto ok = check_number("center", center(axis)); !ok) return tl::unexpected(ok.error());
  if (auto ok = check_number("rise", rise); !ok) return tl::unexpected(ok.error());
  if (!std::isfinite(angle)) return refusal(ErrorCode::not_finite, "angle", S(angle));
  if (!(angle > S(0))) return refusal(ErrorCode::not_positive, "angle", S(angle));
  constexpr S most = S(2) * std::numbers::pi_v<S> * static_cast<S>(most_extra_turns);
  if (angle > most) return refusal(ErrorCode::above_limit, "angle", S(angle), most);

  ArcGeometry<S> g{.start = start, .end = start, .center = center, .radial = start - center};
  const S x = g.radial(a.first), y = g.radial(a.second);
  g.start_radius = g.end_radius = std::hypot(x, y);
  if (g.start_radius < tolerance.smallest_radius)
    return refusal(ErrorCode::below_limit, "radius", g.start_radius, tolerance.smallest_radius);
  const S turned = static_cast<S>(sign(turn)) * angle;
  const S c = std::cos(turned), s = std::sin(turned);
  g.end(a.first) = center(a.first) + x * c - y * s;
  g.end(a.second) = center(a.second) + x * s + y * c;
  g.end(a.third) = start(a.third) + rise;
  g.angle = angle;
  g.turn = turn;
  g.plane = plane;
  return BasicArc<S>(g);
}

}  // namespace cncplan::path
