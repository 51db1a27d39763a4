// A step edge: one pulse of one axis at an exact time; its check, and the counts that edges add up to.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include "cncplan/core/error.hpp"

namespace cncplan::step {

/// The instant at which an axis takes one step.
template <std::floating_point S>
struct BasicEdge {
  S time{};         ///< s
  int axis{};       ///< from 0
  int direction{};  ///< +1 or -1

  friend bool operator==(const BasicEdge&, const BasicEdge&) = default;
};

using Edge = BasicEdge<double>;

/// What backends ask of an edge: a time in [not_before, latest] s, an axis in [0, axes), a direction of +-1.
/// The error names the first of these that is another.
template <std::floating_point S>
[[nodiscard]] Expected<void> check(const BasicEdge<S>& edge, int axes, S not_before,
                                   S latest = std::numeric_limits<S>::max()) {
  if (std::isnan(edge.time)) return refusal(ErrorCode::not_finite, "edge time", edge.time);
  if (edge.time < not_before) return refusal(ErrorCode::below_limit, "edge time", edge.time, not_before);
  if (edge.time > latest) return refusal(ErrorCode::above_limit, "edge time", edge.time, latest);
  if (edge.axis < 0) return refusal(ErrorCode::negative, "edge axis", S(edge.axis));
  if (edge.axis >= axes) return refusal(ErrorCode::above_limit, "edge axis", S(edge.axis), S(axes - 1));
  if (edge.direction != 1 && edge.direction != -1)
    return refusal(ErrorCode::not_supported, "edge direction", S(edge.direction), S(1));
  return {};
}

/// Most steps that are counted either way, 2^53: the doubles beyond are whole numbers of steps apart.
inline constexpr std::int64_t most_steps = std::int64_t{1} << 53;

/// The step count that belongs to a position in steps; half way between two the one farther from zero. Within
/// +-`most_steps`, whatever the position.
template <std::floating_point S>
[[nodiscard]] std::int64_t count_at(S steps) {
  constexpr S most = static_cast<S>(most_steps);
  return static_cast<std::int64_t>(std::llround(std::min(std::max(-most, steps), most)));
}

/// Anything that yields edges in order of time, and then none for ever.
template <class E>
concept EdgeSource = requires(E& source) {
  requires std::floating_point<typename E::Scalar>;
  { source.next() } -> std::same_as<std::optional<BasicEdge<typename E::Scalar>>>;
};

}  // namespace cncplan::step
