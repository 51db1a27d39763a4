// What a motion executor works in, and what it says of each tick.
#pragma once

#include <concepts>
#include <cstdint>
#include <span>
#include <type_traits>

#include "cncplan/core/phase.hpp"
#include "cncplan/detail/executor/block_ring.hpp"
#include "cncplan/detail/speed/segment_limits.hpp"
#include "cncplan/detail/speed/span_planner.hpp"

namespace cncplan::detail {

/// What a motion executor works in; all of it belongs to the caller. `ahead` and the junctions bound the
/// look-ahead: `ahead` blocks, at least one, and one junction more than that in each buffer. Where one of
/// them is shorter, the others are used only as far as it reaches.
template <std::floating_point S>
struct BasicMotionExecutorMemory {
  std::span<BasicMotionBlock<S>> blocks;
  std::span<BasicSegmentLimits<S>> ahead;
  std::span<BasicConstrainedJunction<S>> junctions;
  std::span<BasicConstrainedJunction<S>> spare_junctions;
};

/// Where the machine is after a tick.
template <std::floating_point S>
struct BasicMotionSetPoint {
  std::int64_t block{};  ///< number of the block; -1 while there is none
  S along{};             ///< mm from the block's start
  S velocity{};          ///< mm/s along the path, negative when it runs backwards
  S acceleration{};      ///< mm/s^2, along the path
  S jerk{};              ///< mm/s^3, along the path, from now on
  bool at_rest{};

  friend bool operator==(const BasicMotionSetPoint&, const BasicMotionSetPoint&) = default;
};

using MotionSetPoint = BasicMotionSetPoint<double>;

/// A part of a tick: constant jerk within one block.
template <std::floating_point S>
struct BasicMotionPart {
  BasicPhase<S> phase;   ///< seconds into the tick; mm travelled from where it begins
  std::int64_t block{};  ///< number of the block
  S along{};             ///< mm from the block's start to where the part begins
  int direction = 1;     ///< -1 towards the block's start
};

/// Takes the parts of a tick and tells nobody: they need not be made for it.
struct NoVisitor {
  template <class Part>
  void operator()(const Part&) const {}
};

/// Whether a visitor of parts wants them.
template <class Visit>
inline constexpr bool wants_parts = !std::same_as<std::remove_cvref_t<Visit>, NoVisitor>;

}  // namespace cncplan::detail
