// One axis from a state to a state.
#pragma once

#include <concepts>

#include "cncplan/core/axis_limits.hpp"
#include "cncplan/core/axis_state.hpp"
#include "cncplan/core/error.hpp"
#include "cncplan/state/axis_motions.hpp"
#include "cncplan/state/motion.hpp"
#include "cncplan/state/move_options.hpp"
#include "cncplan/state/rest_to_rest.hpp"
#include "cncplan/state/travel.hpp"

namespace cncplan::state {

/// The fastest motion that takes the minimum duration at least. Errors: those of `axis_motions` and
/// `within_travel`, and a minimum duration that is negative or not finite.
template <std::floating_point S>
[[nodiscard]] Expected<BasicMotion<S>> move(const BasicAxisState<S>& from, const BasicAxisState<S>& to,
                                            const BasicAxisLimits<S>& limits,
                                            const BasicMoveOptions<S>& options = {}) {
  if (const auto ok = validate(options); !ok) return tl::unexpected(ok.error());
  if (const auto ok = validate(from, to, limits); !ok) return tl::unexpected(ok.error());
  const auto longer = [&](const BasicAxisMotions<S>& motions) {
    return motions.lasting(motions.duration_from(options.minimum_duration));
  };
  BasicMotion<S> motion;
  if (at_rest(from, to, limits)) {
    motion = rest_to_rest(from, to, limits);
    if (motion.duration() < options.minimum_duration) motion = longer({from, to, limits});
  } else {
    const BasicAxisMotions<S> motions(from, to, limits);
    motion = motions.fastest();
    if (motion.duration() < options.minimum_duration) motion = longer(motions);
  }
  if (const auto ok = within_travel(motion, limits); !ok) return tl::unexpected(ok.error());
  return motion;
}

}  // namespace cncplan::state
