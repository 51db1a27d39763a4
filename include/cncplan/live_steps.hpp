// Step edges of an executor that runs, motor by motor, at exact times within each tick.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "cncplan/core/detail/fixed_list.hpp"
#include "cncplan/executor.hpp"
#include "cncplan/motor_edge.hpp"
#include "cncplan/step/backlash.hpp"
#include "cncplan/step/crossing.hpp"
#include "cncplan/step/detail/traced_path.hpp"

namespace cncplan {

namespace detail {

/// What `LiveSteps` does, compiled once for a machine and its blocks: `C` is an executor's core.
template <class C>
class LiveStepsCore {
 public:
  using Scalar = typename C::Scalar;
  using Edge = BasicMotorEdge<Scalar>;
  using SetPoint = typename C::SetPoint;
  static constexpr std::size_t most_parts = 64;

  explicit LiveStepsCore(C& executor) : executor_(&executor) {
    for (int axis = 0; axis < C::MachineType::axis_count; ++axis)
      for (const auto& drive : executor.machine().axes[static_cast<std::size_t>(axis)].motors) {
        motors_[motor_count_].axis = axis;
        motors_[motor_count_++].drive = drive;
      }
  }

  /// Moves on by `period` seconds. Edges of the tick before that were not asked for come late, at the start
  /// of this one.
  SetPoint tick(Scalar period);

  /// The next edge of the tick, in order of time; its time counts as that of set points.
  [[nodiscard]] std::optional<Edge> next();

  /// Steps of a motor, those for backlash not counted, up to the edges that were given out.
  [[nodiscard]] std::int64_t count(std::size_t motor) const {
    const Motor& m = motors_[motor];
    return m.source ? m.source->source().count() : m.count;
  }
  [[nodiscard]] std::size_t motor_count() const { return motor_count_; }

 private:
  // Lengths of a part are seconds.
  struct Shift {
    using Scalar = typename C::Scalar;
    Scalar start{};
    void lengths_to_times(std::span<Scalar> lengths) const {
      for (Scalar& length : lengths) length += start;
    }
  };
  using Traced = step::TracedPath<typename C::Part>;
  using Source = step::BacklashCompensation<step::StepCursor<Traced, Shift>>;

  struct Motor {
    int axis{};
    step::BasicDrive<Scalar> drive;
    std::int64_t count{};
    step::BacklashState<Scalar> slack{};
    std::optional<Source> source;
    std::optional<step::BasicEdge<Scalar>> pending;
  };

  [[nodiscard]] std::span<Motor> motors() { return {motors_.data(), motor_count_}; }

  void close(Motor& motor) {
    if (!motor.source) return;
    motor.count = motor.source->source().count();
    motor.slack = motor.source->state();
    motor.source.reset();
    motor.pending.reset();
  }

  void open(const typename C::Part& part);
  void count_from(const typename SetPoint::Vector& place) {
    for (Motor& motor : motors())
      motor.count = step::count_at(place[motor.axis] * motor.drive.steps_per_unit);
    counted_ = true;
  }
  [[nodiscard]] bool has_pending() const {
    return std::ranges::any_of(motors_, [](const Motor& motor) { return motor.pending.has_value(); });
  }

  C* executor_;
  std::array<Motor, BasicMotors<Scalar>::capacity* static_cast<std::size_t>(C::MachineType::axis_count)>
      motors_{};
  std::size_t motor_count_ = 0;
  FixedList<typename C::Part, most_parts> parts_;
  std::size_t part_ = 0;
  bool full_ = false;                                           // there was no room for all parts
  typename SetPoint::Vector place_ = SetPoint::Vector::Zero();  // where they ended
  Scalar start_{};                                              // s, of the tick
  typename C::Part open_part_;
  std::optional<Traced> traced_;
  bool counted_ = false;  // the motors know where they are
};

template <class C>
auto LiveStepsCore<C>::tick(Scalar period) -> SetPoint {
  const bool lags = full_ || part_ < parts_.size() || has_pending();
  start_ = executor_->time();
  parts_.clear();
  part_ = 0;
  full_ = false;
  if (lags) parts_.push_back(typename C::Part(place_));
  for (Motor& motor : motors()) close(motor);
  const SetPoint point = executor_->tick(
      period, [this](const typename C::Part& part) { full_ = !parts_.push_back(part) || full_; });
  if (!parts_.empty()) {
    if (!counted_) count_from(parts_[0].position(Scalar(0)));
    const typename C::Part& last = parts_[parts_.size() - 1];
    const Scalar left = (last.position(last.length()) - point.position).cwiseAbs().maxCoeff();
    full_ = full_ || left > Scalar(2e-6);  // the executor had no room for all of them
  }
  place_ = point.position;
  return point;
}

template <class C>
auto LiveStepsCore<C>::next() -> std::optional<Edge> {
  for (;;) {
    Motor* first = nullptr;
    for (Motor& motor : motors())
      if (motor.pending && (first == nullptr || motor.pending->time < first->pending->time)) first = &motor;
    if (first != nullptr) {
      const auto edge = *std::exchange(first->pending, first->source->next());
      return Edge{edge.time, static_cast<std::size_t>(first - motors_.data()), first->axis, edge.direction};
    }
    if (part_ == parts_.size()) return std::nullopt;
    open(parts_[part_++]);
  }
}

template <class C>
void LiveStepsCore<C>::open(const typename C::Part& part) {
  constexpr int pieces = 4;
  open_part_ = part;
  traced_.emplace(open_part_, pieces);
  const Shift clock{start_ + part.start()};
  for (Motor& motor : motors()) {
    close(motor);
    motor.source.emplace(
        step::StepCursor<Traced, Shift>(*traced_, clock, motor.axis, motor.drive.steps_per_unit, motor.count,
                                        true, {motor.slack.direction, step::hysteresis(motor.drive)}),
        step::backlash_steps(motor.drive), clock.start, motor.slack);
    motor.pending = motor.source->next();
  }
}

}  // namespace detail

/// Ticks an executor and gives the edges of all motors over each tick, those that take up backlash included.
/// The executor must outlive it. What an edge of the last tick would be is known until the next request.
///
///     LiveSteps steps(executor);
///     const auto point = steps.tick(0.001);
///     while (const auto edge = steps.next()) ...
///
/// Backlash is taken up within the part of a tick in which an axis turns round: whether the drive keeps up is
/// for `step::DriveCheck` to say. Of a tick with more than `most_parts` changes of jerk or block, the edges
/// of what has no room come with the next tick.
template <class E>
class LiveSteps : public detail::LiveStepsCore<typename E::Core> {
 public:
  explicit LiveSteps(E& executor) : detail::LiveStepsCore<typename E::Core>(executor) {}
};

}  // namespace cncplan
