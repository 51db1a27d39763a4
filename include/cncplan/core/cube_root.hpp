// Cube roots of positive numbers, by their bits.
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>

#include "cncplan/core/compiler.hpp"

namespace cncplan {

/// Cube root to 5 %: a third of the exponent and mantissa read as one logarithm. x > 0, normal.
template <std::floating_point S>
[[nodiscard]] constexpr S rough_cube_root(S x) {
  constexpr std::uint64_t two_thirds_of_bias = std::uint64_t{715094163} << 32;
  return static_cast<S>(
      std::bit_cast<double>(std::bit_cast<std::uint64_t>(static_cast<double>(x)) / 3 + two_thirds_of_bias));
}

/// Cube root to three units in the last place, x > 0, normal: its inverse, without divisions. From a start
/// within 4 %, two steps of order four.
template <std::floating_point S>
[[nodiscard]] constexpr S cube_root(S x) {
  constexpr std::uint64_t four_thirds_of_bias = 0x553ef0ff289dd796;
  S inverse = static_cast<S>(
      std::bit_cast<double>(four_thirds_of_bias - std::bit_cast<std::uint64_t>(static_cast<double>(x)) / 3));
  for (int step = 0; step < 2; ++step) {
    const S rest = S(1) - x * inverse * inverse * inverse;  // of (1 - rest)^(-1/3), three terms
    inverse += inverse * rest * (S(1) / S(3) + rest * (S(2) / S(9) + rest * (S(14) / S(81))));
  }
  return x * inverse * inverse;
}

}  // namespace cncplan
