// Every step edge of a trajectory, in order of time, motor by motor (set-up).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "cncplan/detail/steppable.hpp"
#include "cncplan/motor_edge.hpp"
#include "cncplan/step/backlash.hpp"
#include "cncplan/step/clock.hpp"
#include "cncplan/step/crossing.hpp"
#include "cncplan/step/drive.hpp"
#include "cncplan/trajectory.hpp"

namespace cncplan {

namespace detail {

/// The edges of one motor over a whole trajectory, in order of time; none for backlash.
template <class T>
class MotorSteps {
 public:
  using Scalar = typename T::Scalar;

  MotorSteps(const T& trajectory, int axis, const step::BasicDrive<Scalar>& drive)
      : trajectory_(&trajectory),
        axis_(axis),
        scale_(drive.steps_per_unit),
        hysteresis_(step::hysteresis(drive)) {
    if (!trajectory.program().empty())
      count_ = step::count_at(trajectory.program().front().path.position_at(Scalar(0))[axis] * scale_);
  }

  [[nodiscard]] std::optional<step::BasicEdge<Scalar>> next() {
    while (cursor_ || open_piece()) {
      if (auto edge = cursor_->next()) {
        // rounding may put a first edge a bit before the last one of the piece before
        edge->time = time_ = std::max(edge->time, time_);
        direction_ = edge->direction;
        return edge;
      }
      count_ = cursor_->count();
      cursor_.reset();
    }
    return std::nullopt;
  }

 private:
  using Segment = detail::SteppableSegment<typename T::DrivenPath>;
  using Clock = step::PhaseClock<Scalar>;

  // Goes on to the next piece that moves; false behind the last.
  bool open_piece() {
    const auto phases = trajectory_->phases();
    while (phase_ < phases.size()) {
      const std::size_t piece = phases[phase_].piece;
      of_piece_.clear();
      for (; phase_ < phases.size() && phases[phase_].piece == piece; ++phase_)
        of_piece_.push_back(phases[phase_].phase);
      path_ = trajectory_->path(piece);
      if (!(path_.length() > Scalar(0))) continue;
      segment_ = Segment(path_);
      const auto* programmed = path_.programmed();
      const bool curve =
          programmed == nullptr || (programmed->line() == nullptr && programmed->arc() == nullptr);
      // where curves meet, the start of one is the end of the one before but for rounding
      const bool goes_on = phase_ < phases.size() && curve;
      cursor_.emplace(segment_, Clock(std::span<const BasicPhase<Scalar>>(of_piece_)), axis_, scale_, count_,
                      goes_on, step::Reversal<Scalar>{direction_, hysteresis_});
      return true;
    }
    return false;
  }

  const T* trajectory_;
  int axis_;
  Scalar scale_;
  Scalar hysteresis_;
  std::int64_t count_{};
  int direction_ = 0;
  Scalar time_ = Scalar(0);
  std::size_t phase_ = 0;
  std::vector<BasicPhase<Scalar>> of_piece_;
  typename T::DrivenPath path_;
  Segment segment_;  // of that
  std::optional<step::StepCursor<Segment, Clock>> cursor_;
};

}  // namespace detail

/// The edges of all motors of a trajectory's machine, those that take up backlash included. A range that is
/// walked once; the trajectory must outlive it. Of a program that was stopped on its way, it ends with that.
template <class T>
class StepEdges {
 public:
  using Scalar = typename T::Scalar;
  using Edge = BasicMotorEdge<Scalar>;

  explicit StepEdges(const T& trajectory)
      : duration_(trajectory.duration()), stopped_(!trajectory.completed()) {
    constexpr Scalar any_time = -std::numeric_limits<Scalar>::infinity();
    for (int axis = 0; axis < T::MachineType::axis_count; ++axis)
      for (const auto& drive : trajectory.machine().axes[static_cast<std::size_t>(axis)].motors) {
        steps_.push_back(std::make_unique<Steps>(trajectory, axis, drive));
        motors_.push_back(
            {axis, Compensated(Source{steps_.back().get()}, step::backlash_steps(drive), any_time)});
        motors_.back().pending = motors_.back().source.next();
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
    Motor* first = nullptr;
    for (Motor& motor : motors_)
      if (motor.pending && (first == nullptr || motor.pending->time < first->pending->time)) first = &motor;
    if (first == nullptr || (stopped_ && !(first->pending->time < duration_))) return std::nullopt;
    const auto edge = *std::exchange(first->pending, first->source.next());
    return Edge{edge.time, static_cast<std::size_t>(first - motors_.data()), first->axis, edge.direction};
  }
  [[nodiscard]] std::size_t motor_count() const { return motors_.size(); }

 private:
  using Steps = detail::MotorSteps<T>;

  // Steps that stay where they are: what a cursor points to must not move.
  struct Source {
    using Scalar = typename T::Scalar;

    Steps* steps;

    [[nodiscard]] std::optional<step::BasicEdge<Scalar>> next() { return steps->next(); }
  };
  using Compensated = step::BacklashCompensation<Source>;

  struct Motor {
    int axis{};
    Compensated source;
    std::optional<step::BasicEdge<Scalar>> pending{};
  };

  std::vector<std::unique_ptr<Steps>> steps_;
  std::vector<Motor> motors_;
  Scalar duration_;
  bool stopped_;
};

}  // namespace cncplan
