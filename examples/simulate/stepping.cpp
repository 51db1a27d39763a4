// Turns a plan into step edges at their exact times, and holds them against the planned motion.
#include <span>

#include "failure.hpp"
#include "run.hpp"
#include "stopwatch.hpp"

namespace simulate {

namespace {

using namespace cncplan;

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

}  // namespace

void make_steps(const Program& program, const Plan& plan, const Options& options, const Machine& machine,
                Measures& measures, const std::function<void(const step::Edge&)>& take) {
  const Stopwatch watch(measures.steps_seconds);
  std::array<double, 3> steps_per_unit{};
  std::array<std::int64_t, 3> counts{};
  Vector3 scale;
  for (std::size_t i = 0; i < 3; ++i) {
    steps_per_unit[i] = scale[static_cast<int>(i)] = machine.axes[i].steps_per_unit;
    counts[i] =
        step::count_at(program.blocks.front().segment.start()[static_cast<int>(i)] * steps_per_unit[i]);
  }
  step::SimulatedBackend<double, 3> backend(scale, counts);
  Observer observer(program, plan, options.period, backend);
  double start = 0.0;
  for (const plan::Span& span : plan.spans) {
    const auto phases = span.profile.phases();
    double origin = 0.0;
    for (std::size_t i = span.first; i < span.first + span.count; ++i) {
      const step::PhaseClock clock(std::span<const Phase>(phases), start, origin);
      auto edges = step::block_edges(program.blocks[i].segment, clock, steps_per_unit, counts);
      while (const auto edge = edges.next()) {
        observer.until(edge->time);
        if (const auto taken = backend.accept(*edge); !taken)
          throw Failure(Exit::other, "steps out of order: " + std::string(taken.error().field));
        take(*edge);
      }
      counts = step::counts(edges);
      origin += plan.lengths[i];
    }
    start += span.profile.duration();
  }
  observer.until(plan.duration);
  observer.observe(plan.duration);
  for (std::size_t i = 0; i < 3; ++i) measures.steps[i] = backend.report(static_cast<int>(i));
}

}  // namespace simulate
