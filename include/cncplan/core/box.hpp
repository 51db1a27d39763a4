// Axis-aligned box.
#pragma once

#include <concepts>

#include "cncplan/core/vector.hpp"

namespace cncplan {

/// All points with low <= p <= high in every axis, mm or rad.
template <std::floating_point S, int N = 3>
struct BasicBox {
  VectorN<S, N> low;
  VectorN<S, N> high;

  /// Whether all of another box is inside.
  [[nodiscard]] bool contains(const BasicBox& other) const {
    return (low.array() <= other.low.array()).all() && (other.high.array() <= high.array()).all();
  }

  friend bool operator==(const BasicBox& a, const BasicBox& b) { return a.low == b.low && a.high == b.high; }
};

using Box = BasicBox<double>;

}  // namespace cncplan
