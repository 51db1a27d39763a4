#include "tables.hpp"

#include <fmt/format.h>

#include <algorithm>
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

// Numbers with the 17 digits that a double needs, separated by commas; none is -0.
template <class... Numbers>
void put(std::ostream& out, Numbers... numbers) {
  std::ostreambuf_iterator<char> it(out);
  ((it = fmt::format_to(it, ",{:.17g}", numbers + 0.0)), ...);
}

}  // namespace

void write_motions(std::ostream& out, const Program& program) {
  out << "line,kind,plane,x0,y0,z0,x1,y1,z1,cx,cy,cz,radius,sweep,length,feed\n";
  for (std::size_t i = 0; i < program.blocks.size(); ++i) {
    const plan::Block& block = program.blocks[i];
    const Origin& origin = program.origins[i];
    if (!(origin.length > 0.0)) continue;
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
    put(out, origin.length, origin.feed);
    out << '\n';
  }
}

void write_blocks(std::ostream& out, const Program& program, const Plan& plan,
                  const std::vector<std::size_t>& blocks) {
  out << "line,length,v_in,v_peak,v_out,duration\n";
  for (std::size_t first = 0, end = 0; first < blocks.size(); first = end) {
    const Origin& origin = program.origins[blocks[first]];
    double peak = 0.0, duration = 0.0;
    for (; end < blocks.size() && blocks[end] == blocks[first]; ++end) {
      peak = std::max(peak, plan.timings[end].peak_velocity);
      duration += plan.timings[end].duration;
    }
    if (!(origin.length > 0.0)) continue;
    out << origin.line;
    put(out, origin.length, plan.timings[first].entry.velocity, peak, plan.timings[end - 1].exit.velocity,
        duration);
    out << '\n';
  }
}

void write_samples_header(std::ostream& out, const Machine& machine) {
  out << "t,x,y,z";
  if (machine.kinematics != Kinematics::cartesian)
    for (const MachineAxis& axis : machine.axes) out << ',' << axis.letter;
  out << ",s,v,a,j\n";
}

void write_sample(std::ostream& out, const Program& program, const Machine& machine, const Sample& sample) {
  const Vector3 point = sample.position - program.origins[sample.block].offset;
  fmt::format_to(std::ostreambuf_iterator<char>(out), "{:.17g}", sample.time);
  put(out, point.x(), point.y(), point.z());
  if (machine.kinematics != Kinematics::cartesian)
    for (std::size_t i = 0; i < machine.axes.size(); ++i)
      put(out, machine.shown(i, sample.axes[static_cast<Eigen::Index>(i)]));
  put(out, sample.along.position, sample.along.velocity, sample.along.acceleration, sample.along.jerk);
  out << '\n';
}

}  // namespace simulate
