// KK22's centre selection as published: candidates, regions, antipodes and the state diagram.
#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "cncplan/core/plane.hpp"
#include "cncplan/core/vector.hpp"

namespace cncplan::published {

/// Centre minus chord midpoint for both circles of radius |radius| through p0 and p1 (KK22 Eqs. 1-6), the one
/// with the smaller x first; for a horizontal chord, the one with the larger y. The paper's y, divided by y0
/// - y1, is replaced by the same point on the chord's normal. Domain: p0 != p1, |radius| at least half their
/// distance.
template <std::floating_point S>
[[nodiscard]] std::array<VectorN<S, 2>, 2> candidate_offsets(const VectorN<S, 2>& p0, const VectorN<S, 2>& p1,
                                                             S radius) {
  const S dx = p1.x() - p0.x();
  const S dy = p1.y() - p0.y();
  const S d = std::hypot(dx, dy);
  const S r = std::abs(radius);
  const S h = std::sqrt((r - d / 2) * (r + d / 2));
  const bool first_is_left = dy > S(0) || (dy == S(0) && dx > S(0));
  const VectorN<S, 2> left(-dy / d * h, dx / d * h);
  if (first_is_left) return {left, -left};
  return {-left, left};
}

/// The point of the circle opposite to p0 (KK22 Eq. 7).
template <std::floating_point S>
[[nodiscard]] VectorN<S, 2> antipode(const VectorN<S, 2>& p0, const VectorN<S, 2>& center) {
  return p0 + 2 * (center - p0);
}

/// Region 1 to 4 that the end point lies in (KK22 Table 1); 0 if the points coincide. Clockwise arcs, and the
/// mirror image in x for the others.
template <std::floating_point S>
[[nodiscard]] int region(const VectorN<S, 2>& p0, const VectorN<S, 2>& p1, Turn turn) {
  const S right = turn == Turn::clockwise ? p1.x() - p0.x() : p0.x() - p1.x();
  const S up = p1.y() - p0.y();
  if (right > S(0) && up >= S(0)) return 1;
  if (right >= S(0) && up < S(0)) return 2;
  if (right < S(0) && up <= S(0)) return 3;
  if (right <= S(0) && up > S(0)) return 4;
  return 0;
}

/// The centre that KK22's state diagram (Fig. 3) selects for radius > 0, the other candidate for radius < 0.
/// The diagram compares the end point with the antipode of the start on the first circle. Their difference is
/// twice the offset of that centre from the chord's midpoint, and is taken from there: a difference of
/// rounded points would decide by chance next to a region's border. The x tests are those of clockwise arcs
/// and mirror for the others.
template <std::floating_point S>
[[nodiscard]] VectorN<S, 2> published_center(const VectorN<S, 2>& p0, const VectorN<S, 2>& p1, S radius,
                                             Turn turn) {
  const auto offsets = candidate_offsets(p0, p1, radius);
  const VectorN<S, 2> beyond = 2 * offsets[0];  // antipode minus end point
  const S beyond_x = turn == Turn::clockwise ? beyond.x() : -beyond.x();
  bool take_first = false;
  switch (region(p0, p1, turn)) {
    case 1:
      take_first = beyond.y() <= S(0);
      break;
    case 2:
      take_first = beyond_x <= S(0);
      break;
    case 3:
      take_first = beyond.y() >= S(0);
      break;
    case 4:
      take_first = beyond_x >= S(0);
      break;
    default:
      break;
  }
  const bool other = radius < S(0);
  return (p0 + p1) / 2 + offsets[take_first != other ? 0 : 1];
}

/// KK22's own parametrisation of an arc: x is mirrored for clockwise arcs, so that the angle grows for both.
template <std::floating_point S>
struct PublishedForm {
  VectorN<S, 2> center;
  S radius;       ///< > 0
  S mirror;       ///< -1 clockwise, +1 counter-clockwise
  S start_angle;  ///< Eqs. 8-9, rad
  S sweep;        ///< Eqs. 10-11, > 0, rad
  S start_z{};    ///< mm, of the axis across the plane
  S rise{};       ///< mm, z at the end less z at the start

  /// Eqs. 12-13, X and Y, for angles in [start_angle, start_angle + sweep].
  [[nodiscard]] VectorN<S, 2> position(S angle) const {
    return {center.x() + mirror * radius * std::cos(angle), center.y() + radius * std::sin(angle)};
  }
  /// Their third line, Z, which goes evenly with the angle. Printed with the angle in radians over a sweep in
  /// degrees; here both are radians.
  [[nodiscard]] S z(S angle) const { return start_z + rise * (angle - start_angle) / sweep; }
};

/// Start angle and sweep by KK22 Eqs. 8-11, with the readings of the errata: the mirrored angle of clockwise
/// arcs is atan2(y0 - yc, -(x0 - xc)), and the sweep of both is 2 atan2(|chord|, |end - antipode|), or the
/// rest of the turn for radius < 0.
template <std::floating_point S>
[[nodiscard]] PublishedForm<S> published_form(const VectorN<S, 2>& p0, const VectorN<S, 2>& p1, S radius,
                                              Turn turn) {
  const VectorN<S, 2> center = published_center(p0, p1, radius, turn);
  const S mirror = static_cast<S>(sign(turn));
  const S start_angle = std::atan2(p0.y() - center.y(), mirror * (p0.x() - center.x()));
  const S short_way = 2 * std::atan2((p1 - p0).norm(), (p1 - antipode(p0, center)).norm());
  const S sweep = radius < S(0) ? 2 * std::numbers::pi_v<S> - short_way : short_way;
  return {center, std::abs(radius), mirror, start_angle, sweep, S(0), S(0)};
}

/// The same of an arc or helix between points whose third coordinate is Z (of other planes: whatever stands
/// for it in Table 2).
template <std::floating_point S>
[[nodiscard]] PublishedForm<S> published_form(const BasicVector3<S>& p0, const BasicVector3<S>& p1, S radius,
                                              Turn turn) {
  PublishedForm<S> form = published_form(VectorN<S, 2>(p0.template head<2>()),
                                         VectorN<S, 2>(p1.template head<2>()), radius, turn);
  form.start_z = p0.z();
  form.rise = p1.z() - p0.z();
  return form;
}

}  // namespace cncplan::published
