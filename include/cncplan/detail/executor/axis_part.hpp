// The axes over a part of a tick, by time.
#pragma once

#include <algorithm>
#include <optional>

#include "cncplan/block.hpp"
#include "cncplan/core/path_point.hpp"
#include "cncplan/core/phase.hpp"
#include "cncplan/detail/curve/smoothed.hpp"
#include "cncplan/detail/executor/jog.hpp"
#include "cncplan/detail/executor/level_driver.hpp"

namespace cncplan::detail {

/// What the axes do over a part of a tick: constant jerk along the path of one block, a jog, or a rest. Its
/// parameter, and its length, are seconds from its start. What it points to belongs to the executor, which
/// changes it at the next tick or request.
template <MachineModel M, BlockModel B>
class AxisPart {
 public:
  using Scalar = typename M::Scalar;
  using Vector = VectorN<Scalar, M::axis_count>;
  using Driven = Smoothed<typename B::Path>;

  AxisPart() = default;
  /// Along a block's path from `from` on, forwards or backwards.
  AxisPart(const Driven& path, const BasicPhase<Scalar>& phase, Scalar from, int direction)
      : path_(path), phase_(phase), from_(from), direction_(direction) {}
  /// By a jog, which is `behind` seconds past the part's start.
  AxisPart(const Jog<M>& jog, Scalar behind)
      : jog_(&jog), phase_{Scalar(0), behind, Scalar(0), Scalar(0), Scalar(0), Scalar(0)}, from_(behind) {}

  /// By a clock.
  AxisPart(const LevelDriver<M, B>& level, const BasicTickPart<Scalar>& part)
      : level_(&level),
        phase_{part.start, part.duration, Scalar(0), Scalar(0), Scalar(0), Scalar(0)},
        from_(part.start) {}
  /// At rest for a second from the start of the tick, for steps that were left over.
  explicit AxisPart(const Vector& position)
      : rest_(position), phase_{Scalar(0), Scalar(1), Scalar(0), Scalar(0), Scalar(0), Scalar(0)} {}

  /// Seconds from the start of the tick.
  [[nodiscard]] Scalar start() const { return phase_.time; }
  [[nodiscard]] Scalar length() const { return phase_.duration; }
  [[nodiscard]] Scalar parameter_end() const { return phase_.duration; }
  [[nodiscard]] Scalar length_at(Scalar t) const { return t; }
  [[nodiscard]] Vector position(Scalar t) const { return at(t).position; }
  [[nodiscard]] Vector derivative(Scalar t) const { return at(t).velocity; }
  [[nodiscard]] Vector second_derivative(Scalar t) const { return at(t).acceleration; }

 private:
  [[nodiscard]] AxisMotion<Vector> at(Scalar t) const {
    if (rest_) return {*rest_, Vector::Zero(), Vector::Zero(), Vector::Zero()};
    if (jog_ != nullptr) return jog_->at(t - from_);
    if (level_ != nullptr) return level_->axes_at(from_ + t);
    const auto sense = static_cast<Scalar>(direction_);
    BasicState<Scalar> state = phase_.at(t);
    state.position = std::clamp(from_ + sense * state.position, Scalar(0), path_.length());
    state.velocity *= sense;
    state.acceleration *= sense;
    state.jerk *= sense;
    return motion(path_.point_at(state.position), state);
  }

  Driven path_;
  std::optional<Vector> rest_;
  const Jog<M>* jog_ = nullptr;
  const LevelDriver<M, B>* level_ = nullptr;
  BasicPhase<Scalar> phase_{};
  Scalar from_{};
  int direction_ = 1;
};

}  // namespace cncplan::detail
