// The one buffer that floor/store_xyz and every batch fill: 4096 points of three doubles, 96 KiB.
#pragma once

#include <Eigen/Core>

namespace cncplan::bench {

inline constexpr int buffer_points = 4096;

using Buffer = Eigen::Matrix<double, 3, buffer_points>;

/// Static and cache-line aligned, so that two benchmarks of one run write to the very same lines.
inline Buffer& buffer() {
  alignas(64) static Buffer points = Buffer::Zero();
  return points;
}

}  // namespace cncplan::bench
