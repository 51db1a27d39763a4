// Backlash compensation: extra steps of one axis where it turns round.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>

#include "cncplan/step/edge.hpp"

namespace cncplan::step {

/// What one block leaves to the next.
template <std::floating_point S>
struct BacklashState {
  S time = -std::numeric_limits<S>::infinity();  ///< s, of the axis' last step
  int direction = 0;                             ///< of that step; 0 before the first

  friend bool operator==(const BacklashState&, const BacklashState&) = default;
};

/// Puts `extra` steps in the new direction before each step that reverses its axis, spread evenly over the
/// time since the step before it or since `start` (the block's), whichever is later: the axis hardly moves
/// then. Whether the drive keeps up is for `DriveCheck` to say. Wraps the edges of a single axis, ahead of
/// `Merge`; before the first step of all the slack counts as taken up.
template <EdgeSource E>
class BacklashCompensation {
 public:
  using Scalar = typename E::Scalar;

  BacklashCompensation(const E& source, std::int64_t extra, Scalar start,
                       const BacklashState<Scalar>& state = {})
      : source_(source), extra_(extra), start_(start), state_(state) {}

  [[nodiscard]] std::optional<BasicEdge<Scalar>> next() {
    if (!edge_) {
      edge_ = source_.next();
      if (!edge_) return std::nullopt;
      count_ = edge_->direction == -state_.direction ? extra_ : 0;
      from_ = std::max(start_, state_.time);
      taken_ = 0;
    }
    BasicEdge<Scalar> result = *edge_;
    if (taken_ < count_) {
      ++taken_;
      result.time =
          from_ + (edge_->time - from_) * static_cast<Scalar>(taken_) / static_cast<Scalar>(count_ + 1);
    } else {
      edge_.reset();
    }
    state_ = {result.time, result.direction};
    return result;
  }

  [[nodiscard]] const BacklashState<Scalar>& state() const { return state_; }
  [[nodiscard]] const E& source() const { return source_; }

 private:
  E source_;
  std::int64_t extra_;
  Scalar start_;
  BacklashState<Scalar> state_;
  std::optional<BasicEdge<Scalar>> edge_;  // waits for the extra steps before it
  std::int64_t count_ = 0;
  std::int64_t taken_ = 0;
  Scalar from_{};
};

}  // namespace cncplan::step
