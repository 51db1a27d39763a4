// How an executor is to run programs.
#pragma once

#include <cmath>
#include <concepts>

#include "cncplan/core/error.hpp"
#include "cncplan/detail/valid_tolerances.hpp"
#include "cncplan/reserve.hpp"
#include "cncplan/smooth_level.hpp"

namespace cncplan {

/// The level of an executor that only has one.
struct FastLevel {
  constexpr FastLevel() {}  // not made of a `SmoothLevel`
};

/// What holds for all that an executor runs. With a `level` of type `SmoothLevel` it can be any; an executor
/// that is made so can do more, and is compiled and linked with more, than one that only has the level
/// `fast`.
template <std::floating_point S, class Level = FastLevel>
struct BasicExecutorOptions {
  /// mm, >= 0: how far the tool may leave the programmed path, so that it moves without a jump of velocity or
  /// acceleration; 0: the exact path
  S tolerance = S(0.01);
  Level level{};                                 ///< of smoothing
  S rotary_tolerance = S(8.726646259971648e-4);  ///< rad, > 0: the same for rotary axes; 0.05 degrees
  /// mm, >= 0: junctions that are left exact are passed as fast as ones rounded within it would be
  S junction_deviation = S(0.01);
  bool exact_between_rapids_and_feeds{};  ///< keeps the junctions of rapids with feed moves exact
  /// s at rest for which blocks are held back for the ones that follow them; and s without a new block, while
  /// there is room for one, after which they are let go before the motion slows down for want of blocks
  S longest_wait = S(0.05);
  S quick_stop_share = S(1);  ///< 1 to 1000 (cut where it is not): how many times its limits of acceleration
                              ///< and jerk the tool and each axis may use in a quick stop; what drives and
                              ///< mechanics bear beyond the limits that machining has
  bool background = false;    ///< another thread, or the main loop, calls `plan`; else `tick` does its work
  /// In [0, 1): the share of the limits of acceleration and jerk that plans at the levels `good` and `best`
  /// leave for holds. The more, the sooner a hold comes, and the longer the program takes.
  S reserve = S(0.02);
  /// How many times the least that a brake takes a hold may take, > 1; 0: no plan for it. Plans at the levels
  /// `good` and `best` are slower where a hold would come later.
  S hold_factor = S(1.5);
  /// >= 1: the highest override of the feed. At the level `fast` any override above 1 has the acceleration
  /// and jerk that bends leave at this one: the higher it is, the less.
  S most_override = S(2);
  /// s of motion, > 0: how far plans at the levels `good` and `best` are ahead, whole blocks at least.
  /// Another feed than the one that they were made for has its full effect behind it. The shorter, the more
  /// work, and the longer the program takes.
  S horizon = S(5);
};

/// Nothing, or the first number that is out of its domain.
template <std::floating_point S, class Level>
[[nodiscard]] Expected<void> validate(const BasicExecutorOptions<S, Level>& options) {
  if (auto ok = detail::valid_reserve(options.reserve, options.hold_factor); !ok) return ok;
  if (!(options.longest_wait >= S(0)))
    return refusal(options.longest_wait < S(0) ? ErrorCode::negative : ErrorCode::not_finite, "longest wait",
                   options.longest_wait);
  if (!std::isfinite(options.most_override) || options.most_override < S(1))
    return refusal(options.most_override < S(1) ? ErrorCode::below_limit : ErrorCode::not_finite,
                   "highest override", options.most_override, S(1));
  if (!std::isfinite(options.horizon) || !(options.horizon > S(0)))
    return refusal(options.horizon <= S(0) ? ErrorCode::not_positive : ErrorCode::not_finite, "horizon",
                   options.horizon);
  return detail::valid_tolerances(options.tolerance, options.rotary_tolerance, options.junction_deviation,
                                  options.tolerance > S(0));
}

using ExecutorOptions = BasicExecutorOptions<double>;
using LevelExecutorOptions = BasicExecutorOptions<double, SmoothLevel>;

}  // namespace cncplan
