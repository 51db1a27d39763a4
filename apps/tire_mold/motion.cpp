#include "motion.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

#include "conversion.hpp"
#include "support/failure.hpp"

namespace tire_mold {

namespace {

using namespace cncplan;

// A feed of none, or one that is not told, is the rapid rate.
cncplan::Block<3> flat_block(const Move& move, int line) {
  const double feed = move.feed == 0.0 ? std::numeric_limits<double>::infinity() : move.feed;
  return {.path = move.segment,
          .feed = feed,
          .exact_stop = move.exact_stop,
          .rapid = move.rapid,
          .line = line,
          .column = move.column};
}

cncplan::tire_mold::WallProgram program_of(const Artwork& artwork, const kinematics::Sidewall& sidewall,
                                           const Machine& machine, const Options& options, double table) {
  cncplan::tire_mold::WallProgram program(sidewall, smallest_radius(machine), table);
  bool over_mold = false;
  for (std::size_t i = 0; i < artwork.lines.size(); ++i) {
    const Line& line = artwork.lines[i];
    for (Move move : line.moves) {
      if (!over_mold && !leads_to_mold(move)) continue;
      if (!std::exchange(over_mold, true)) move.segment = first_way(move.segment, sidewall, machine, options);
      if (const auto ok = program.append(flat_block(move, static_cast<int>(i) + 1)); !ok)
        refuse_move(artwork, i, move, ok.error());
    }
    if (line.stops || line.pause > 0.0) (void)program.append({.pause = line.pause, .exact_stop = line.stops});
  }
  return program;
}

}  // namespace

WallProgram wall_program(const Artwork& artwork, const kinematics::Sidewall& sidewall, const Machine& machine,
                         const Options& options) {
  const auto program = program_of(artwork, sidewall, machine, options, 0.0);
  const auto range = program.table_range();
  if (!range) return {program.blocks(), {}};
  const auto [low, high] = *range;
  const Axis table = machine.axis(3);
  const double added = kinematics::turns_into(low, high, table.low, table.high);
  if (added == 0.0) return {program.blocks(), {low, high, added}};
  return {program_of(artwork, sidewall, machine, options, added).blocks(), {low, high, added}};
}

Motion plan_motion(const WallProgram& program, const Artwork& artwork, const Machine& machine) {
  auto planned = plan_blocks(program.blocks, planned_machine(machine), {.tolerance = 0});
  if (planned) return std::move(*planned);
  planned.error().file = artwork.file;
  throw support::Failure(support::Exit::bad_input, to_text(planned.error()));
}

std::array<double, 3> flat_point(const Motion& motion, const Sample& sample) {
  const WallPath& path = *motion.program()[sample.block].path.as<WallPath>();
  const WallPart& part = path.curve();
  auto flat = part.flat(path.parameter_at(sample.along.position - motion.start_length(sample.block)));
  if (part.kink) {  // whose radii are the angle turned
    const double radius = std::hypot(flat[0], flat[1]);
    for (const std::size_t i : {0U, 1U}) flat[i] *= part.map.begins / radius;
  }
  return flat;
}

void make_samples(const Motion& motion, double period, const std::function<void(const Sample&)>& take) {
  if (motion.program().empty()) return;
  for (const Sample& sample : motion.samples(period)) take(sample);
}

StepReports make_steps(const Motion& motion, const cncplan::tools::MotorSignals& signals,
                       const Artwork& artwork, double period,
                       const std::function<void(const step::Edge&)>& take) {
  if (motion.program().empty()) return {};
  const auto& axes = motion.machine().axes;
  for (const step::Edge& edge : signals.squaring()) take(edge);
  const auto report =
      follow_steps(motion, period, [&](const MotorEdge& edge) { take(signals.signal(edge)); });
  if (report) return *report;
  const step::Violation& broken = report.error();
  throw support::Failure(
      support::Exit::bad_input,
      fmt::format("{}:{}:1: error: {} at {:.9f} s: {}", artwork.file, motion.at(broken.time).line,
                  axis_name(axes[static_cast<std::size_t>(broken.axis)].letter), broken.time,
                  to_text(broken.error)));
}

}  // namespace tire_mold
