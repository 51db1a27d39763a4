// Flat artwork onto the sidewall of a tire mold: reads the mold's profile (DXF) and a flat program, writes
// the program of the 4-axis machine, and plans, samples and steps the motion within the limits of its axes.
// docs/tire-mold.md is its manual.
#include <fmt/format.h>

#include <memory>
#include <stdexcept>

#include "conversion.hpp"
#include "drawing.hpp"
#include "failure.hpp"
#include "motion.hpp"
#include "options.hpp"
#include "output_file.hpp"
#include "plots.hpp"
#include "report.hpp"

namespace tire_mold {

namespace {

using simulate::OutputFile;

std::unique_ptr<OutputFile> open(const std::optional<std::string>& path) {
  return path ? std::make_unique<OutputFile>(*path) : nullptr;
}

void write_sample(std::ostream& out, const Machine& machine, const Sample& s) {
  out << fmt::format("{:.17g}", s.time);
  for (std::size_t i = 0; i < 4; ++i)
    out << fmt::format(",{:.17g}", machine.shown(i, s.joints[static_cast<Eigen::Index>(i)]));
  out << fmt::format(",{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", s.along.position,
                     s.along.velocity, s.along.acceleration, s.along.jerk, s.flat[0], s.flat[1], s.flat[2]);
}

// At most so many points are drawn.
constexpr std::size_t drawn_points = 20000;

int run(const Options& options) {
  const Machine machine = machine_of(options.machine);
  const auto chain = profile_of(options.profile, {options.chain_tolerance, options.reverse});
  const cncplan::kinematics::Sidewall sidewall(chain.pieces, options.start_radius, options.tool_length);
  const Artwork artwork = read_artwork(options.artwork, machine.artwork);
  const Conversion conversion = convert(artwork, sidewall, machine, options);
  const Motion motion = plan_motion(artwork, sidewall, machine, options);
  Measures measures{chain.length(), chain.pieces.size(), axis_peaks(motion), {}, 0};

  const auto out = open(options.out), samples = open(options.samples), steps = open(options.steps);
  if (out) out->stream() << conversion.text;
  std::vector<Sample> drawn;
  if (samples) {
    samples->stream() << 't';
    for (const char letter : machine.letters) samples->stream() << ',' << letter;
    samples->stream() << ",s,v,a,j,x,y,z\n";
  }
  if (samples || options.plot) {
    const auto every = static_cast<std::size_t>(motion.duration / options.period) / drawn_points + 1;
    make_samples(motion, options.period, [&](const Sample& sample) {
      if (samples) write_sample(samples->stream(), machine, sample);
      if (options.plot && measures.samples % every == 0) drawn.push_back(sample);
      ++measures.samples;
    });
  }
  if (steps) {
    std::vector<cncplan::step::Trace> traces;
    for (std::size_t i = 0; i < 4; ++i)
      traces.push_back({std::string(1, machine.letters[i]), machine.pulse_width[i], 0.0});
    auto vcd = cncplan::step::vcd_writer(steps->stream(), traces);
    make_steps(motion, machine, [&](const cncplan::step::Edge& edge) {
      if (!vcd.accept(edge)) throw simulate::Failure(simulate::Exit::other, "an edge came out of order");
      ++measures.steps[static_cast<std::size_t>(edge.axis)];
    });
    vcd.finish();
  }
  if (options.plot) draw(*options.plot, sidewall, conversion, machine, drawn);

  const std::array files{out.get(), samples.get(), steps.get()};
  for (OutputFile* file : files)
    if (file != nullptr) file->finish();
  for (OutputFile* file : files)
    if (file != nullptr) file->commit();
  if (!out && !options.json) fmt::print("{}", conversion.text);
  if (options.json)
    fmt::print("{}", json_summary(conversion, motion, machine, measures));
  else if (!options.quiet)
    fmt::print(out ? stdout : stderr, "{}", table_summary(conversion, motion, machine, measures));
  return static_cast<int>(simulate::Exit::done);
}

void complain(const std::string& text) {
  fmt::print(stderr, "{}{}\n", text.find(": error: ") == std::string::npos ? "error: " : "", text);
}

}  // namespace

}  // namespace tire_mold

int main(int argc, char** argv) {
  try {
    const auto options = tire_mold::parse_options(argc, argv);
    return options ? tire_mold::run(*options) : 0;
  } catch (const simulate::Failure& failure) {
    tire_mold::complain(failure.what());
    return static_cast<int>(failure.code);
  } catch (const std::exception& error) {
    tire_mold::complain(error.what());
    return static_cast<int>(simulate::Exit::other);
  }
}
