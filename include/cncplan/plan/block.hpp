// A block: one motion of a program with all that planning needs to know of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>

#include "cncplan/core/limits.hpp"
#include "cncplan/junction/geometry.hpp"
#include "cncplan/path/segment.hpp"

namespace cncplan::plan {

/// One motion: where it goes, how fast it may, and how it ends. A dwell is a block of length zero with a
/// pause.
template <std::floating_point S>
struct BasicBlock {
  path::BasicSegment<S> segment;  ///< machine coordinates, mm
  BasicLimits<S> limits;          ///< along the path; the velocity is the programmed feed
  junction::Kind kind{};
  bool stop_at_end{};  ///< exact stop (G61, a pause, a stop of the program)
  S pause{};           ///< s at rest at its end

  friend bool operator==(const BasicBlock&, const BasicBlock&) = default;
};

using Block = BasicBlock<double>;

/// The block as seen from the junction at its start, or at its end.
template <std::floating_point S>
[[nodiscard]] junction::BasicSide<S> side(const BasicBlock<S>& block, bool at_end) {
  const path::BasicSegment<S>& segment = block.segment;
  junction::BasicSide<S> result;
  result.kind = block.kind;
  result.chord = segment.chord();
  result.tangent = at_end ? segment.end_tangent() : segment.start_tangent();
  if (const path::BasicArc<S>* arc = segment.arc()) {
    result.plane = arc->plane();
    result.turn = arc->turn();
    const auto [first, second, third] = axes(arc->plane());
    result.closed = result.chord[first] == S(0) && result.chord[second] == S(0);
    const S u = at_end ? arc->parameter_end() : S(0);
    const BasicVector3<S> rate = arc->derivative(u);
    const BasicVector3<S> bend = arc->second_derivative(u);
    const S rate_sq = rate.squaredNorm();
    result.curvature = (bend - rate * (rate.dot(bend) / rate_sq)) / rate_sq;
  }
  return result;
}

}  // namespace cncplan::plan
