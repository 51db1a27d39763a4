// Turns a plan into step edges at their exact times, and holds them against the planned motion.
#include <fmt/format.h>

#include <span>

#include "run.hpp"
#include "stopwatch.hpp"
#include "support/failure.hpp"

namespace simulate {

namespace {

using namespace cncplan;
using support::Exit;
using support::Failure;

using Counts = std::array<std::int64_t, 3>;

// The edges of one axis over one block, with those that make up for its backlash.
using AxisEdges = step::BacklashCompensation<step::StepCursor<path::Segment, step::PhaseClock<double>>>;

// The planned position at every period, held against the steps up to then.
class Observer {
 public:
  Observer(const Program& program, const Plan& plan, double period,
           step::SimulatedBackend<double, 3>& backend)
      : program_(program), cursor_(plan.spans, plan.lengths), period_(period), backend_(backend) {}

  void until(double time) {
    while (static_cast<double>(next_) * period_ < time) observe(static_cast<double>(next_++) * period_);
  }
  void observe(double time) {
    const plan::Place place = cursor_.at(time);
    const path::Segment& segment = program_.blocks[place.block].segment;
    backend_.observe(segment.position(segment.parameter_at(place.along)));
  }

 private:
  const Program& program_;
  plan::Cursor cursor_;
  double period_;
  step::SimulatedBackend<double, 3>& backend_;
  std::size_t next_ = 0;
};

// The drives of X, Y and Z; an axis that the machine lacks stands still.
std::array<step::Drive, 3> drives(const Machine& machine) {
  std::array<step::Drive, 3> result{};
  for (std::size_t i = 0; i < machine.axes.size(); ++i) result[i] = machine.axes[i].drive;
  return result;
}

[[noreturn]] void refuse(const Options& options, const Machine& machine, const step::Violation& broken,
                         int line) {
  throw Failure(
      Exit::bad_input,
      fmt::format("{}:{}:1: error: axis {} at {:.9f} s: {} of {:.6g} {} of {:.6g}", options.program, line,
                  machine.axes[static_cast<std::size_t>(broken.axis)].letter, broken.time, broken.error.field,
                  broken.error.value, message(broken.error.code), broken.error.bound));
}

}  // namespace

void make_steps(const Program& program, const Plan& plan, const Options& options, const Machine& machine,
                Measures& measures, const std::function<void(const step::Edge&)>& take) {
  const Stopwatch watch(measures.steps_seconds);
  const std::array<step::Drive, 3> drive = drives(machine);
  Counts counts{}, backlash{};
  Vector3 scale;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = static_cast<int>(i);
    scale[axis] = drive[i].steps_per_unit;
    counts[i] = step::count_at(program.blocks.front().segment.start()[axis] * scale[axis]);
    backlash[i] = step::backlash_steps(drive[i]);
  }
  step::SimulatedBackend<double, 3> backend(scale, counts, backlash);
  step::DriveCheck check(drive);
  Observer observer(program, plan, options.period, backend);
  std::array<step::BacklashState<double>, 3> slack{};
  double start = 0.0, last = 0.0;
  for (const plan::Span& span : plan.spans) {
    const auto phases = span.profile.phases();
    double origin = 0.0;
    for (std::size_t i = span.first; i < span.first + span.count; ++i) {
      const path::Segment& segment = program.blocks[i].segment;
      const step::PhaseClock<double> clock(phases, start, origin);
      const auto axis_edges = [&](std::size_t axis) {
        return AxisEdges({segment, clock, static_cast<int>(axis), drive[axis].steps_per_unit, counts[axis]},
                         backlash[axis], plan.timings[i].start, slack[axis]);
      };
      step::Merge<AxisEdges, 3> edges({axis_edges(0), axis_edges(1), axis_edges(2)}, last);
      while (const auto edge = edges.next()) {
        last = edge->time;
        observer.until(last);
        if (const auto kept = check.accept(*edge); !kept)
          refuse(options, machine, kept.error(), program.origins[i].line);
        if (const auto taken = backend.accept(*edge); !taken)
          throw Failure(Exit::other, "steps out of order: " + std::string(taken.error().field));
        take(*edge);
      }
      for (std::size_t axis = 0; axis < 3; ++axis) {
        counts[axis] = edges.sources()[axis].source().count();
        slack[axis] = edges.sources()[axis].state();
      }
      origin += plan.lengths[i];
    }
    start += span.profile.duration();
  }
  observer.until(plan.duration);
  observer.observe(plan.duration);
  for (std::size_t i = 0; i < 3; ++i) measures.steps[i] = backend.report(static_cast<int>(i));
}

}  // namespace simulate
