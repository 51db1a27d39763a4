// One axis from a state to a state.
#pragma once

#include <concepts>

#include "cncplan/core/axis_limits.hpp"
#include "cncplan/core/axis_state.hpp"
#include "cncplan/core/error.hpp"
#include "cncplan/state/detail/axis_motions.hpp"
#include "cncplan/state/detail/travel.hpp"
#include "cncplan/state/motion.hpp"
#include "cncplan/state/move_options.hpp"
#include "cncplan/state/rest_to_rest.hpp"

namespace cncplan::state {

/// Makes the fastest motion that takes the minimum duration at least. Errors: those of `validate` and
/// `within_travel`, and a minimum duration that is negative or not finite.
template <std::floating_point S>
[[nodiscard]] Expected<void> make_move(const BasicAxisState<S>& from, const BasicAxisState<S>& to,
                                       const BasicAxisLimits<S>& limits, const BasicMoveOptions<S>& options,
                                       BasicMotion<S>& motion) {
  if (auto ok = validate(options); !ok) return ok;
  if (auto ok = validate(from, to, limits); !ok) return ok;
  const auto lengthen = [&](const BasicAxisMotions<S>& motions) {
    motions.make(motions.range(motions.duration_from(options.minimum_duration)), motion);
  };
  if (at_rest(from, to, limits)) {
    make_rest_to_rest(from, to, limits, motion);
    if (motion.duration() < options.minimum_duration) lengthen({from, to, limits});
  } else {
    const BasicAxisMotions<S> motions(from, to, limits);
    motions.make(motions.first(), motion);
    if (motion.duration() < options.minimum_duration) lengthen(motions);
  }
  return within_travel(motion, limits);
}

}  // namespace cncplan::state
