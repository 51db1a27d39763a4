// Exact step times: when the planned position of an axis crosses the boundaries between its steps.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "cncplan/core/concepts.hpp"
#include "cncplan/step/clock.hpp"
#include "cncplan/step/edge.hpp"

namespace cncplan::step {

/// A path that knows where each axis turns round, where it passes a value, and the length travelled to there.
template <class P>
concept SteppablePath = ParametricPath<P> && requires(const P& path, int axis, typename P::Scalar x) {
  { path.length() } -> std::same_as<typename P::Scalar>;
  { path.next_reversal(axis, x) } -> std::same_as<typename P::Scalar>;
  { path.crossing(axis, x, x, x) } -> std::same_as<typename P::Scalar>;
  { path.length_at(x) } -> std::same_as<typename P::Scalar>;
};

/// How an axis turns round. It steps back only once it is `hysteresis` (steps) behind the border, or behind
/// where the block starts: a border that is reached and hardly crossed would else be crossed twice in one
/// instant, which no drive follows.
template <std::floating_point S>
struct Reversal {
  int direction{};        ///< of the axis' last step before the block, 0 if there was none
  S hysteresis{S(1e-4)};  ///< in [0, 1)
};

/// The edges of one axis over one block, in order of time.
///
///   steps   n+1 |- - - - - - - - - - - - - - - -
///               |            ___x___              x: edges, at the boundaries n +- 1/2
///         n+1/2 |---------x-/-------\-x---------
///               |      __/             \__        touched and not crossed: no edge
///             n |- - -/- - - - - - - - - -\- -
///
/// Count n stands for all positions in [n - 1/2, n + 1/2], ends included, so an edge needs the position to go
/// beyond the boundary. Between two reversals the axis goes one way: how many boundaries it crosses follows
/// from the position at the piece's end alone. The count can therefore not drift, whatever rounding does to
/// the single times, and what a block leaves over is taken up at the start of the next. The first edge after
/// a reversal is late by its hysteresis, or comes where the piece ends.
template <SteppablePath P, Clock C>
  requires std::same_as<typename P::Scalar, typename C::Scalar>
class StepCursor {
 public:
  using Scalar = typename P::Scalar;

  /// `count` is the axis' count where the block before ended (`count_at` the start for the first),
  /// `steps_per_unit` > 0; counts stay within +-`most_steps`. The path must outlive the cursor. `goes_on`: a
  /// path follows whose start is this one's end but for rounding, as where a curve is cut; a boundary within
  /// rounding of it is left to that.
  StepCursor(const P& path, const C& clock, int axis, Scalar steps_per_unit, std::int64_t count,
             bool goes_on = false, const Reversal<Scalar>& reversal = {})
      : path_(&path),
        clock_(clock),
        axis_(axis),
        steps_per_unit_(steps_per_unit),
        count_(count),
        goes_on_(goes_on),
        reversal_(reversal),
        parameter_end_(path.parameter_end()),
        target_(steps_at(Scalar(0))) {}
  StepCursor(const P&& path, const C& clock, int axis, Scalar steps_per_unit, std::int64_t count,
             bool goes_on = false, const Reversal<Scalar>& reversal = {}) = delete;

  /// The next edge, until the block's end.
  [[nodiscard]] std::optional<BasicEdge<Scalar>> next() {
    if (taken_ == ready_ && !refill()) return std::nullopt;
    count_ += direction_;
    return BasicEdge<Scalar>{times_[taken_++], axis_, direction_};
  }

  /// Steps taken, those before the block included.
  [[nodiscard]] std::int64_t count() const { return count_; }

 private:
  static constexpr int batch = 32;

  [[nodiscard]] Scalar steps_at(Scalar u) const { return path_->position(u)(axis_) * steps_per_unit_; }

  // Solves for a batch of edges of one piece at a time: independent of each other, they overlap in the
  // processor. Loops only over pieces too short for an edge.
  [[nodiscard]] bool refill() {
    while (left_ == 0)
      if (!open_piece()) return false;
    const Scalar low = parameter_;
    taken_ = 0;
    ready_ = static_cast<std::size_t>(std::min<std::int64_t>(left_, batch));
    left_ -= static_cast<std::int64_t>(ready_);
    const Scalar forward = static_cast<Scalar>(direction_);
    const Scalar first = static_cast<Scalar>(count_) + forward / Scalar(2);
    const std::span<Scalar> edges(times_.data(), ready_);
    for (std::size_t i = 0; i < ready_; ++i) {
      const Scalar boundary = first + forward * static_cast<Scalar>(static_cast<int>(i));
      edges[i] = boundary / steps_per_unit_;
    }
    if (reversal_.direction == -direction_) edges[0] = turned(first) / steps_per_unit_;
    reversal_.direction = direction_;
    std::span<Scalar> ahead = edges;
    while (!ahead.empty() && forward * (ahead.front() * steps_per_unit_ - origin_) <= Scalar(0)) {
      ahead.front() = path_->length_at(low);
      ahead = ahead.subspan(1);
    }
    find_crossings(ahead, low);
    clock_.lengths_to_times(edges);
    for (Scalar& time : edges) time_ = time = std::max(time_, time);
    return true;
  }

  // The border, in steps, that is crossed first after a reversal: not before the hysteresis, nor behind the
  // piece.
  [[nodiscard]] Scalar turned(Scalar border) const {
    const Scalar forward = static_cast<Scalar>(direction_);
    const Scalar late = std::max(forward * border, forward * origin_ + reversal_.hysteresis);
    return forward * std::min(late, std::max(forward * border, forward * target_));
  }

  // Goes on to the next stretch between reversals; false behind the last.
  [[nodiscard]] bool open_piece() {
    if (!(piece_end_ < parameter_end_)) return false;
    parameter_ = piece_end_;
    piece_end_ = std::min(path_->next_reversal(axis_, parameter_), parameter_end_);
    if (!(piece_end_ > parameter_)) piece_end_ = parameter_end_;
    origin_ = target_;
    target_ = steps_at(piece_end_);
    // An axis that stands steps to where it stands, from wherever its count was left.
    direction_ = target_ < (target_ == origin_ ? static_cast<Scalar>(count_) : origin_) ? -1 : 1;
    // An extremum within rounding of a boundary touches it. At the path's end nothing is rounded away.
    constexpr Scalar rounding = 8 * std::numeric_limits<Scalar>::epsilon();
    const Scalar slack = goes_on_ || piece_end_ < parameter_end_
                             ? rounding * std::max(std::abs(origin_), std::abs(target_))
                             : Scalar(0);
    const Scalar reach = std::ceil(static_cast<Scalar>(direction_) * target_ - Scalar(0.5) - slack);
    left_ = std::max<std::int64_t>(count_at(reach) - direction_ * count_, 0);
    return true;
  }

  // Positions to lengths, in place; by the path's own way for many if it has one.
  void find_crossings(std::span<Scalar> values, Scalar low) {
    if (values.empty()) return;
    if constexpr (requires { path_->crossings(axis_, values, low, piece_end_); })
      path_->crossings(axis_, values, low, piece_end_);
    else
      for (Scalar& value : values) value = path_->crossing(axis_, value, low, piece_end_);
    parameter_ = values.back();
    if constexpr (requires { path_->lengths_at(values); })
      path_->lengths_at(values);
    else
      for (Scalar& value : values) value = path_->length_at(value);
  }

  const P* path_;
  C clock_;
  int axis_;
  int direction_ = 1;
  Scalar steps_per_unit_;
  std::int64_t count_;
  bool goes_on_;
  Reversal<Scalar> reversal_;
  std::int64_t left_ = 0;  // edges before the next reversal, those in the batch not counted
  Scalar parameter_end_;
  Scalar parameter_{};  // of the last edge, or where the piece starts
  Scalar piece_end_{};
  Scalar origin_{};  // steps, where the piece starts
  Scalar target_;    // steps, where it ends
  std::array<Scalar, batch> times_{};
  std::size_t taken_ = 0;
  std::size_t ready_ = 0;
  Scalar time_ = -std::numeric_limits<Scalar>::infinity();
};

}  // namespace cncplan::step
