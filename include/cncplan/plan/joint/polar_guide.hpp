// Guides a Cartesian program round the axis of a rotary table (set-up).
#pragma once

#include <concepts>
#include <vector>

#include "cncplan/kinematics/polar.hpp"
#include "cncplan/plan/joint/stretch.hpp"
#include "cncplan/plan/tire_mold/radius.hpp"

namespace cncplan::plan {

/// Segments in the coordinates of the table, to stretches over the polar chart.
template <std::floating_point S>
class BasicPolarGuide {
 public:
  using Chart = kinematics::BasicPolarChart<S>;

  /// Nothing nearer to the axis than `smallest_radius` (mm, > 0) is passed.
  explicit BasicPolarGuide(S smallest_radius) : smallest_radius_(smallest_radius) {}

  /// Appends the stretches of a segment. Error: below_limit with the least radius on it.
  Expected<void> follow(const path::BasicSegment<S>& segment, std::vector<Stretch<Chart>>& out) const {
    S least = radius_at(segment, S(0));
    for (S u = S(0); u < segment.parameter_end();) {
      u = next_radius_turning(segment, u);
      least = std::min(least, radius_at(segment, u));
    }
    if (!(least >= smallest_radius_))
      return tl::unexpected(Error{ErrorCode::below_limit, "radius", static_cast<double>(least),
                                  static_cast<double>(smallest_radius_)});
    if (segment.length() > S(0)) out.push_back({segment, Chart{}, S(0), segment.parameter_end(), false});
    return {};
  }

 private:
  S smallest_radius_;
};

using PolarGuide = BasicPolarGuide<double>;

}  // namespace cncplan::plan
