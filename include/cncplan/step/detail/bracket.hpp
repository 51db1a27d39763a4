// A root find that always ends: Newton's method inside a bracket, halving where Newton does not help.
#pragma once

#include <cmath>
#include <concepts>
#include <limits>
#include <type_traits>

namespace cncplan::step {

/// A function's value and slope at one place.
template <std::floating_point S>
struct Slope {
  S value{};
  S rate{};
};

/// The root of a function that goes from below zero at `low` to above it at `high`, to rounding of the
/// argument, from a guess between them. The bracket halves at least every second round; `f(x)` is asked at
/// most 2 * digits + 2 times.
template <std::floating_point S, std::invocable<S> F>
  requires std::same_as<std::invoke_result_t<F, S>, Slope<S>>
[[nodiscard]] S bracketed_root(F f, S low, S high, S guess) {
  constexpr int rounds = 2 * std::numeric_limits<S>::digits + 2;
  S x = guess;
  S allowed = high - low;  // the largest step that is no worse than halving
  for (int round = 0; round < rounds; ++round) {
    const Slope<S> here = f(x);
    if (here.value == S(0)) return x;
    (here.value > S(0) ? high : low) = x;
    S next = x - here.value / here.rate;
    const bool newton = next > low && next < high && std::abs(next - x) <= allowed;
    if (!newton) next = low + (high - low) / S(2);
    allowed = std::abs(next - x) / S(2);
    if (!newton) allowed = (high - low) / S(2);
    const S rounding = S(2) * std::numeric_limits<S>::epsilon() * std::abs(next);
    if (std::abs(next - x) <= rounding || high - low <= rounding) return next;
    x = next;
  }
  return x;
}

}  // namespace cncplan::step
