// Straight rows of the four axes that stay close to a curved wall (set-up).
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include "cncplan/core/jet.hpp"
#include "cncplan/kinematics/detail/azimuth.hpp"
#include "cncplan/kinematics/tire_mold/tire_mold.hpp"
#include "cncplan/tire_mold/wall_part.hpp"

namespace cncplan::tire_mold {

/// The axes R, Z, A, C at parameter u of a part; C is the angle nearest to `table`.
template <std::floating_point S>
[[nodiscard]] VectorN<S, 4> wall_joints(const BasicWallPart<S>& part, S u, S table) {
  const auto q = part.point(u);
  return {q[0], q[1], q[2], kinematics::near_turn(q[3], table)};
}

/// How far a place of the tip lies beside its path at parameter u, mm: across the path, height included.
template <std::floating_point S>
[[nodiscard]] S off_wall(const BasicWallPart<S>& part, S u, const BasicVector3<S>& place) {
  const auto tip = part.map.tip(part.flat(BasicJet<S>(u, 1, 0, 0)));
  const BasicVector3<S> tangent(tip[0].first, tip[1].first, tip[2].first);
  BasicVector3<S> apart = place - BasicVector3<S>(tip[0].value, tip[1].value, tip[2].value);
  if (tangent.squaredNorm() > S(0)) apart -= tangent * (tangent.dot(apart) / tangent.squaredNorm());
  return apart.norm();
}

/// How far a straight row leaves the tip's true path between two parameters of a part, mm: the largest
/// distance at seven places.
template <std::floating_point S>
[[nodiscard]] S chord_error(const BasicWallPart<S>& part, S from, S to) {
  const kinematics::BasicTireMold<S> machine{.tool_length = part.map.tool_length};
  const VectorN<S, 4> start = wall_joints(part, from, S(0));
  const VectorN<S, 4> way = wall_joints(part, to, start[3]) - start;
  S worst(0);
  for (int k = 1; k < 8; ++k) {
    const S share = static_cast<S>(k) / S(8);
    const BasicVector3<S> tip = machine.forward(start + share * way).position;
    worst = std::max(worst, off_wall(part, from + share * (to - from), tip));
  }
  return worst;
}

/// Into how many rows of equal parameter length a part is divided, and the largest distance by which one of
/// them leaves the wall, mm.
template <std::floating_point S>
struct BasicDivision {
  int rows = 1;
  S error{};
};

template <std::floating_point S>
[[nodiscard]] S largest_chord_error(const BasicWallPart<S>& part, int rows) {
  const S end = part.parameter_end(), width = end / static_cast<S>(rows);
  S worst(0);
  for (int i = 0; i < rows; ++i) {
    const S from = width * static_cast<S>(i);
    worst = std::max(worst, chord_error(part, from, i + 1 == rows ? end : from + width));
  }
  return worst;
}

/// As few rows as keep within `tolerance` mm (> 0). The error falls with the square of their number, so a few
/// tries find it.
template <std::floating_point S>
[[nodiscard]] BasicDivision<S> divide(const BasicWallPart<S>& part, S tolerance) {
  constexpr int most_rows = 1 << 20;
  constexpr int places = 8;
  // no row of more than about 60 degrees of table, arc or tilt, where the nearest turn of C could be the
  // wrong
  const S end = part.parameter_end();
  const S flat = part.artwork.length_at(part.to) - part.artwork.length_at(part.from);
  S shortest = part.map.reach(part.flat(S(0)));
  for (int k = 1; k <= places; ++k)
    shortest = std::min(shortest, part.map.reach(part.flat(end * static_cast<S>(k) / S(places))));
  int rows = std::clamp(static_cast<int>(std::ceil(flat / shortest)), 1, most_rows);
  for (;;) {
    const S error = largest_chord_error(part, rows);
    if (error <= tolerance || rows == most_rows) return {rows, error};
    const S wanted = static_cast<S>(rows) * std::sqrt(error / tolerance);
    rows =
        std::min(std::max(rows + 1, static_cast<int>(std::min(std::ceil(wanted), S(most_rows)))), most_rows);
  }
}

}  // namespace cncplan::tire_mold
