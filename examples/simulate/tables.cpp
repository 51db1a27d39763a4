#include "tables.hpp"

#include <fmt/format.h>

#include <iterator>

namespace simulate {

namespace {

using namespace cncplan;

std::string_view name(junction::Kind kind) {
  constexpr std::array<std::string_view, 3> names{"rapid", "line", "arc"};
  return names[static_cast<std::size_t>(kind)];
}

int g_code(Plane plane) {
  constexpr std::array<int, 4> codes{17, 18, 19, 18};
  return codes[static_cast<std::size_t>(plane)];
}

// Numbers with the 17 digits that a double needs, separated by commas.
template <class... Numbers>
void put(std::ostream& out, Numbers... numbers) {
  std::ostreambuf_iterator<char> it(out);
  ((it = fmt::format_to(it, ",{:.17g}", numbers)), ...);
}

}  // namespace

void write_motions(std::ostream& out, const Program& program) {
  out << "line,kind,plane,x0,y0,z0,x1,y1,z1,cx,cy,cz,radius,sweep,length,feed\n";
  for (std::size_t i = 0; i < program.blocks.size(); ++i) {
    const plan::Block& block = program.blocks[i];
    const Origin& origin = program.origins[i];
    if (!(block.segment.length() > 0.0)) continue;
    const Vector3 start = block.segment.start() - origin.offset;
    const Vector3 end = block.segment.end() - origin.offset;
    out << origin.line << ',' << name(block.kind) << ',' << g_code(origin.plane);
    put(out, start.x(), start.y(), start.z(), end.x(), end.y(), end.z());
    if (const path::Arc* arc = block.segment.arc()) {
      const Vector3 center = arc->center() - origin.offset;
      put(out, center.x(), center.y(), center.z(), arc->start_radius(), arc->sweep());
    } else {
      out << ",,,,,";
    }
    put(out, block.segment.length(), origin.feed);
    out << '\n';
  }
}

void write_blocks(std::ostream& out, const Program& program, const Plan& plan) {
  out << "line,length,v_in,v_peak,v_out,duration\n";
  for (std::size_t i = 0; i < program.blocks.size(); ++i) {
    if (!(plan.lengths[i] > 0.0)) continue;
    const plan::BlockTiming& timing = plan.timings[i];
    out << program.origins[i].line;
    put(out, plan.lengths[i], timing.entry.velocity, timing.peak_velocity, timing.exit.velocity,
        timing.duration);
    out << '\n';
  }
}

void write_samples_header(std::ostream& out) { out << "t,x,y,z,s,v,a,j\n"; }

void write_sample(std::ostream& out, const Program& program, const Sample& sample) {
  const Vector3 point = sample.position - program.origins[sample.block].offset;
  fmt::format_to(std::ostreambuf_iterator<char>(out), "{:.17g}", sample.time);
  put(out, point.x(), point.y(), point.z(), sample.along.position, sample.along.velocity,
      sample.along.acceleration, sample.along.jerk);
  out << '\n';
}

}  // namespace simulate
