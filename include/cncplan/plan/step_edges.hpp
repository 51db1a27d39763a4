// Every step edge of a trajectory, in order of time, motor by motor (set-up).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "cncplan/plan/steppable.hpp"
#include "cncplan/plan/trajectory.hpp"
#include "cncplan/step/backlash.hpp"
#include "cncplan/step/clock.hpp"
#include "cncplan/step/crossing.hpp"

namespace cncplan {

/// One step of one motor. Motors are numbered in the order of the axes.
template <std::floating_point S>
struct BasicMotorEdge {
  S time{};  ///< s
  std::size_t motor{};
  int axis{};
  int direction{};  ///< +1 or -1

  friend bool operator==(const BasicMotorEdge&, const BasicMotorEdge&) = default;
};

using MotorEdge = BasicMotorEdge<double>;

/// The edges of all motors of a trajectory's machine, those that take up backlash included. A range that is
/// walked once; the trajectory must outlive it.
template <class T>
class StepEdges {
 public:
  using Scalar = typename T::Scalar;
  using Edge = BasicMotorEdge<Scalar>;

  explicit StepEdges(const T& trajectory) : trajectory_(&trajectory) {
    const auto program = trajectory.program();
    for (int axis = 0; axis < T::MachineType::axis_count; ++axis)
      for (const auto& drive : trajectory.machine().axes[static_cast<std::size_t>(axis)].motors) {
        Motor motor;
        motor.axis = axis;
        motor.drive = drive;
        if (!program.empty())
          motor.count =
              step::count_at(program.front().path.position_at(Scalar(0))[axis] * drive.steps_per_unit);
        motors_.push_back(std::move(motor));
      }
  }

  class Iterator {
   public:
    using iterator_concept = std::input_iterator_tag;
    using value_type = Edge;
    using difference_type = std::ptrdiff_t;

    Iterator() = default;
    explicit Iterator(StepEdges& edges) : edges_(&edges), edge_(edges.next()) {}

    [[nodiscard]] const Edge& operator*() const { return *edge_; }
    Iterator& operator++() {
      edge_ = edges_->next();
      return *this;
    }
    void operator++(int) { ++*this; }
    friend bool operator==(const Iterator& it, std::default_sentinel_t) { return !it.edge_; }

   private:
    StepEdges* edges_ = nullptr;
    std::optional<Edge> edge_;
  };

  /// Goes on where the walk stands.
  [[nodiscard]] Iterator begin() { return Iterator(*this); }
  [[nodiscard]] std::default_sentinel_t end() const { return {}; }

  /// The next edge, until there is none.
  [[nodiscard]] std::optional<Edge> next() {
    for (;;) {
      Motor* first = nullptr;
      for (Motor& motor : motors_)
        if (motor.pending && (first == nullptr || motor.pending->time < first->pending->time)) first = &motor;
      if (first != nullptr) {
        const auto edge = *std::exchange(first->pending, first->source->next());
        time_ = std::max(time_, edge.time);
        return Edge{time_, static_cast<std::size_t>(first - motors_.data()), first->axis, edge.direction};
      }
      if (!open_block()) return std::nullopt;
    }
  }

  /// Steps of a motor up to where the walk stands, those for backlash not counted.
  [[nodiscard]] std::int64_t count(std::size_t motor) const {
    return motors_[motor].source ? motors_[motor].source->source().count() : motors_[motor].count;
  }
  [[nodiscard]] std::size_t motor_count() const { return motors_.size(); }

 private:
  using Segment = plan::SteppableSegment<typename T::Block::Path>;
  using Clock = step::PhaseClock<Scalar>;
  using Source = step::BacklashCompensation<step::StepCursor<Segment, Clock>>;

  struct Motor {
    int axis{};
    step::BasicDrive<Scalar> drive;
    std::int64_t count{};
    step::BacklashState<Scalar> slack{};
    std::optional<Source> source;
    std::optional<step::BasicEdge<Scalar>> pending;
  };

  // Goes on to the next block that moves; false behind the last.
  bool open_block() {
    const auto phases = trajectory_->phases();
    for (Motor& motor : motors_)
      if (motor.source) {
        motor.count = motor.source->source().count();
        motor.slack = motor.source->state();
        motor.source.reset();
      }
    while (phase_ < phases.size()) {
      const std::size_t block = phases[phase_].block;
      of_block_.clear();
      for (; phase_ < phases.size() && phases[phase_].block == block; ++phase_)
        of_block_.push_back(phases[phase_].phase);
      const auto& path = trajectory_->program()[block].path;
      if (!(path.length() > Scalar(0))) continue;
      open(path, phase_ < phases.size());
      return true;
    }
    return false;
  }

  // `goes_on`: a path follows. Where curves meet, its start is this one's end but for rounding.
  void open(const typename T::Block::Path& path, bool goes_on) {
    segment_ = Segment(path);
    const bool rounded = path.line() == nullptr && path.arc() == nullptr;
    for (Motor& motor : motors_) {
      const Clock clock{std::span<const BasicPhase<Scalar>>(of_block_)};
      motor.source.emplace(
          step::StepCursor<Segment, Clock>(segment_, clock, motor.axis, motor.drive.steps_per_unit,
                                           motor.count, goes_on && rounded),
          step::backlash_steps(motor.drive), of_block_.front().time, motor.slack);
      motor.pending = motor.source->next();
    }
  }

  const T* trajectory_;
  std::vector<Motor> motors_;
  std::vector<BasicPhase<Scalar>> of_block_;
  Segment segment_;
  std::size_t phase_ = 0;
  Scalar time_ = -std::numeric_limits<Scalar>::infinity();
};

}  // namespace cncplan
