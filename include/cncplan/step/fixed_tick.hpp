// Edges on the grid of a timer of fixed frequency, with the jitter that this brings.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

#include "cncplan/core/error.hpp"
#include "cncplan/step/edge.hpp"

namespace cncplan::step {

/// One interrupt in which something happens: bit i of `steps` is set when axis i steps, bit i of `directions`
/// while its direction is positive.
struct Tick {
  std::int64_t index{};  ///< ticks since time 0
  std::uint32_t steps{};
  std::uint32_t directions{};

  friend bool operator==(const Tick&, const Tick&) = default;
};

/// Moves each edge of a merged source of up to 32 axes to the nearest tick: no edge is off by more than half
/// a tick, and none is lost. Ticks without a step are left out.
template <EdgeSource E>
class FixedTicks {
 public:
  using Scalar = typename E::Scalar;

  /// Ticks per second, > 0; ticks count to +-`most_steps`. Before their first step all directions are
  /// positive.
  FixedTicks(const E& source, Scalar frequency) : source_(source), frequency_(frequency) { pull(); }

  /// The next tick with a step, none behind the last. An error where an axis would step twice in one tick:
  /// the frequency is too low, and the stream ends there.
  [[nodiscard]] Expected<std::optional<Tick>> next() {
    if (!edge_) return std::optional<Tick>();
    Tick tick{index_of(*edge_), 0, directions_};
    for (; edge_ && index_of(*edge_) == tick.index; pull()) {
      const std::uint32_t bit = std::uint32_t{1} << edge_->axis;
      if ((tick.steps & bit) != 0) {
        edge_.reset();
        return tl::unexpected(Error{ErrorCode::above_limit, "steps in a tick", 2.0, 1.0});
      }
      tick.steps |= bit;
      tick.directions = edge_->direction > 0 ? tick.directions | bit : tick.directions & ~bit;
      const Scalar off = static_cast<Scalar>(tick.index) / frequency_ - edge_->time;
      max_jitter_ = std::max(max_jitter_, std::abs(off));
      square_ += off * off;
      ++edges_;
    }
    directions_ = tick.directions;
    return std::optional<Tick>(tick);
  }

  /// Largest difference from the edges' own times so far, s; at most `jitter_bound`.
  [[nodiscard]] Scalar max_jitter() const { return max_jitter_; }
  /// Root mean square of the difference, s; 1/(frequency sqrt(12)) where edges fall anywhere between ticks.
  [[nodiscard]] Scalar rms_jitter() const {
    return edges_ == 0 ? Scalar(0) : std::sqrt(square_ / static_cast<Scalar>(edges_));
  }
  /// Half a tick, s.
  [[nodiscard]] Scalar jitter_bound() const { return Scalar(0.5) / frequency_; }

 private:
  [[nodiscard]] std::int64_t index_of(const BasicEdge<Scalar>& edge) const {
    return count_at(edge.time * frequency_);
  }
  void pull() { edge_ = source_.next(); }

  E source_;
  Scalar frequency_;
  std::optional<BasicEdge<Scalar>> edge_;
  std::uint32_t directions_ = ~std::uint32_t{0};
  Scalar max_jitter_{};
  Scalar square_{};
  std::int64_t edges_ = 0;
};

}  // namespace cncplan::step
