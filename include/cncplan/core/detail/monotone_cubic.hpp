// The inverse of a distance that grows as a cubic of time: how planned motion is turned round into times.
#pragma once

#include "cncplan/core/compiler.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

namespace cncplan {

/// Distance v x + a x^2/2 + j x^3/6 over x in [0, duration], growing with x. Solving is best conditioned, and
/// fastest, from the end where motion is slow: there v, a >= 0 and the curve is convex.
template <std::floating_point S>
struct MonotoneCubic {
  S velocity{};
  S acceleration{};
  S jerk{};
  S duration{};

  [[nodiscard]] constexpr S distance(S x) const {
    return x * (velocity + x * (acceleration / S(2) + x * (jerk / S(6))));
  }

  /// The x at which `target` has been travelled; 0 for targets not above 0, `duration` for those beyond the
  /// end.
  [[nodiscard]] S solve(S target) const { return solve(target, first_guess(target)); }

  /// The same, from a guess in [0, duration]. Each round solves the local quadratic exactly, which leaves j
  /// d^3/6, and takes that away by one Newton step c. On a convex curve slope >= a x/2, so what remains is
  /// below c^2/x: a correction under the root of the machine epsilon is the last one. Elsewhere the bracket
  /// keeps it safe.
  [[nodiscard]] S solve(S target, S guess) const {
    if (!(target > S(0))) return S(0);
    if (!(target < distance(duration))) return duration;
    if (jerk == S(0)) return quadratic_root(target);
    constexpr int rounds = 2 * std::numeric_limits<S>::digits;
    S low = S(0), high = duration, x = guess;
    for (int round = 0; round < rounds; ++round) {
      const S excess = distance(x) - target;
      (excess > S(0) ? high : low) = x;
      const S slope = velocity + x * (acceleration + x * (jerk / S(2)));
      const S bend = acceleration + x * jerk;
      const S square = slope * slope - S(2) * bend * excess;
      const S root = std::sqrt(std::max(square, S(0)));
      const S step = S(-2) * excess / (slope + root);
      const S cube = square > S(0) ? jerk * step * step / S(2) : S(0);
      const S correction = cube == S(0) ? S(0) : cube * step / (S(3) * (root + cube));
      const S next = x + (step - correction);
      const bool inside = next >= low && next <= high;
      if (inside && square > S(0) && std::abs(correction) <= last_correction * next) return next;
      x = inside && next != x ? next : low + (high - low) / S(2);
      if (!(x > low && x < high)) return x;
    }
    return x;
  }

  /// `solve` for each of `targets` in place, from one guess near them all. The rounds are those of `solve`,
  /// for all at once and without branches, so that they are vectorised; if three of them leave a target open,
  /// all are solved one by one.
  void solve_all(std::span<S> targets, S guess) const {
    constexpr std::size_t chunk = 32;
    for (; targets.size() > chunk; targets = targets.subspan(chunk)) solve_all(targets.first(chunk), guess);
    if (jerk == S(0)) {
      for (S& target : targets) target = target > S(0) ? quadratic_root(target) : S(0);
      return;
    }
    const S half_jerk = jerk / S(2);
    const S third = S(1) / S(3);
    const std::size_t count = targets.size();
    std::array<S, chunk> x, excess, slope, root;
    std::fill_n(x.begin(), count, guess);
    std::int64_t open = 1;
    for (int round = 0; round < 3 && open > 0; ++round) {
      for (std::size_t i = 0; i < count; ++i) {
        const S bend = acceleration + x[i] * jerk;
        excess[i] = distance(x[i]) - targets[i];
        slope[i] = velocity + x[i] * (acceleration + x[i] * half_jerk);
        root[i] = slope[i] * slope[i] - S(2) * bend * excess[i];
      }
      for (std::size_t i = 0; i < count; ++i) root[i] = std::sqrt(std::max(root[i], S(0)));
      open = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const S step = S(-2) * excess[i] / (slope[i] + root[i]);
        const S cube = half_jerk * step * step;
        const S correction = third * cube * step / (root[i] + cube);
        const S next = x[i] + (step - correction);
        const bool last = next > S(0) && next < duration && std::abs(correction) <= last_correction * next;
        open += last ? 0 : 1;
        x[i] = next;
      }
    }
    const S total = distance(duration);
    for (std::size_t i = 0; i < count; ++i) {
      const bool inside = targets[i] > S(0) && targets[i] < total && open == 0;
      targets[i] = inside ? x[i] : solve(targets[i]);
    }
  }

 private:
  // Corrections below this part of x leave an error below rounding.
  static constexpr S last_correction =
      S(1) / static_cast<S>(std::int64_t{1} << std::numeric_limits<S>::digits / 2);

  [[nodiscard]] S quadratic_root(S target) const {
    if (acceleration == S(0)) return std::min(target / velocity, duration);
    const S square = velocity * velocity + S(2) * acceleration * target;
    return std::min(S(2) * target / (velocity + std::sqrt(std::max(square, S(0)))), duration);
  }

  [[nodiscard]] S first_guess(S target) const {
    if (!(target > S(0)) || jerk == S(0)) return S(0);
    const S guess = quadratic_root(target);
    return jerk > S(0) ? std::min(guess, std::cbrt(S(6) * target / jerk)) : guess;
  }
};

}  // namespace cncplan
