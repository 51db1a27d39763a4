// Stretches of a program under one chart each, and the short pieces that are planned (set-up).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "cncplan/core/concepts.hpp"
#include "cncplan/kinematics/azimuth.hpp"
#include "cncplan/path/segment.hpp"
#include "cncplan/plan/joint/mapped_path.hpp"

namespace cncplan::plan {

/// The part of a segment over which one chart holds; for a kink, the tool's turning about its tip.
template <Chart C>
struct Stretch {
  path::BasicSegment<typename C::Scalar> segment;
  C chart;
  typename C::Scalar from{};  ///< parameters of the segment
  typename C::Scalar to{};
  bool kink{};
};

/// One piece of a mapped program.
template <Chart C>
using MappedBlock = JointBlock<MappedPath<C>>;

/// Cuts a stretch into pieces over which the joints' rates vary little: no longer than `longest` mm, a tenth
/// of the chart's reach, and a quarter of a radian of an arc. `table` is where the rotary table stands, rad
/// with whole turns; it is moved on. `add` is called with each piece.
template <Chart C, std::invocable<const MappedPath<C>&> Add>
void cut(const Stretch<C>& stretch, typename C::Scalar longest, typename C::Scalar& table, Add&& add) {
  using S = typename C::Scalar;
  const auto& segment = stretch.segment;
  S u = stretch.from;
  while (u < stretch.to) {
    const auto moving = moving_point(segment, u);
    const auto measured = measured_point(stretch.chart, moving);
    const auto speed = [](const auto& p) { return std::hypot(p[0].first, p[1].first, p[2].first); };
    S step = std::min(longest / speed(measured),
                      stretch.chart.reach(point_at(segment, u)) / (S(10) * speed(moving)));
    if (segment.arc() != nullptr) step = std::min(step, S(0.25));
    const S left = stretch.to - u;
    const S next = left <= step ? stretch.to : u + (left < S(2) * step ? left / S(2) : step);
    if (!(next > u)) break;
    C chart = stretch.chart;
    if constexpr (requires { chart.azimuth; }) {
      const auto middle = point_at(segment, u + (next - u) / S(2));
      chart.azimuth = kinematics::BasicAzimuth<S>(middle[0], middle[1], table);
      const auto end = point_at(segment, next);
      table = chart.azimuth.of(end[0], end[1]);
    }
    add(MappedPath<C>(segment, chart, u, next));
    u = next;
  }
}

}  // namespace cncplan::plan
