// Cube roots of positive numbers, by their bits.
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>
#include <type_traits>

#include "cncplan/core/compiler.hpp"

namespace cncplan {

namespace detail {

/// The type whose bits are read: that of the number, or a narrower one. Processors that have no `double` are
/// asked for none.
template <std::floating_point S>
struct CubeRootBits {
  using Float = double;
  using Word = std::uint64_t;
  static constexpr Word two_thirds_of_bias = Word{715094163} << 32;
  static constexpr Word four_thirds_of_bias = 0x553ef0ff289dd796;
};
// The same shares of the bias and the same corrections of them, as a float's bits have both.
template <>
struct CubeRootBits<float> {
  using Float = float;
  using Word = std::uint32_t;
  static constexpr Word two_thirds_of_bias = 709958125;
  static constexpr Word four_thirds_of_bias = 1419915940;
};

template <std::floating_point S>
[[nodiscard]] constexpr typename CubeRootBits<S>::Word bits_of(S x) {
  using Bits = CubeRootBits<S>;
  return std::bit_cast<typename Bits::Word>(static_cast<typename Bits::Float>(x));
}
template <std::floating_point S>
[[nodiscard]] constexpr S number_of(typename CubeRootBits<S>::Word bits) {
  return static_cast<S>(std::bit_cast<typename CubeRootBits<S>::Float>(bits));
}

}  // namespace detail

/// Cube root to 5 %: a third of the exponent and mantissa read as one logarithm. x > 0, normal.
template <std::floating_point S>
[[nodiscard]] constexpr S rough_cube_root(S x) {
  return detail::number_of<S>(detail::bits_of(x) / 3 + detail::CubeRootBits<S>::two_thirds_of_bias);
}

/// Cube root to three units in the last place, x > 0, normal: its inverse, without divisions. From a start
/// within 4 %, two steps of order four.
template <std::floating_point S>
[[nodiscard]] constexpr S cube_root(S x) {
  S inverse = detail::number_of<S>(detail::CubeRootBits<S>::four_thirds_of_bias - detail::bits_of(x) / 3);
  for (int step = 0; step < 2; ++step) {
    const S rest = S(1) - x * inverse * inverse * inverse;  // of (1 - rest)^(-1/3), three terms
    inverse += inverse * rest * (S(1) / S(3) + rest * (S(2) / S(9) + rest * (S(14) / S(81))));
  }
  return x * inverse * inverse;
}

}  // namespace cncplan
