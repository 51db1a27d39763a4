// Whether the tolerances that options give are any.
#pragma once

#include <cmath>
#include <concepts>

#include "cncplan/core/error.hpp"

namespace cncplan::detail {

/// Nothing, or the first of them that is none: a tolerance that is negative or not finite, a rotary one that
/// is 0 where paths are smoothed, a junction deviation that is negative or no number.
template <std::floating_point S>
[[nodiscard]] Expected<void> valid_tolerances(S tolerance, S rotary_tolerance, S junction_deviation,
                                              bool smooths) {
  if (!std::isfinite(tolerance)) return refusal(ErrorCode::not_finite, "tolerance", tolerance);
  if (tolerance < S(0)) return refusal(ErrorCode::negative, "tolerance", tolerance);
  if (!std::isfinite(rotary_tolerance))
    return refusal(ErrorCode::not_finite, "rotary tolerance", rotary_tolerance);
  if (rotary_tolerance < S(0) || (smooths && rotary_tolerance == S(0)))
    return refusal(ErrorCode::not_positive, "rotary tolerance", rotary_tolerance);
  if (std::isnan(junction_deviation))
    return refusal(ErrorCode::not_finite, "junction deviation", junction_deviation);
  if (junction_deviation < S(0))
    return refusal(ErrorCode::negative, "junction deviation", junction_deviation);
  return {};
}

}  // namespace cncplan::detail
