// How fast a path's derivatives may grow: upper bounds of their magnitudes on an interval of its length.
#pragma once

#include <algorithm>
#include <concepts>

#include "cncplan/core/vector.hpp"

namespace cncplan {

/// Of the tool's point r in space, by the length that the feed counts. The second and third derivative are
/// taken apart into what lies along r' and what lies across it. All zero where the tool stands still.
///
/// On a path by its own length, with curvature k: 1, 0, k, k^2, and the part of k's change that lies across.
template <std::floating_point S>
struct BasicToolBounds {
  S first{};
  S second_along{};   ///< 1/mm
  S second_across{};  ///< 1/mm
  S third_along{};    ///< 1/mm^2
  S third_across{};   ///< 1/mm^2

  /// Bounds of both: where two intervals meet.
  [[nodiscard]] BasicToolBounds joined(const BasicToolBounds& other) const {
    return {std::max(first, other.first), std::max(second_along, other.second_along),
            std::max(second_across, other.second_across), std::max(third_along, other.third_along),
            std::max(third_across, other.third_across)};
  }
};

/// Of each axis, and of the tool.
template <std::floating_point S, int N>
struct BasicPathBounds {
  using Vector = VectorN<S, N>;

  Vector first = Vector::Zero();
  Vector second = Vector::Zero();
  Vector third = Vector::Zero();
  BasicToolBounds<S> tool{};

  [[nodiscard]] BasicPathBounds joined(const BasicPathBounds& other) const {
    return {first.cwiseMax(other.first), second.cwiseMax(other.second), third.cwiseMax(other.third),
            tool.joined(other.tool)};
  }
};

}  // namespace cncplan
