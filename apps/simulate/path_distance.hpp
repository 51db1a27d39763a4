// How far points are from the programmed path.
#pragma once

#include "cncplan/core/vector.hpp"
#include "cncplan/path/segment.hpp"
#include "cncplan/path/spline.hpp"
#include "program.hpp"

namespace simulate {

/// A point of what drives along a motion's path, and about where it is along that.
struct PlaceBeside {
  const Origin* motion{};                                ///< whose `driven_path` is known
  cncplan::Vector3 position = cncplan::Vector3::Zero();  ///< machine coordinates
  double within{};                                       ///< mm from the motion's start
};

/// Distance of points from the programmed path, which is computed in higher precision than the points were:
/// the nearest parameter by Newton's method, from a guess that is close. Near the end of a motion the path of
/// those beside it may be nearer than its own.
class PathDistance {
 public:
  /// The program must outlive it.
  explicit PathDistance(const ProgramText& program) : program_(program) {}

  double operator()(const PlaceBeside& place) { return gap(place).norm(); }

  /// From the programmed path to the place, mm.
  cncplan::Vector3 gap(const PlaceBeside& place);

 private:
  // From the path of one motion; the search begins `within` mm from its start, or at the nearest of some
  // places up to `reach` mm from there, where the motion is no longer than a few times that.
  cncplan::Vector3 gap_of(const Origin& motion, const cncplan::Vector3& position, double within,
                          double reach);

  const ProgramText& program_;
  const Origin* motion_ = nullptr;
  cncplan::path::BasicSegment<long double, 3, cncplan::path::BasicSpline<long double, 3>> exact_;
};

}  // namespace simulate
