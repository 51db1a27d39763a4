// The weighted mean of two motions: what lies between two extremes keeps the limits that both keep.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <span>

#include "cncplan/core/axis_state.hpp"
#include "cncplan/core/jerk_phase.hpp"
#include "cncplan/state/motion.hpp"

namespace cncplan::state {

/// `share` of the phases `a` and the rest of the phases `b`, both from one start and of one duration, with
/// one velocity and acceleration at their ends; share in [0, 1]. Positions, velocities and accelerations are
/// means at every instant.
template <std::floating_point S>
[[nodiscard]] BasicMotion<S> mean(const BasicAxisState<S>& start, const BasicAxisState<S>& end,
                                  std::span<const BasicJerkPhase<S>> a, std::span<const BasicJerkPhase<S>> b,
                                  S share) {
  BasicMotion<S> m(start, end);
  const S rest = S(1) - share;
  std::size_t i = 0, k = 0;
  S into_a{}, into_b{};
  while (i < a.size() && k < b.size()) {
    const S left_a = a[i].duration - into_a;
    const S left_b = b[k].duration - into_b;
    const S time = std::min(left_a, left_b);
    m.append(
        {time,
         share * (a[i].acceleration + a[i].jerk * into_a) + rest * (b[k].acceleration + b[k].jerk * into_b),
         share * a[i].jerk + rest * b[k].jerk});
    into_a += time, into_b += time;
    if (left_a <= time) ++i, into_a = S(0);
    if (left_b <= time) ++k, into_b = S(0);
  }
  return m;
}

}  // namespace cncplan::state
