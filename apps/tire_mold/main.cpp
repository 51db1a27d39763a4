// Flat artwork onto the sidewall of a tire mold: reads the mold's profile (DXF) and a flat program, writes
// the program of the 4-axis machine, and plans, samples and steps the motion within the limits of its axes.
// docs/tire-mold.md is its manual.
#include <fmt/format.h>

#include "conversion.hpp"
#include "drawing.hpp"
#include "html_report.hpp"
#include "motion.hpp"
#include "options.hpp"
#include "plots.hpp"
#include "report.hpp"
#include "smooth_motion.hpp"
#include "support/failure.hpp"
#include "support/fallback_lines.hpp"
#include "support/gnuplot.hpp"
#include "support/main_program.hpp"
#include "support/output_file.hpp"
#include "support/report.hpp"

namespace tire_mold {

namespace {

template <class S>
void write_sample(std::ostream& out, const Machine& machine, const std::array<double, 3>& flat, const S& s) {
  out << fmt::format("{:.17g}", s.time);
  for (std::size_t i = 0; i < 4; ++i)
    out << fmt::format(",{:.17g}", machine.shown(i, s.position[static_cast<Eigen::Index>(i)]));
  out << fmt::format(",{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", s.along.position,
                     s.along.velocity, s.along.acceleration, s.along.jerk, flat[0], flat[1], flat[2]);
}

void write_header(std::ostream& out, const Machine& machine) {
  out << 't';
  for (const support::MachineAxis& axis : machine.axes) out << ',' << axis.letter;
  out << ",s,v,a,j,x,y,z\n";
}

void print_summary(const Options& options, const Conversion& conversion, double time, const Machine& machine,
                   const Measures& measures) {
  if (options.json)
    support::print(json_summary(conversion, time, machine, measures));
  else if (!options.quiet)
    support::print(table_summary(conversion, time, machine, measures),
                   options.summary_aside ? stderr : stdout);
}

// The same within a tolerance: the program, samples and the summary.
int run_smooth(const Options& options, const WallProgram& program, const Artwork& artwork,
               const Conversion& conversion, const Machine& machine, Measures measures) {
  const SmoothMotion motion = plan_smooth(program, artwork, machine, options);
  measures.peaks = cncplan::peaks(motion);
  measures.smooth = options.smooth;
  measures.fallbacks = support::fallback_lines(motion);
  support::OutputFiles files;
  std::ostream* const out = files.open(options.out);
  std::ostream* const samples = files.open(options.samples);
  if (samples != nullptr) {
    write_header(*samples, machine);
    for (const auto& sample : motion.samples(options.period)) {
      write_sample(*samples, machine, {sample.tool[0], sample.tool[1], sample.tool[2]}, sample);
      ++measures.samples;
    }
  }
  if (out != nullptr) *out << conversion.text;
  files.finish();
  files.commit();
  print_summary(options, conversion, motion.duration(), machine, measures);
  return static_cast<int>(support::Exit::done);
}

// At most so many points are drawn.
constexpr std::size_t drawn_points = 20000;

int run(const Options& options) {
  if (options.report) support::check_report_libraries();
  const Machine machine = machine_of(options.machine);
  const auto chain = profile_of(options.profile, {options.chain_tolerance, options.reverse, options.side});
  const cncplan::kinematics::Sidewall sidewall(chain.pieces, options.start_radius, options.tool_length);
  const Artwork artwork = read_artwork(options.artwork, artwork_dialect(machine));
  const WallProgram program = wall_program(artwork, sidewall, machine, options);
  const Conversion conversion = convert(artwork, sidewall, machine, options, program.table);
  Measures measures{.profile_length = chain.length(), .entities = chain.pieces.size()};
  if (options.smooth) return run_smooth(options, program, artwork, conversion, machine, measures);
  const Motion motion = plan_motion(program, artwork, machine);
  measures.peaks = cncplan::peaks(motion);

  if (options.plot) support::make_folder(*options.plot);

  support::OutputFiles files;
  std::ostream* const out = files.open(options.out);
  std::ostream* const samples = files.open(options.samples);
  std::ostream* const steps = files.open(options.steps);
  std::ostream* const page = files.open(options.report);
  std::vector<Sample> drawn;
  if (samples != nullptr) write_header(*samples, machine);
  if (samples != nullptr || options.plot) {
    const auto every = static_cast<std::size_t>(motion.duration() / options.period) / drawn_points + 1;
    make_samples(motion, options.period, [&](const Sample& sample) {
      if (samples != nullptr) write_sample(*samples, machine, flat_point(motion, sample), sample);
      if (options.plot && measures.samples % every == 0) drawn.push_back(sample);
      ++measures.samples;
    });
  }
  if (steps != nullptr) {
    const cncplan::tools::MotorSignals signals(machine);
    auto vcd = cncplan::step::vcd_writer(*steps, signals.traces());
    measures.steps =
        make_steps(motion, signals, artwork, options.period, [&](const cncplan::step::Edge& edge) {
          if (!vcd.accept(edge)) throw support::Failure(support::Exit::other, "an edge came out of order");
        });
    vcd.finish();
  }
  if (page != nullptr)
    report::write(*page, html_report(options, sidewall, conversion, motion, machine, measures));
  if (out != nullptr) *out << conversion.text;
  files.finish();
  if (options.plot) draw(*options.plot, sidewall, conversion, machine, motion, drawn);
  files.commit();
  print_summary(options, conversion, motion.duration(), machine, measures);
  return static_cast<int>(support::Exit::done);
}

}  // namespace

}  // namespace tire_mold

int main(int argc, char** argv) {
  return support::main_program([&] {
    const auto options = tire_mold::parse_options(argc, argv);
    return options ? tire_mold::run(*options) : 0;
  });
}
