// A span: consecutive blocks that one profile drives through.
#pragma once

#include <concepts>
#include <cstddef>

#include "cncplan/profile/profile.hpp"

namespace cncplan::detail {

/// Blocks [first, first + count) and the profile over their joined length. A pause is a span of no blocks.
template <std::floating_point S>
struct BasicSpan {
  std::size_t first{};
  std::size_t count{};
  profile::BasicProfile<S> profile;

  friend bool operator==(const BasicSpan&, const BasicSpan&) = default;
};

using Span = BasicSpan<double>;

/// `seconds` at rest before block `first`.
template <std::floating_point S>
[[nodiscard]] constexpr BasicSpan<S> pause_span(std::size_t first, S seconds) {
  return {first, 0, profile::BasicProfile<S>({.cruise = seconds})};
}

}  // namespace cncplan::detail
