// Axis-aligned box.
#pragma once

#include "cncplan/core/vector.hpp"

namespace cncplan::path {

/// All points with low <= p <= high in every axis, mm.
template <std::floating_point S>
struct BasicBox {
  BasicVector3<S> low;
  BasicVector3<S> high;

  friend bool operator==(const BasicBox& a, const BasicBox& b) { return a.low == b.low && a.high == b.high; }
};

using Box = BasicBox<double>;

}  // namespace cncplan::path
