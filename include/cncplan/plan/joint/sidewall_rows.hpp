// Straight rows in machine space that stay close to a curved wall (set-up).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <span>
#include <vector>

#include "cncplan/kinematics/azimuth.hpp"
#include "cncplan/kinematics/sidewall.hpp"
#include "cncplan/kinematics/tire_mold.hpp"
#include "cncplan/plan/joint/stretch.hpp"

namespace cncplan::plan {

template <std::floating_point S>
using SidewallStretch = Stretch<kinematics::BasicSidewallChart<S>>;

/// Joints R, Z, A, C over a stretch at parameter u; C is the angle nearest to `table`.
template <std::floating_point S>
[[nodiscard]] VectorN<S, 4> sidewall_joints(const SidewallStretch<S>& stretch, S u, S table) {
  const auto q = stretch.chart.joints(point_at(stretch.segment, u));
  return {q[0], q[1], q[2], kinematics::near_turn(q[3], table)};
}

/// How far a straight row of joints leaves the tip's true path between two parameters, mm: the largest
/// distance across the path at seven places. Both include the height above the wall.
template <std::floating_point S>
[[nodiscard]] S chord_error(const SidewallStretch<S>& stretch, S from, S to) {
  const kinematics::BasicTireMold<S> machine{.tool_length = stretch.chart.tool_length};
  const VectorN<S, 4> start = sidewall_joints(stretch, from, S(0));
  const VectorN<S, 4> way = sidewall_joints(stretch, to, start[3]) - start;
  S worst(0);
  for (int k = 1; k < 8; ++k) {
    const S part = static_cast<S>(k) / S(8);
    const auto tip = stretch.chart.tip(moving_point(stretch.segment, from + part * (to - from)));
    const BasicVector3<S> truth(tip[0].value, tip[1].value, tip[2].value);
    const BasicVector3<S> tangent(tip[0].first, tip[1].first, tip[2].first);
    BasicVector3<S> apart = machine.forward(start + part * way).position - truth;
    if (tangent.squaredNorm() > S(0)) apart -= tangent * (tangent.dot(apart) / tangent.squaredNorm());
    worst = std::max(worst, apart.norm());
  }
  return worst;
}

/// Into how many rows of equal parameter length a stretch is divided so that none leaves the wall by more
/// than `tolerance` mm (> 0), and the largest distance by which one does. The error falls with the square of
/// the number, so a few tries find it.
template <std::floating_point S>
struct BasicDivision {
  int rows = 1;
  S error{};
};

template <std::floating_point S>
[[nodiscard]] S largest_chord_error(const SidewallStretch<S>& stretch, int rows) {
  const S width = (stretch.to - stretch.from) / static_cast<S>(rows);
  S worst(0);
  for (int i = 0; i < rows; ++i) {
    const S from = stretch.from + width * static_cast<S>(i);
    worst = std::max(worst, chord_error(stretch, from, i + 1 == rows ? stretch.to : from + width));
  }
  return worst;
}

template <std::floating_point S>
[[nodiscard]] BasicDivision<S> divide(const SidewallStretch<S>& stretch, S tolerance) {
  constexpr int most_rows = 1 << 20;
  // no row of more than about 60 degrees of table, arc or tilt, where the nearest turn of C could be the
  // wrong
  const S way = stretch.to - stretch.from;
  S flat = stretch.segment.derivative(stretch.from).norm() * way;
  S shortest = stretch.chart.reach(point_at(stretch.segment, stretch.from));
  for (int k = 1; k <= 8; ++k)
    shortest = std::min(shortest, stretch.chart.reach(point_at(
                                      stretch.segment, stretch.from + way * static_cast<S>(k) / S(8))));
  int rows = std::clamp(static_cast<int>(std::ceil(flat / shortest)), 1, most_rows);
  for (;;) {
    const S error = largest_chord_error(stretch, rows);
    if (error <= tolerance || rows == most_rows) return {rows, error};
    const S wanted = static_cast<S>(rows) * std::sqrt(error / tolerance);
    rows =
        std::min(std::max(rows + 1, static_cast<int>(std::min(std::ceil(wanted), S(most_rows)))), most_rows);
  }
}

}  // namespace cncplan::plan
