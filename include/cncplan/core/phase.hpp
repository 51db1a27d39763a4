// A stretch of motion along a path with constant jerk: what planned profiles are made of.
#pragma once

#include <concepts>
#include <cstddef>
#include <span>

#include "cncplan/core/detail/monotone_cubic.hpp"
#include "cncplan/core/state.hpp"

namespace cncplan {

/// A phase turned round: the time within it at which a position is reached. Made by `BasicPhase::inverse`.
template <std::floating_point S>
struct PhaseInverse {
  MonotoneCubic<S> cubic;  ///< distance from the slow end over time from it
  S position{};            ///< mm, of the slow end
  S tau{};                 ///< s into the phase, of the slow end
  S sense{};               ///< +1 where that is the phase's start, -1 where it is its end

  [[nodiscard]] S tau_at(S where) const { return tau + sense * cubic.solve(sense * (where - position)); }

  /// The same for each of many positions near each other, in place, from a guess in [0, duration] near them
  /// all.
  void tau_at(std::span<S> positions, S guess) const {
    for (S& where : positions) where = sense * (where - position);
    cubic.solve_all(positions, sense * (guess - tau));
    for (S& x : positions) x = tau + sense * x;
  }
};

/// Constant jerk for `duration`, from the state at its start. Planned motion goes forward: velocity >= 0
/// throughout.
template <std::floating_point S>
struct BasicPhase {
  S time{};          ///< s, when the phase starts
  S duration{};      ///< s, >= 0; zero for a phase that a profile leaves out
  S position{};      ///< mm along the path, at the start
  S velocity{};      ///< mm/s, at the start
  S acceleration{};  ///< mm/s^2, at the start
  S jerk{};          ///< mm/s^3, throughout

  /// State `tau` seconds into the phase, tau in [0, duration].
  [[nodiscard]] constexpr BasicState<S> at(S tau) const {
    return {position + tau * (velocity + tau * (acceleration / S(2) + tau * (jerk / S(6)))),
            velocity + tau * (acceleration + tau * (jerk / S(2))), acceleration + tau * jerk, jerk};
  }

  /// The first `tau` at which a position is reached; 0 and `duration` for positions before and behind the
  /// phase. Exact to rounding; where the speed vanishes, to the time that one unit in the last place of the
  /// position takes.
  [[nodiscard]] S tau_at(S where) const { return inverse().tau_at(where); }

  /// What `tau_at` works with, for asking many positions of one phase: seen from the end where motion is
  /// slower.
  [[nodiscard]] constexpr PhaseInverse<S> inverse() const {
    const BasicState<S> last = at(duration);
    if (last.velocity < velocity)
      return {{last.velocity > S(0) ? last.velocity : S(0), -last.acceleration, jerk, duration},
              last.position,
              duration,
              S(-1)};
    return {{velocity, acceleration, jerk, duration}, position, S(0), S(1)};
  }

  /// mm/s, the highest within it.
  [[nodiscard]] constexpr S highest_velocity() const {
    const S ends = velocity > at(duration).velocity ? velocity : at(duration).velocity;
    if (jerk == S(0)) return ends;
    const S top = -acceleration / jerk;
    const bool inside = top > S(0) && top < duration;
    return inside && at(top).velocity > ends ? at(top).velocity : ends;
  }

  /// Whether it ends at rest, but for rounding.
  [[nodiscard]] constexpr bool ends_at_rest() const {
    const S change = (acceleration > S(0) ? acceleration : -acceleration) * duration + velocity;
    return at(duration).velocity <= S(1e-3) * change;
  }

  friend bool operator==(const BasicPhase&, const BasicPhase&) = default;
};

using Phase = BasicPhase<double>;

/// A phase along one of the pieces of a path: its time counts from the start of all, its position from the
/// piece's.
template <std::floating_point S>
struct BasicPiecePhase {
  BasicPhase<S> phase;
  std::size_t piece{};

  friend bool operator==(const BasicPiecePhase&, const BasicPiecePhase&) = default;
};

}  // namespace cncplan
