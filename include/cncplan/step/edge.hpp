// A step edge: one pulse of one axis at an exact time.
#pragma once

#include <concepts>
#include <optional>

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

/// Anything that yields edges in order of time, and then none for ever.
template <class E>
concept EdgeSource = requires(E& source) {
  requires std::floating_point<typename E::Scalar>;
  { source.next() } -> std::same_as<std::optional<BasicEdge<typename E::Scalar>>>;
};

}  // namespace cncplan::step
