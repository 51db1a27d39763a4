// What each room does while the machine runs: built without exceptions and run-time type information, and
// each job's heap allocations are counted. The results are checked elsewhere; here they are only kept from
// the optimiser.
#include <array>
#include <cstdint>
#include <cstdio>
#include <span>
#include <string_view>

#include "cncplan/block_builder.hpp"
#include "cncplan/block_reader.hpp"
#include "cncplan/detail/speed/cell_maker.hpp"
#include "cncplan/detail/speed/span_planner.hpp"
#include "cncplan/executor.hpp"
#include "cncplan/gcode/reader.hpp"
#include "cncplan/interpolate/exact.hpp"
#include "cncplan/junction/acceleration_step.hpp"
#include "cncplan/junction/deviation.hpp"
#include "cncplan/junction/exact_stop.hpp"
#include "cncplan/junction/minimum.hpp"
#include "cncplan/junction/tangent_step.hpp"
#include "cncplan/kinematics/polar.hpp"
#include "cncplan/kinematics/tire_mold/row.hpp"
#include "cncplan/live_steps.hpp"
#include "cncplan/move_to.hpp"
#include "cncplan/path/arc_from_center.hpp"
#include "cncplan/path/arc_from_radius.hpp"
#include "cncplan/path/segment.hpp"
#include "cncplan/profile/five_phase.hpp"
#include "cncplan/profile/laws.hpp"
#include "cncplan/profile/seven_phase.hpp"
#include "cncplan/published/junction_table.hpp"
#include "cncplan/step/backend.hpp"
#include "cncplan/step/backlash.hpp"
#include "cncplan/step/binary.hpp"
#include "cncplan/step/detail/traced_path.hpp"
#include "cncplan/step/fixed_tick.hpp"
#include "cncplan/step/merge.hpp"
#include "support/no_heap.hpp"

using namespace cncplan;

namespace {

volatile double sink = 0.0;

constexpr Limits limits{.velocity = 30.0, .acceleration = 1000.0, .jerk = 10000.0};

path::Arc helix() {
  return *path::arc_from_radius<double>({0, 0, 0}, {5, 5, 2}, 5.0, Turn::clockwise, Plane::xy);
}

// Readers are set up before the machine moves; what they read then costs nothing.
gcode::Reader reader, reader_of_plan;

void read_lines() {
  std::array<gcode::Item, gcode::max_items_per_line> items;
  for (const std::string_view line : {"N10 G21 G90 F600 (millimetres)", "G1 X10 Y5", "G2 X20 Y5 R10",
                                      "G3 I2.5", "G1 X1..5", "G4 P0.5", "M3 S8000"})
    sink = reader.read_line(line, items.begin()).has_value() ? 1.0 : 0.0;
}

void make_arcs() {
  const auto impossible =
      path::arc_from_radius<double>({0, 0, 0}, {50, 0, 0}, 5.0, Turn::clockwise, Plane::xy);
  sink = helix().length() + impossible.error().bound;
}

void evaluate_a_segment() {
  const path::Segment<3> segment = helix();
  double sum = 0.0;
  for (int i = 0; i <= 100; ++i) {
    const double u = segment.parameter_at(segment.length() * i / 100.0);
    sum += segment.position(u).sum() + segment.derivative(u).sum() + segment.second_derivative(u).sum();
  }
  sink = sum;
}

void judge_a_junction() {
  const auto policy =
      junction::minimum(junction::ExactStop{}, junction::Deviation{0.01}, junction::TangentStep{5.0},
                        junction::AccelerationStep{500.0}, published::JunctionTable{});
  junction::Geometry junction{.before = {}, .after = {}, .limits = limits};
  junction.before.tangent = Vector3::UnitX();
  junction.after.tangent = Vector3::UnitY();
  sink = policy.speed_sq(junction);
}

void plan_profiles() {
  double sum = 0.0;
  for (double length = 0.01; length < 100.0; length *= 1.5)
    for (const double end : {0.0, 10.0, 30.0}) {
      const auto five = profile::five_phase(length, {.start = 5.0, .end = end}, limits);
      const auto seven = profile::seven_phase(length, {.start = 5.0, .end = end}, limits);
      sum += five ? five->at(five->duration() / 3.0).position : five.error().bound;
      sum += seven ? seven->time_at(length / 3.0) : seven.error().bound;
    }
  sink = sum;
}

void move_axes() {
  const Axis slide{.velocity = 30.0, .acceleration = 300.0, .jerk = 10000.0, .low = 0.0, .high = 100.0};
  const Machine<3> machine{.axes = {slide, slide, slide}};
  const AxisStates<3> now{.position = {10, 20, 30}, .velocity = {1, -2, 3}, .acceleration = {50, 0, -50}};
  const auto move = move_to(now, {40, 50, 5}, machine);
  const auto jog = reach_velocity(now.axis(0), 20.0, slide);
  const auto beyond = move_to(now.axis(0), 101.0, slide);
  sink = move->at(0.1).position[0] + jog->extrema().highest + *jog->time_at(50.0) + beyond.error().bound;
}

void sample_a_block() {
  const path::Arc arc = helix();
  const auto profile = profile::seven_phase(arc.length(), {.start = 0.0, .end = 0.0}, limits);
  double sum = 0.0;
  for (const auto& sample : interpolate::samples(arc, *profile, 1e-3)) sum += sample.position.x();
  sink = sum;
}

void step_a_block() {
  const path::Arc arc = helix();
  const auto phases = profile::seven_phase(arc.length(), {.start = 0.0, .end = 0.0}, limits)->phases();
  const std::array steps_per_unit{400.0, 400.0, 400.0};
  auto edges =
      step::block_edges(arc, step::PhaseClock(phases), steps_per_unit, std::array<std::int64_t, 3>{});
  step::SimulatedBackend<double, 3> backend(Vector3::Constant(400.0));
  while (const auto edge = edges.next())
    if (!backend.accept(*edge)) break;
  sink = static_cast<double>(step::counts(edges)[0]);
}

void step_a_traced_curve() {
  const path::Arc arc = helix();
  const auto phases = profile::seven_phase(arc.length(), {.start = 0.0, .end = 0.0}, limits)->phases();
  const step::TracedPath traced(arc);
  const step::PhaseClock clock(phases);
  const auto axis = [&](int i) {
    return step::BacklashCompensation(step::StepCursor(traced, clock, i, 400.0, 0), 3, 0.0);
  };
  const auto edges = [&] { return step::Merge(std::array{axis(0), axis(1), axis(2)}, 0.0); };

  step::FixedTicks ticks(edges(), 1e6);
  for (auto tick = ticks.next(); tick && *tick; tick = ticks.next()) sink = (*tick)->steps;

  std::array<std::uint8_t, 65536> bytes;
  step::BinaryWriter writer(bytes.data());
  auto source = edges();
  sink = step::send(source, writer).has_value() ? static_cast<double>(writer.finish() - bytes.data()) : 0.0;
}

// Joints of a point, and of one that moves, with their derivatives.
template <class C>
double by_map(const C& map) {
  double sum = 0.0;
  for (int i = 0; i <= 100; ++i) {
    const double u = i / 100.0;
    for (const double joint : map.joints(std::array{u, 1.0, 2.0})) sum += joint;
    for (const Jet& joint : map.joints(std::array{Jet(u, 1.0, 0.0, 0.0), Jet(1.0), Jet(2.0)}))
      sum += joint.first + joint.third;
  }
  return sum;
}

void map_by_maps() {
  const kinematics::TireMold machine{.tool_length = 134.0};
  const auto row = kinematics::tire_mold_row(machine, {244.0, 134.0, 0.0, 0.1}, {245.0, 133.0, 0.2, 0.5});
  sink = by_map(kinematics::PolarMap{kinematics::Azimuth(0.0, 1.0, 0.0)}) + by_map(row) +
         row.measured(std::array{Jet(0.5, 1.0, 0.0, 0.0), Jet(), Jet()})[0].first;
}

const Machine<3> mill{.limits = limits, .rapid_rate = 50.0};
BlockBuilder<Machine<3>> builder(mill, dialect_of(mill));

// G-code to blocks, and the caps of each of their cells to `take`.
template <class Take>
void make_cells(gcode::Reader& program, const Take& take) {
  std::array<gcode::Item, gcode::max_items_per_line> items;
  const junction::Deviation rounded{0.01};
  detail::CellMaker<Machine<3>, ProgramBlock<Machine<3>>> maker(mill, {rounded, 0.01, 0.0});
  for (const std::string_view line : {"G21 G90 F1200", "G1 X10", "G3 X15 Y5 R5", "G4 P0.01", "G1 Y10", "X0",
                                      "Y0", "X5", "Y5", "X0", "Y0"}) {
    const auto end = program.read_line(line, items.begin());
    for (const gcode::Item* item = items.begin(); item != *end; ++item) {
      const auto block = builder.take(*item);
      if (!*block || !maker.begin(**block)) continue;
      while (!maker.done()) {
        if (!maker.next()) break;
        const auto& cell = maker.cell();
        take(**block,
             detail::SegmentLimits{cell.part.to - cell.part.from, cell.entry, cell.part.limits, 0.0});
      }
      if ((*block)->pause > 0.0) take(**block, detail::SegmentLimits{0.0, 0.0, limits, (*block)->pause});
    }
  }
}

void plan_a_program() {
  std::array<detail::SegmentLimits, 64> caps;
  std::array<detail::ConstrainedJunction, 65> junctions;
  std::array<detail::Span, 64> spans;
  std::size_t count = 0;
  make_cells(reader_of_plan, [&](const ProgramBlock<Machine<3>>&, const detail::SegmentLimits& cell) {
    if (count < caps.size()) caps[count++] = cell;
  });
  sink = detail::plan_spans(std::span<const detail::SegmentLimits>(caps.data(), count), profile::SevenPhase{},
                            std::span<detail::ConstrainedJunction>(junctions), spans.begin())
             ? 1.0
             : 0.0;
}

constexpr Machine<3> stepping_mill{
    .axes = {{{.letter = 'X',
               .velocity = 50,
               .acceleration = 1000,
               .jerk = 20000,
               .motors = {{.steps_per_unit = 400}}},
              {.letter = 'Y', .velocity = 50, .acceleration = 1000, .jerk = 20000},
              {.letter = 'Z', .velocity = 20, .acceleration = 300, .jerk = 5000}}},
    .limits = limits};
BlockReader mill_reader(stepping_mill);
Executor<Machine<3>, 16> executor(stepping_mill);

void run_a_program() {
  LiveSteps steps(executor);
  const auto tick = [&] {
    sink = steps.tick(1e-3).velocity[0];
    while (const auto edge = steps.next()) sink = edge->time;
  };
  for (const std::string_view line :
       {"G21 G90 F1200 M3 S100", "G1 X10", "G3 X15 Y5 R5", "G4 P0.01", "G1 Y150 X1..5", "X0", "M30"}) {
    const auto blocks = mill_reader.read_line(line);
    if (!blocks) continue;
    for (const auto& block : *blocks)
      while (!executor.push(block)) tick();
    executor.feed_override(1.5);
  }
  executor.end_of_program();
  while (!executor.finished()) tick();
  sink = executor.jog_to({1, 2, 3}) ? 1.0 : 0.0;
  for (int i = 0; i < 1000; ++i) tick();
}

struct Job {
  const char* name;
  void (*run)();
};

constexpr std::array jobs{
    Job{"gcode: lines, one of them wrong", read_lines},
    Job{"path: arcs from their radius, possible or not", make_arcs},
    Job{"path: a segment evaluated by length", evaluate_a_segment},
    Job{"junction: a corner, by the lowest of all policies", judge_a_junction},
    Job{"profile: five and seven phases, possible or not", plan_profiles},
    Job{"state: axes from state to state, a jog, a target beyond the travel", move_axes},
    Job{"interpolate: the samples of a helix", sample_a_block},
    Job{"plan: G-code through look-ahead", plan_a_program},
    Job{"plan: G-code run, with its steps, and a jog", run_a_program},
    Job{"kinematics: joints of points and of motions, by maps", map_by_maps},
    Job{"step: the edges of a helix, simulated", step_a_block},
    Job{"step: a curve traced, backlash made up, as ticks and bytes", step_a_traced_curve},
};

}  // namespace

int main() {
  std::printf("%-60s %s\n", "job", "heap allocations");
  bool clean = true;
  for (const Job& job : jobs) {
    const std::size_t count = test::heap_allocations_of(job.run);
    std::printf("%-60s %zu\n", job.name, count);
    clean = clean && count == 0;
  }
  return clean ? 0 : 1;
}
