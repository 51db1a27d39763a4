// Segment limits: what look-ahead needs to know of a cell.
#pragma once

#include <concepts>

#include "cncplan/core/limits.hpp"

namespace cncplan::detail {

/// A block reduced to numbers.
template <std::floating_point S>
struct BasicSegmentLimits {
  S length{};             ///< mm
  S entry{};              ///< mm/s, highest speed at its start
  BasicLimits<S> limits;  ///< along the path within it
  S pause{};              ///< s at rest at its end

  friend bool operator==(const BasicSegmentLimits&, const BasicSegmentLimits&) = default;
};

using SegmentLimits = BasicSegmentLimits<double>;

}  // namespace cncplan::detail
