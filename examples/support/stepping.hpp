// Turns a plan into step edges at their exact times, and holds them against the planned motion.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "cncplan/cncplan.hpp"
#include "support/failure.hpp"
#include "support/machine_file.hpp"
#include "support/plan.hpp"

namespace support {

/// A path as steps need it: by its own closed forms, or traced.
template <class P>
using Steppable = std::conditional_t<cncplan::step::SteppablePath<P>, const P&, cncplan::step::TracedPath<P>>;

template <class P>
[[nodiscard]] Steppable<P> steppable(const P& path) {
  if constexpr (cncplan::step::SteppablePath<P>)
    return path;
  else
    return cncplan::step::TracedPath<P>(path, 2);
}

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

/// Hands every edge to `take`, in order of time, those that make up for backlash included. `path` gives each
/// piece's path, `where` its place in the program (FILE:LINE:COLUMN). An axis that the machine lacks stands
/// still. Throws `Failure` for a plan that breaks a rule of a drive.
template <class P, class Paths, class Where, class Take>
StepReports make_steps(const Plan& plan, const Machine& machine, double period, const Paths& path,
                       const Where& where, const Take& take) {
  namespace step = cncplan::step;
  constexpr int count = P::Vector::RowsAtCompileTime;
  constexpr auto axes = static_cast<std::size_t>(count);
  using Traced = std::remove_cvref_t<Steppable<P>>;
  using AxisEdges = step::BacklashCompensation<step::StepCursor<Traced, step::PhaseClock<double>>>;
  using Merged = step::Merge<AxisEdges, axes>;

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
  std::array<step::BacklashState<double>, axes> slack{};
  double last = 0.0;
  plan.each_piece([&](std::size_t i, std::span<const cncplan::Phase> phases, double start, double origin) {
    const Traced& traced = steppable(path(i));
    const step::PhaseClock<double> clock(phases, start, origin);
    // mapped pieces are cut from curves
    const bool goes_on = cncplan::plan::JointPath<P> && i + 1 < plan.lengths.size();
    const auto axis_edges = [&](std::size_t axis) {
      return AxisEdges(
          {traced, clock, static_cast<int>(axis), scale[static_cast<int>(axis)], counts[axis], goes_on},
          backlash[axis], plan.timings[i].start, slack[axis]);
    };
    Merged edges = [&]<std::size_t... Axis>(std::index_sequence<Axis...>) {
      return Merged({axis_edges(Axis)...}, last);
    }
    (std::make_index_sequence<axes>());
    while (const auto edge = edges.next()) {
      if (!plan.completed && !(edge->time < plan.duration)) break;  // it does not come so far
      last = edge->time;
      observer.until(last);
      if (const auto kept = check.accept(*edge); !kept) {
        const step::Violation& broken = kept.error();
        throw Failure(Exit::bad_input,
                      fmt::format("{}: error: axis {} at {:.9f} s: {} of {:.6g} {} of {:.6g}", where(i),
                                  machine.axes[static_cast<std::size_t>(broken.axis)].letter, broken.time,
                                  broken.error.field, broken.error.value, message(broken.error.code),
                                  broken.error.bound));
      }
      if (const auto taken = backend.accept(*edge); !taken)
        throw Failure(Exit::other, "steps out of order: " + std::string(taken.error().field));
      take(*edge);
    }
    for (std::size_t axis = 0; axis < axes; ++axis) {
      counts[axis] = edges.sources()[axis].source().count();
      slack[axis] = edges.sources()[axis].state();
    }
  });
  observer.until(plan.duration);
  observer.observe(plan.duration);
  StepReports reports;
  for (std::size_t i = 0; i < machine.axes.size(); ++i) {
    auto& report = reports.emplace_back(backend.report(static_cast<int>(i)));
    for (double* value : {&report.position, &report.rms_error, &report.max_error})
      *value = machine.shown(i, *value);
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
