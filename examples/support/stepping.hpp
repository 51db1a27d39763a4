// Turns a plan into step edges at their exact times, and holds them against the planned motion.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "cncplan/cncplan.hpp"
#include "support/failure.hpp"
#include "support/machine_file.hpp"
#include "support/plan.hpp"

namespace support {

/// A path as steps need it: by its own closed forms, or traced.
template <class P>
using Steppable = std::conditional_t<cncplan::step::SteppablePath<P>, P, cncplan::step::TracedPath<P>>;

/// The planned positions at every period, held against the steps up to then.
template <class P, class Paths>
class StepObserver {
 public:
  static constexpr int count = P::Vector::RowsAtCompileTime;
  using Backend = cncplan::step::SimulatedBackend<double, count>;

  StepObserver(const Plan& plan, const Paths& path, double period, Backend& backend)
      : path_(path), cursor_(plan), period_(period), backend_(backend) {}

  void until(double time) {
    while (static_cast<double>(next_) * period_ < time) observe(static_cast<double>(next_++) * period_);
  }
  void observe(double time) {
    const cncplan::plan::Place place = cursor_.at(time);
    const P& path = path_(place.block);
    backend_.observe(path.position(path.parameter_at(place.along)));
  }

 private:
  const Paths& path_;
  PlanCursor cursor_;
  double period_;
  Backend& backend_;
  std::size_t next_ = 0;
};

/// What each axis of the machine has done, in mm, degrees and steps.
using StepReports = std::vector<cncplan::step::AxisReport>;

/// The edges of one axis over a whole plan, in order of time. It stays where it was made.
template <class P, class Paths>
class AxisSteps {
 public:
  using Scalar = double;

  /// `count` steps at the start, `scale` steps per mm or rad of the path.
  AxisSteps(const Plan& plan, const Paths& path, int axis, double scale, std::int64_t count,
            double hysteresis)
      : plan_(plan),
        path_(path),
        pieces_(plan),
        axis_(axis),
        scale_(scale),
        count_(count),
        hysteresis_(hysteresis) {}

  [[nodiscard]] std::optional<cncplan::step::Edge> next() {
    while (cursor_ || enter_next()) {
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
  using Traced = Steppable<P>;
  using Clock = cncplan::step::PhaseClock<double>;

  bool enter_next() {
    const auto driven = pieces_.next();
    if (!driven) return false;
    const P& path = path_(driven->piece);
    const Traced* traced = nullptr;
    if constexpr (cncplan::step::SteppablePath<P>)
      traced = &path;
    else
      traced = &traced_.emplace(path, 2);
    // mapped pieces are cut from curves
    const bool goes_on = cncplan::plan::JointPath<P> && driven->piece + 1 < plan_.lengths.size();
    cursor_.emplace(*traced, Clock(driven->phases, driven->start, driven->origin), axis_, scale_, count_,
                    goes_on, cncplan::step::Reversal<double>{direction_, hysteresis_});
    return true;
  }

  const Plan& plan_;
  const Paths& path_;
  DrivenPieces pieces_;
  int axis_;
  double scale_;
  std::int64_t count_;
  double hysteresis_;
  int direction_ = 0;
  double time_ = 0.0;
  std::optional<Traced> traced_;
  std::optional<cncplan::step::StepCursor<Traced, Clock>> cursor_;
};

/// A source of edges that stays where it is: copies draw from the same.
template <cncplan::step::EdgeSource E>
class EdgeRef {
 public:
  using Scalar = typename E::Scalar;

  explicit EdgeRef(E& source) : source_(&source) {}
  [[nodiscard]] std::optional<cncplan::step::BasicEdge<Scalar>> next() { return source_->next(); }

 private:
  E* source_;
};

/// Which rule of a drive is broken, and what helps.
[[nodiscard]] inline std::string drive_message(const cncplan::step::Violation& broken, char letter) {
  const std::string_view unit = broken.error.field == "step rate" ? "steps/s" : "s";
  return fmt::format(
      "error: axis {} at {:.9f} s: {} of {:.6g} {} {} of {:.6g} {}; slower corners or a lower speed give the "
      "drive more time",
      letter, broken.time, broken.error.field, broken.error.value, unit, message(broken.error.code),
      broken.error.bound, unit);
}

/// Hands every edge to `take`, in order of time, those that make up for backlash included, and those of an
/// inverted drive turned round. `path` gives each piece's path, `where` its place in the program
/// (FILE:LINE:COLUMN). An axis that the machine lacks stands still. Throws `Failure` for a plan that breaks a
/// rule of a drive.
template <class P, class Paths, class Where, class Take>
StepReports make_steps(const Plan& plan, const Machine& machine, double period, const Paths& path,
                       const Where& where, const Take& take) {
  namespace step = cncplan::step;
  constexpr int count = P::Vector::RowsAtCompileTime;
  constexpr auto axes = static_cast<std::size_t>(count);

  std::array<step::Drive, axes> drives{};
  std::array<std::int64_t, axes> counts{}, backlash{};
  cncplan::VectorN<double, count> scale;
  const auto first = path(0).position(0.0);
  for (std::size_t i = 0; i < axes; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (i < machine.axes.size()) drives[i] = machine.axes[i].drive;
    scale[k] = drives[i].steps_per_unit / (i < machine.axes.size() ? machine.axes[i].unit() : 1.0);
    counts[i] = step::count_at(first[k] * scale[k]);
    backlash[i] = step::backlash_steps(drives[i]);
  }
  step::SimulatedBackend<double, count> backend(scale, counts, backlash);
  step::DriveCheck check(drives);
  StepObserver<P, Paths> observer(plan, path, period, backend);
  [&]<std::size_t... Axis>(std::index_sequence<Axis...>) {
    using Steps = AxisSteps<P, Paths>;
    std::array<Steps, axes> steps{Steps(plan, path, static_cast<int>(Axis), scale[static_cast<int>(Axis)],
                                        counts[Axis], step::hysteresis(drives[Axis]))...};
    using Compensated = step::BacklashCompensation<EdgeRef<Steps>>;
    constexpr double any_time = -std::numeric_limits<double>::infinity();
    step::Merge<Compensated, axes> edges(
        {Compensated(EdgeRef<Steps>(steps[Axis]), backlash[Axis], any_time)...});
    while (const auto edge = edges.next()) {
      if (!plan.completed && !(edge->time < plan.duration)) break;  // it does not come so far
      observer.until(edge->time);
      if (const auto kept = check.accept(*edge); !kept)
        throw Failure(Exit::bad_input,
                      fmt::format("{}: {}", where(PlanCursor(plan).at(edge->time).block),
                                  drive_message(kept.error(),
                                                machine.axes[static_cast<std::size_t>(edge->axis)].letter)));
      if (const auto taken = backend.accept(*edge); !taken)
        throw Failure(Exit::other, "steps out of order: " + std::string(taken.error().field));
      step::Edge signal = *edge;
      if (drives[static_cast<std::size_t>(edge->axis)].inverted) signal.direction = -signal.direction;
      take(signal);
    }
  }
  (std::make_index_sequence<axes>());
  observer.until(plan.duration);
  observer.observe(plan.duration);
  StepReports reports;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    auto& report = reports.emplace_back(backend.report(static_cast<int>(i)));
    for (double* value : {&report.position, &report.rms_error, &report.max_error})
      *value = machine.shown(i, *value);
    if (drives[i].inverted) report.net_steps = -report.net_steps;
  }
  return reports;
}

/// The signals of a machine's axes.
[[nodiscard]] inline std::vector<cncplan::step::Trace> traces_of(const Machine& machine) {
  std::vector<cncplan::step::Trace> traces;
  for (const MachineAxis& axis : machine.axes)
    traces.push_back({std::string(1, axis.letter), axis.drive.high_time, axis.drive.direction_setup});
  return traces;
}

}  // namespace support
