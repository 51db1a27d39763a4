// The root of a function between two places, by Halley's method in a bracket.
#pragma once

#include <array>
#include <cmath>
#include <concepts>
#include <limits>

#include "cncplan/core/compiler.hpp"

namespace cncplan {

/// The root of a function in a bracket [low, high] (in either order), with f(low) <= 0 <= f(high), from a
/// guess. f(x) gives value, slope and second derivative. A step is replaced by halving where it leaves the
/// bracket, is more than half of the last one, or the curve bends too much to be trusted: there are twice as
/// many steps as digits at most, three or four as a rule.
template <std::floating_point S, class F>
[[nodiscard]] S bracketed_root(const F& f, S low, S high, S x) {
  constexpr S last = S(1) / S(1 << (std::numeric_limits<S>::digits / 3 + 2));  // its cube is below rounding
  S before = std::abs(high - low);
  for (int step = 0; step < 2 * std::numeric_limits<S>::digits; ++step) {
    const std::array<S, 3> y = f(x);
    if (y[0] == S(0)) return x;
    (y[0] < S(0) ? low : high) = x;
    const S square = S(2) * y[1] * y[1];
    const S bend = y[0] * y[2];
    const S next = x - S(2) * y[0] * y[1] / (square - bend);
    const S change = std::abs(next - x);
    const bool trusted =
        std::abs(bend) <= square / S(2) && change <= before / S(2) && (next - low) * (next - high) <= S(0);
    before = trusted ? change : std::abs(high - low) / S(2);
    x = trusted ? next : low + (high - low) / S(2);
    if (before <= (trusted ? last : std::numeric_limits<S>::epsilon()) * std::abs(x)) return x;
  }
  return x;
}

/// The same between two places where f grows or falls throughout. False where the values there have one sign.
/// A place whose value is within `slack` is taken for the root.
template <std::floating_point S, class F>
[[nodiscard]] bool root_between(const F& f, S from, S to, S slack, S& x) {
  const S at_from = f(from)[0];
  const S at_to = f(to)[0];
  if (std::abs(at_from) <= slack || std::abs(at_to) <= slack) {
    x = std::abs(at_from) <= slack ? from : to;
    return true;
  }
  if ((at_from > S(0)) == (at_to > S(0))) return false;
  const S guess = from - at_from * ((to - from) / (at_to - at_from));
  x = at_from < at_to ? bracketed_root(f, from, to, guess) : bracketed_root(f, to, from, guess);
  return true;
}

}  // namespace cncplan
