// How a change of speed is driven within the limits of acceleration and jerk: the five- and the seven-phase
// law.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <limits>

#include "cncplan/core/limits.hpp"
#include "cncplan/profile/profile.hpp"

namespace cncplan::profile {

/// A ramp between two speeds that differ by dv, with zero acceleration at both ends, is symmetric in time, so
/// it covers (v0 + v1) times half its duration. Half the duration is sqrt(dv / J) as long as the peak sqrt(J
/// dv) stays within A (KK22 Eq. 14); beyond that, dv > A^2/J, it is linear in dv:
///
///     five phases    jerk lowered to A^2/dv, triangle        dv / A
///     seven phases   jerk kept, acceleration held at A       dv / (2 A) + A / (2 J)
///
/// Half the duration grows with dv, and the distance of a ramp with the higher of its speeds: what the
/// solvers rest on. An infinite acceleration limit never binds; an infinite jerk limit makes the acceleration
/// step.
template <std::floating_point S>
struct BasicRampLaw {
  S jerk{};               ///< J; 0 if infinite, where no phase of it lasts
  S root_jerk{};          ///< sqrt(J); 0 if infinite
  S inverse_root_jerk{};  ///< 1 / sqrt(J)
  S acceleration{};       ///< A
  S root_break{};         ///< A / sqrt(J), root of the dv above which the acceleration limit binds
  S slope{};              ///< half duration per dv above it
  S offset{};             ///< half duration at dv = 0 of that line
  bool holds{};           ///< seven phases

  /// Half the duration of a ramp, from the root of dv.
  [[nodiscard]] constexpr S half_duration(S root) const {
    return root <= root_break ? root * inverse_root_jerk : slope * root * root + offset;
  }

  /// Distance of a ramp between two speeds.
  [[nodiscard]] S distance(S from, S to) const {
    return (from + to) * half_duration(std::sqrt(std::abs(to - from)));
  }

  /// The ramp of a signed change of speed, `root` being the root of its size to within rounding. Its
  /// acceleration and jerk are those by which the rounded times make exactly that change: the law's, but for
  /// a few units in the last place.
  [[nodiscard]] constexpr BasicRamp<S> ramp(S root, S change) const {
    constexpr S rounding = S(1) + S(8) * std::numeric_limits<S>::epsilon();
    const S size = std::abs(change);
    if (root <= root_break) {
      const S time = root * inverse_root_jerk;
      const S sharp = std::copysign(std::min(jerk * rounding, size / (time * time)), change);
      return {time, S(0), time, sharp * time, sharp};
    }
    const S full = root * root / acceleration;
    const S peak = std::copysign(std::min(acceleration * rounding, size / full), change);
    const S rise = holds ? S(2) * offset : full;
    return {rise, full - rise, rise, peak, rise > S(0) ? peak / rise : S(0)};
  }
};

/// The law of the paper's five phases.
template <std::floating_point S>
[[nodiscard]] BasicRampLaw<S> five_phase_law(const BasicLimits<S>& limits) {
  const bool smooth = std::isfinite(limits.jerk);
  const S root = smooth ? std::sqrt(limits.jerk) : S(0);
  const S inverse = smooth ? S(1) / root : S(0);
  const S root_break =
      std::isfinite(limits.acceleration) ? limits.acceleration * inverse : limits.acceleration;
  const S jerk = smooth ? limits.jerk : S(0);
  return {jerk, root, inverse, limits.acceleration, root_break, S(1) / limits.acceleration, S(0), false};
}

/// The law of the time-optimal ramp between rest accelerations.
template <std::floating_point S>
[[nodiscard]] BasicRampLaw<S> seven_phase_law(const BasicLimits<S>& limits) {
  BasicRampLaw<S> law = five_phase_law(limits);
  law.slope /= S(2);
  const bool bound = std::isfinite(limits.acceleration) && law.jerk > S(0);
  law.offset = bound ? limits.acceleration / law.jerk / S(2) : S(0);
  law.holds = true;
  return law;
}

}  // namespace cncplan::profile
